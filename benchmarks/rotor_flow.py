"""The flow through a rotor that OpenFOAM found: wake, a section, and loads along the blade.

    python benchmarks/rotor_flow.py BLADE CASE [FILE.png]

CASE is a folder that has been run: bladegen case openfoam BLADE -o CASE and then CASE/Allrun, with
no option that moves the operating point.  Prints thrust and torque of a blade over the iterations
beside blade element momentum theory.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pyvista
from matplotlib.tri import Triangulation
from PIL import Image

import bladegen as bg
from bladegen.blade.aero.evaluation import evaluated
from bladegen.blade.aero.momentum import loads as solve
from bladegen.blade.aero.performance import coefficients
from bladegen.exports.cases.rotors.operation import DENSITY, Operation
from bladegen.exports.cases.rotors.rotor import rotor_case
from bladegen.views.plots import figures, style

SHARE = 0.75  # of the tip's radius: the section that is shown
BINS = 40  # along the blade
SIDES = "suction_side", "pressure_side", "trailing_edge", "tip"


def history(case: Path) -> dict[str, np.ndarray]:
    """Return iterations, and thrust [N] and torque [N m] of the blade at each."""
    found = {}
    for name, told in (("force", "thrust"), ("moment", "torque")):
        text = (case / "postProcessing/forces/0" / f"{name}.dat").read_text(encoding="ascii")
        rows = [
            line.replace("(", " ").replace(")", " ").split()
            for line in text.splitlines()
            if not line.startswith("#")
        ]
        table = np.array(rows, dtype=float)
        found |= {"iteration": table[:, 0], told: table[:, 1]}
    return found


def theory(blade: bg.Blade, flow: Operation) -> dict[str, Any]:
    """Return what momentum theory makes of the blade: thrust, torque, and thrust per length."""
    made = evaluated([blade])
    elements, polars = made.elements, made.polars.extended()
    ratio, pitch = np.array([[flow.ratio]]), np.array([[flow.pitch]])
    blades = blade.definition.rotor.blades
    power, thrust, _ = coefficients(elements, polars, blades, ratio, pitch)[0, 0]
    given = [elements.radius, elements.chord, elements.twist, elements.cone]
    found = np.empty((1, 1, elements.radius.shape[1], 4))
    even = [np.ascontiguousarray(part, dtype=float) for part in (*given, ratio, pitch, *polars)]
    solve(*even[:4], blades, *even[4:], found)
    return {
        "thrust": thrust * flow.force / blades,
        "torque": power * flow.force * flow.radius / flow.ratio / blades,
        "radius": elements.radius[0],
        "along": found[0, 0, :, 0] * 0.5 * DENSITY * flow.wind**2,
    }


def fields(case: Path) -> tuple[pyvista.DataSet, pyvista.PolyData]:
    """Return the cells of the last iteration, and the faces of the blade."""
    (case / "case.foam").touch()
    reader = pyvista.POpenFOAMReader(str(case / "case.foam"))
    reader.set_active_time_value(reader.time_values[-1])
    reader.cell_to_point_creation = False
    read = reader.read()
    patches = read["boundary"]
    names = set(patches.keys())
    walls = [patches[name] for name in SIDES if name in names]
    return read["internalMesh"], pyvista.merge(walls).extract_surface(algorithm="dataset_surface")


def drawn(axis: Any, cut: pyvista.PolyData, columns: tuple[int, int], values: np.ndarray) -> Any:
    """Draw a cut's faces by their values."""
    flat = cut.triangulate()
    points = flat.points[:, columns]
    faces = flat.faces.reshape(-1, 4)[:, 1:]
    return axis.tripcolor(
        Triangulation(*points.T, faces), values, cmap=style.SEQUENTIAL, rasterized=True
    )


def wake(axis: Any, cells: pyvista.DataSet, flow: Operation) -> None:
    """Draw the wind's speed along the axis, in the plane through axis and blade."""
    radius = flow.radius
    cut = cells.slice(normal=(0, 1, 0), origin=(0, 0.01, 0)).triangulate()
    seen = drawn(axis, cut, (0, 2), np.clip(cut.cell_data["U"][:, 0] / flow.wind, 0.0, 1.3))
    axis.figure.colorbar(seen, ax=axis, shrink=0.8)
    axis.set(
        title="speed along the axis over the wind's",
        xlim=(-1.5 * radius, 4.0 * radius),
        ylim=(0.0, 2.0 * radius),
        aspect="equal",
        xlabel="x, m",
        ylabel="z, m",
    )


