"""Meshes: time against deviation, of our structured grid and of OCCT's tessellation of our solid.

    python benchmarks/meshing.py

Ours is made through several numbers of sections, the tessellation (BRepMesh) at several distances;
both start from what they have, a blade that holds nothing computed and a solid without triangles,
and are written as binary STL.  They take turns, all warm.  How far a mesh is from the blade is
measured alike: the largest distance to its triangles of 960 points of the blade's sides, at spans
and landmarks that were not used, and the volume against the integral over sections.  The solid that
OCCT tessellates is the default one, within 0.3 mm of the blade; making it is not counted.
"""

import tempfile
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from figures import asked, figure, seconds

import bladegen as bg
from bladegen.cad import solids
from bladegen.exports import exporters
from bladegen.exports.options import Options
from bladegen.exports.products import Products
from bladegen.measures import properties
from bladegen.surface import mesh_files
from bladegen.surface.grids import grid

RUNS = 3
STATIONS = (50, 100, 300, 900)
DISTANCES = (3.0, 1.0, 0.3)  # mm
ANGLE = 0.5  # rad, BRepMesh's own default
SOLID, SMALL = solids.DEFAULT_TOLERANCE, 3e-3  # m
SPANS, PLACES = 60, 16  # of the points that are measured


def gridded(blade: bg.Blade, stations: int, path: Path) -> None:
    """Write our mesh."""
    options = Options(stations=stations)
    exporters.write(Products(replace(blade), options), path)


def tessellated(solid: solids.Solid, distance: float, path: Path) -> None:
    """Write OCCT's."""
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.BRepTools import BRepTools
    from OCP.StlAPI import StlAPI_Writer

    BRepTools.Clean_s(solid.shape)
    BRepMesh_IncrementalMesh(solid.shape, distance, False, ANGLE, False)
    StlAPI_Writer().Write(solid.shape, str(path))


def measured(path: Path, scale: float, blade: bg.Blade) -> tuple[int, float, float, bool]:
    """Return a file's triangles, largest distance [mm], volume's error, and closedness."""
    import pyvista as pv

    made = mesh_files.read(path)
    made.apply_scale(scale)
    rng = np.random.default_rng(11)
    half = np.sort(rng.uniform(0.0, 0.5, PLACES // 2))
    u = np.concatenate([half, 1.0 - half[::-1]])
    points = blade.sections(rng.uniform(0.0, 1.0, SPANS), u).reshape(-1, 3)
    surface = pv.wrap(made)
    _, nearest = surface.find_closest_cell(points, return_closest_point=True)
    off = 1e3 * float(np.linalg.norm(nearest - points, axis=1).max())
    return (
        len(made.faces),
        off,
        abs(made.volume / properties.volume(blade) - 1),
        bool(made.is_watertight),
    )


def main() -> None:
    """Print each blade's figures."""
    quick = asked(__doc__).quick
    for name in bg.bundled()[: 1 if quick else None]:
        blade = bg.Blade.from_definition(bg.read(name))
        solid = solids.solid(blade, tolerance=SMALL if quick else SOLID)
        with tempfile.TemporaryDirectory() as folder:
            calls: dict[str, Callable[[], None]] = {}
            paths: dict[str, tuple[Path, float]] = {}
            for count in STATIONS[: 2 if quick else None]:
                path = Path(folder) / f"ours{count}.stl"
                case = f"{name}, bladegen, {count} sections"
                paths[case] = path, 1.0
                calls[case] = partial(gridded, blade, count, path)
            for distance in DISTANCES[: 1 if quick else None]:
                path = Path(folder) / f"occt{distance}.stl"
                case = f"{name}, OCCT's tessellation to {distance:g} mm"
                paths[case] = path, 1e-3
                calls[case] = partial(tessellated, solid, distance, path)
            for case, spent in seconds(calls, 1 if quick else RUNS).items():
                triangles, off, volume, closed = measured(*paths[case], blade)
                figure("made and written", case, "s", spent)
                figure("triangles", case, "", triangles)
                figure("off the blade by up to", case, "mm", off)
                figure("volume off by", case, "", volume)
                figure("watertight", case, "", closed)
        structured = seconds({"": lambda blade=blade: grid.from_blade(replace(blade))}, RUNS)
        figure("structured grid, made", name, "s", structured)


if __name__ == "__main__":
    main()
