"""Sections of a table to a surface: each opened alike, joined over span by monotone cubics.

A section's rows go once round it, from one edge to the same edge, or along both sides from one
edge.  It is cut where it begins and at the point farthest from there, and each half has points at
the same shares of its length; so points of all sections belong together.
"""

import numpy as np

from bladegen.airfoils.landmarks import clustered
from bladegen.definition.distribution import pchip
from bladegen.errors import FileError
from bladegen.fitting.tables.reading import AXES, Table
from bladegen.support.arrays import Array, Indices
from bladegen.surface.mesh import TriangleMesh, surface

__all__ = ["surface_of_sections"]

HALF = 200  # points of a half
ROWS = 400  # of the surface
JUMP, BESIDE = 0.5, 0.1  # of a section's extent: between sides that begin at one edge; their gap
LOOSE = 1.6  # times the way round: points that are farther apart are in no order
UNIT = 1e-3  # of the widths by which airfoils of unit chord differ at most


def surface_of_sections(
    table: Table, rows: list[Indices], length: float | None
) -> tuple[TriangleMesh, tuple[str, ...]]:
    """Return the surface through the sections of a table, and what is to be said.

    Parameters
    ----------
    table : Table
        Its columns.
    rows : list of arrays
        Of each section.
    length : float, optional
        Of the blade, in the table's unit, for tables with span fractions.

    Raises
    ------
    FileError
        If the place of sections along the blade is not known, or points are in no order.
    """
    points = _points(table, length)
    parts = [_round(points[own], table.path, k) for k, own in enumerate(rows)]
    widths = np.array([np.ptp(part, axis=0).max() for part in parts])
    if np.ptp(widths) < UNIT * widths.max() and abs(widths.mean() - 1.0) < UNIT:
        raise FileError(
            table.path,
            [
                "all sections are 1 wide: they are airfoils, not sections of a blade; a table with "
                "chord and twist is what bladegen build reads"
            ],
        )
    ways = np.array([_way(part) for part in parts])
    main = ways[np.argmax(np.linalg.norm(ways, axis=1))]
    turned = ways @ main < 0.0
    parts = [part[::-1] if back else part for part, back in zip(parts, turned, strict=True)]
    sections = np.stack([_even(part) for part in parts])
    middles = sections.mean(axis=1)
    along = middles @ np.linalg.svd(middles - middles.mean(axis=0))[2][0]
    order = np.argsort(along)
    if np.diff(along[order]).min() <= 0.0:
        raise FileError(table.path, ["two sections lie at the same place along the blade"])
    at = along[order]
    fine = np.unique(np.concatenate([at, np.linspace(at[0], at[-1], ROWS)]))
    joined = pchip(at, sections[order].reshape(len(at), -1))(fine).reshape(len(fine), -1, 3)
    said = f"{len(rows)} sections of {len(points)} points, joined over span"
    more = (f"{int(turned.sum())} of them go round the other way",) if turned.any() else ()
    return surface(joined), (said, *more)


def _points(table: Table, length: float | None) -> Array:
    """Return the points (m, 3) of a table of sections, z along the blade."""
    columns = table.columns
    if all(name in columns for name in AXES):
        return table.points
    if "span" in columns and columns["span"].max() > 1.0:
        z = columns["span"]
    elif "eta" in columns or "span" in columns:
        if length is None:
            raise FileError(
                table.path,
                ["gives span fractions and no z: how long is the blade? --length 61.5m says it"],
            )
        z = length * columns["eta" if "eta" in columns else "span"]
    else:
        raise FileError(
            table.path, ["has sections, but no column z, span or eta that says where they are"]
        )
    return np.stack([columns["x"], columns["y"], z], axis=-1)


def _round(points: Array, path: str, k: int) -> Array:
    """Return a section's points (m, 3) once round it, from one edge to the same."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    extent = float(np.ptp(points, axis=0).max())
    cut = int(np.argmax(steps)) + 1
    if steps[cut - 1] > JUMP * extent:
        one, other = points[:cut], points[cut:]
        if np.linalg.norm(one[0] - other[0]) < BESIDE * extent:
            points = np.concatenate([one[::-1], other])
        elif np.linalg.norm(one[-1] - other[-1]) < BESIDE * extent:
            points = np.concatenate([one, other[::-1]])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    way = steps.sum() + np.linalg.norm(points[0] - points[-1])
    if way > LOOSE * _hull(points) or steps.max() > JUMP * extent:
        raise FileError(
            path,
            [
                f"section {k + 1}: its points are in no order round it; from trailing edge to "
                "trailing edge is allowed, or one side and then the other, both from one edge"
            ],
        )
    kept: Array = points[np.concatenate([[True], steps > 0.0])]
    return kept


def _flat(points: Array) -> Array:
    """Return points (m, 3) of a section in its own plane, (m, 2)."""
    away = points - points.mean(axis=0)
    plane: Array = away @ np.linalg.svd(away, full_matrices=False)[2][:2].T
    return plane


def _hull(points: Array) -> float:
    from scipy.spatial import ConvexHull

    return float(ConvexHull(_flat(points)).area)  # in a plane, that is the way round


def _way(points: Array) -> Array:
    """Return the area that a section goes round, as a vector."""
    away = points - points[0]
    area: Array = np.cross(away[1:-1], away[2:]).sum(axis=0)
    return area


def _even(points: Array) -> Array:
    """Return a section's points (2 HALF + 1, 3) at the same shares of both its halves."""
    from scipy.interpolate import CubicSpline

    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    start = 0.5 * (points[0] + points[-1])
    middle = int(np.argmax(np.linalg.norm(points - start, axis=1)))
    share = clustered(np.linspace(0.0, 1.0, HALF + 1))
    first = arc[middle] * share
    second = arc[middle] + (arc[-1] - arc[middle]) * (1.0 - share[::-1])
    even: Array = CubicSpline(arc, points)(np.concatenate([first, second[1:]]))
    return even
