"""Solids: our B-spline net beside OCCT's own loft through the same sections.

For each: time, validity, poles or faces, and how far the solid is from the blade at spans and
landmarks that were not used (OCCT's distance, at a few dozen points, for both alike).
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import bladegen as bg
from bladegen import cad, cad_files, properties

LOFT_SECTIONS, LOFT_LANDMARKS = 40, 101
POINTS = 12
PATIENCE = 90  # s


def distance_mm(blade: bg.Blade, shape: object) -> float:
    """Largest distance of points of the blade to a shape, by OCCT [mm]."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex
    from OCP.BRepExtrema import BRepExtrema_DistShapeShape
    from OCP.gp import gp_Pnt
    from OCP.TopAbs import TopAbs_SHELL
    from OCP.TopExp import TopExp_Explorer

    shell = TopExp_Explorer(shape, TopAbs_SHELL).Current()
    rng = np.random.default_rng(11)
    half = np.sort(rng.uniform(0.0, 0.5, 3))
    u = np.concatenate([half, 1.0 - half[::-1]])
    points = 1e3 * blade.sections(rng.uniform(0.0, 1.0, POINTS), u).reshape(-1, 3)
    vertices = (BRepBuilderAPI_MakeVertex(gp_Pnt(*p)).Vertex() for p in points.tolist())
    return max(BRepExtrema_DistShapeShape(vertex, shell).Value() for vertex in vertices)


def lofted(blade: bg.Blade) -> object:
    """OCCT's ThruSections through interpolated wires."""
    import cadquery as cq
    from OCP.BRepOffsetAPI import BRepOffsetAPI_ThruSections

    loft = BRepOffsetAPI_ThruSections(True, False, 1e-6)
    coarse = bg.Blade.from_definition(blade.definition, landmarks=LOFT_LANDMARKS)
    for section in 1e3 * coarse.sections(coarse.stations(LOFT_SECTIONS)):
        points = [cq.Vector(*p) for p in section.tolist()]
        edge = cq.Edge.makeSpline(points)
        back = cq.Edge.makeLine(points[-1], points[0])
        loft.AddWire(cq.Wire.assembleEdges([edge, back]).wrapped)
    loft.Build()
    return loft.Shape()


def main() -> None:
    """Print two rows a blade."""
    print("blade     way    sections  s      valid  max mm (own)  rms mm  max mm (OCCT)  volume")
    for name in bg.bundled():
        blade = bg.Blade.from_definition(bg.read(name))
        wanted = properties.volume(blade)
        cad.solid(blade, sections=20)  # loads OCCT
        start = time.perf_counter()
        solid = cad.solid(blade)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "blade.step"
            cad_files.write_step(solid, path)
            spent, size = time.perf_counter() - start, path.stat().st_size
        print(
            f"{name:9s} net    {len(solid.net.v):8d}  {spent:5.2f}  "
            f"{cad.is_valid(solid.shape)!s:5s}  {1e3 * solid.deviation.maximum:12.3f}  "
            f"{1e3 * solid.deviation.rms:6.4f}  {distance_mm(blade, solid.shape):13.3f}  "
            f"{solid.net.volume() / wanted - 1:+.1e}  {size / 1e6:.1f} MB"
        )
        print_loft_or_failure(name)


def print_loft(name: str) -> None:
    """Loft a blade by OCCT and print its row."""
    blade = bg.Blade.from_definition(bg.read(name))
    start = time.perf_counter()
    shape = lofted(blade)
    spent = time.perf_counter() - start
    off = cad.volume(shape) * 1e-9 / properties.volume(blade) - 1
    print(
        f"{name:9s} loft   {LOFT_SECTIONS:8d}  {spent:5.2f}  {cad.is_valid(shape)!s:5s}  "
        f"{'':12s}  {'':6s}  {distance_mm(blade, shape):13.3f}  {off:+.1e}"
    )


def print_loft_or_failure(name: str) -> None:
    """Loft in a process of its own, since OCCT's loft may not come back."""
    try:
        done = subprocess.run(
            [sys.executable, __file__, name], timeout=PATIENCE, check=True, capture_output=True
        )
        print(done.stdout.decode(), end="", flush=True)
    except subprocess.TimeoutExpired:
        print(f"{name:9s} loft   {LOFT_SECTIONS:8d}  not done after {PATIENCE} s", flush=True)
    except subprocess.CalledProcessError as error:
        print(f"{name:9s} loft   {LOFT_SECTIONS:8d}  failed: exit {error.returncode}", flush=True)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print_loft(sys.argv[1])
    else:
        main()