def section(axes: tuple, cells: pyvista.DataSet, walls: pyvista.PolyData, made: Any) -> None:
    """Draw the flow relative to the blade, and pressures, at a radius."""
    flow, away = made.flow, SHARE * made.flow.radius
    plane = {"normal": (0, 0, 1), "origin": (0, 0, away)}
    cut = cells.slice(**plane).triangulate()
    velocity = np.array(cut.cell_data["U"])
    y = cut.cell_centers().points[:, 1]
    turn = made.sense * flow.speed
    velocity[:, 1] += turn * away
    velocity[:, 2] -= turn * y
    speed = float(np.hypot(flow.wind, turn * away))
    seen = drawn(axes[0], cut, (1, 0), np.linalg.norm(velocity, axis=1) / speed)
    seen.set_clim(0.0, 1.6)
    axes[0].figure.colorbar(seen, ax=axes[0], shrink=0.8)
    ring = walls.slice(**plane)
    points = ring.cell_centers().points
    middle, chord = points.mean(axis=0), float(np.ptp(points[:, 1]))
    axes[0].set(
        title=f"speed past the section at {100 * SHARE:g} % radius, over its own",
        xlim=(middle[1] - 0.9 * chord, middle[1] + 0.9 * chord),
        ylim=(middle[0] - 0.5 * chord, middle[0] + 0.5 * chord),
        aspect="equal",
        xlabel="y, m",
        ylabel="x, m",
    )
    along = (points[:, 1] - points[:, 1].min()) / chord
    axes[1].plot(along, ring.cell_data["p"] / (0.5 * speed**2), ".", color=style.BLUE, markersize=3)
    axes[1].set(title=f"pressure coefficient at {100 * SHARE:g} % radius", xlabel="y, chords")
    axes[1].invert_yaxis()


def loads(axis: Any, walls: pyvista.PolyData, beside: dict[str, Any]) -> None:
    """Draw thrust per length along the blade, of pressure alone, beside momentum theory."""
    faces = walls.compute_normals(cell_normals=True, point_normals=False, consistent_normals=False)
    areas = faces.compute_cell_sizes(length=False, volume=False).cell_data["Area"]
    force = DENSITY * faces.cell_data["p"] * areas * faces.cell_data["Normals"][:, 0]
    polygons = faces.GetPolys()
    radius = np.hypot(faces.points[:, 1], faces.points[:, 2])
    radius = radius[pyvista.convert_array(polygons.GetConnectivityArray())]
    starts = pyvista.convert_array(polygons.GetOffsetsArray())[:-1]
    low, high = (part.reduceat(radius, starts) for part in (np.minimum, np.maximum))
    ends = np.linspace(radius.min(), radius.max(), BINS + 1)
    within = np.clip((ends[:, None] - low) / np.maximum(high - low, 1e-6), 0.0, 1.0)
    total = np.diff(within @ force) / np.diff(ends)  # a face's force is spread over its length
    middle = 0.5 * (ends[1:] + ends[:-1])
    axis.plot(middle, 1e-3 * total, color=style.VERMILLION, label="OpenFOAM, pressure")
    axis.plot(beside["radius"], 1e-3 * beside["along"], color=style.BLUE, label="momentum theory")
    axis.set(title="thrust per length, kN/m", xlabel="radius, m")
    axis.legend(frameon=False)


def main(name: str, case: Path, target: Path) -> None:
    """Print thrust and torque, and draw the flow."""
    blade = bg.Blade.from_definition(bg.read(name))
    made = rotor_case(blade)
    beside, found = theory(blade, made.flow), history(case)
    print("momentum theory", *(f"{what} {beside[what]:.4g}" for what in ("thrust", "torque")))
    for i in sorted({*range(49, len(found["iteration"]), 50), len(found["iteration"]) - 1}):
        shares = (f"{found[what][i] / beside[what] - 1:+.1%}" for what in ("thrust", "torque"))
        print(*(f"{what} {found[what][i]:.4g}" for what in found), *shares)
    cells, walls = fields(case)
    drawing, axes = figures.figure(2, 2, width=12.0, height=7.5)
    wake(axes[0, 0], cells, made.flow)
    section((axes[0, 1], axes[1, 1]), cells, walls, made)
    loads(axes[1, 0], walls, beside)
    figures.save_figure(drawing, target)
    with Image.open(target) as image:
        image.convert("RGB").quantize(256, Image.Quantize.MAXCOVERAGE).save(target, optimize=True)
    print(f"wrote {target}; {cells.n_cells} cells")


if __name__ == "__main__":
    words = sys.argv[1:]
    main(words[0], Path(words[1]), Path(words[2] if len(words) > 2 else "rotor_flow.png"))
