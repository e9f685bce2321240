"""Solids: our B-spline net beside OCCT's own loft through the same sections.

For each: time, validity, poles or faces, and how far the solid is from the blade at spans and
landmarks that were not used (OCCT's distance, at a few dozen points, for both alike).
"""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from figures import figure, seconds

import bladegen as bg
from bladegen import cad, properties

LOFT_SECTIONS, LOFT_LANDMARKS = 40, 101
POINTS = 12
PATIENCE = 90  # s
LOFT = f"OCCT's loft of {LOFT_SECTIONS} x {LOFT_LANDMARKS}"


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
    """Print each blade's figures."""
    for name in bg.bundled():
        blade = bg.Blade.from_definition(bg.read(name))
        wanted = properties.volume(blade)
        cad.solid(blade, sections=20)  # loads OCCT
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "blade.step"
            spent = seconds(lambda blade=blade, path=path: bg.export(blade, path), runs=3)
            size = path.stat().st_size
        solid = cad.solid(blade)
        if not cad.is_valid(solid.shape):
            sys.exit(f"{name}: the solid is not valid")
        loft = loft_figures(name)
        case = f"{name}, {len(solid.net.v)} sections"
        off = abs(solid.net.volume() / wanted - 1)
        far = distance_mm(blade, solid.shape)
        for what, value, unit, key in (
            ("solid, made and written", spent, "s", "s"),
            ("solid off the blade, OCCT's distance", far, "mm", "mm"),
            ("solid, volume off by", off, "", "volume"),
        ):
            figure(what, case, value, unit, beside=LOFT, baseline=loft.get(key))
        figure("solid off the blade, largest", case, 1e3 * solid.deviation.maximum, "mm")
        figure("solid off the blade, RMS", case, 1e3 * solid.deviation.rms, "mm")
        figure("STEP file", case, size / 1e6, "MB")


def print_loft(name: str) -> None:
    """Loft a blade by OCCT and print its figures as JSON."""
    blade = bg.Blade.from_definition(bg.read(name))
    start = time.perf_counter()
    shape = lofted(blade)
    spent = time.perf_counter() - start
    off = abs(cad.volume(shape) * 1e-9 / properties.volume(blade) - 1)
    print(json.dumps({"s": spent, "mm": distance_mm(blade, shape), "volume": off}))


def loft_figures(name: str) -> dict[str, float]:
    """Loft in a process of its own, since OCCT's loft may not come back; empty if it does not."""
    try:
        done = subprocess.run(
            [sys.executable, __file__, name], timeout=PATIENCE, check=True, capture_output=True
        )
        figures: dict[str, float] = json.loads(done.stdout)
        return figures
    except (subprocess.TimeoutExpired, subprocess.CalledProcessError) as error:
        print(f"{name}: OCCT's loft failed: {error}", flush=True)
        return {}


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print_loft(sys.argv[1])
    else:
        main()
