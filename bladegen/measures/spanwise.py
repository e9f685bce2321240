"""What sections are over span: chord, twist, thickness, camber, area, centroid, inertia.

Figures of the sections as they are built, trailing edges finished: polygons through their
landmarks (`polygons`), in axes along the chord from the leading edge and normal to it.
"""

import csv
from pathlib import Path

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.curves import polygons
from bladegen.curves.sides import sides
from bladegen.shapes import affine
from bladegen.support.arrays import Array

__all__ = ["LINES", "UNITS", "built", "spanwise", "write_csv"]

UNITS = {
    "area": "m2",
    "centroid_x": "m",
    "centroid_y": "m",
    "inertia_xx": "m4",
    "inertia_yy": "m4",
    "inertia_xy": "m4",
    "perimeter": "m",
}
LINES = np.linspace(0.0, 1.0, 201)  # along the chord, for thickness and camber


def spanwise(blade: Blade, eta: Array) -> dict[str, Array]:
    """Return columns over span fractions (k,), each (k,), their units in their names.

    Thickness and camber are those of lines at equal places along the chord: the largest
    distance between the sides, the largest distance of their middle from the chord line (with
    its sign), and where.
    """
    chord = blade.chord(eta)
    profiles = blade.trailing_edge(blade.profiles(eta), chord)
    axis = blade.axis(eta)
    measured_chord, twist = built(blade, eta)
    measured = polygons.measure(profiles * chord[:, None, None])
    upper, lower = sides(profiles, LINES)
    thickness, camber = upper - lower, 0.5 * (upper + lower)
    thickest = np.argmax(thickness, axis=1)
    bent = np.argmax(np.abs(camber), axis=1)
    row = np.arange(len(eta))
    return {
        "eta": eta,
        "x_m": axis[:, 0],
        "y_m": axis[:, 1],
        "z_m": axis[:, 2],
        "chord_m": measured_chord,
        "twist_deg": np.degrees(twist),
        "relative_thickness": blade.relative_thickness(eta),
        "thickest_at_chord": LINES[thickest],
        "camber_chord": camber[row, bent],
        "most_camber_at_chord": LINES[bent],
        "edge_width_m": np.linalg.norm(profiles[:, 0] - profiles[:, -1], axis=-1) * chord,
        **{
            f"{name}_{UNITS[name]}": values
            for name, values in zip(polygons.MEASURES, measured.T, strict=True)
        },
    }


def built(blade: Blade, eta: Array) -> tuple[Array, Array]:
    """Return chord [m] and twist [rad], (k,) each, of the sections that are written.

    Both are measured on the finished points in space: the line from the leading edge to the
    middle of the trailing edge, in the section's plane, less the angle that the airfoil's own
    chord line has at that thickness, before any change of shape.  Those of a mirror
    image are the blade's own: its nose turns toward the wind as before.
    """
    blade = blade.mirror_image() if blade.mirrored else blade
    placed = blade.sections(eta) - blade.axis(eta)[:, None]
    flat = (placed @ blade.planform.frames(eta)[:, :2].mT)[..., ::-1]
    plain, _, M, b = blade.shapes(eta)
    raw = blade.splines.fit(affine.restore(plain, M, b))
    curves = [blade.splines.fit(flat), raw.mapped(*raw.normalising(blade.wanted_thickness(eta)))]
    lines = [curve.trailing_edge - curve.leading_edge for curve in curves]
    own, given = (np.arctan2(line[:, 1], line[:, 0]) for line in lines)
    return curves[0].chord, own - given


def write_csv(columns: dict[str, Array], path: Path) -> None:
    """Write columns as CSV, a row a span, fifteen digits."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(
            [f"{value:.15g}" for value in row] for row in zip(*columns.values(), strict=True)
        )
