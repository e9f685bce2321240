"""One grid for all quantities of a blade, for formats that have room for no more.

From a definition, whose quantities have grids of their own, to span fractions at which PCHIP
through their values gives the same curves again, within a tolerance stated in metres on the
surface; and from a blade to such fractions that its sections between them follow as well.
"""

from collections.abc import Callable

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.definition.blade_definition import BladeDefinition, Distribution, pchip, united
from bladegen.support.arrays import Array, ArrayLike

__all__ = ["MOST_NODES", "TOLERANCE", "common_grid", "lost", "shape_grid"]

TOLERANCE = 3e-4  # m, of any one quantity
SHAPE_TOLERANCE = 1e-3  # m, of a chord of the curve that a surface point runs over span on: the
# curves put through such nodes are off by a tenth of it
FLAP_LEVER, EDGE_LEVER = 0.25, 0.7  # chords; how far from the axis a tilted section reaches
SHAPE_LEVER = 4.0  # chords a unit of thickness; where shape follows thickness, it moves so far
MOST_NODES = 400  # bounds the size of files; the IEA 15 MW needs a third of it
PROBES = 4  # places in an interval at which curves are compared
CLOSEST = 1e-6  # of the span; intervals shorter than this are not split


def common_grid(
    definition: BladeDefinition,
    tolerance: float = TOLERANCE,
    *,
    over_z: bool = False,
    also: ArrayLike = (),
) -> tuple[Array, float]:
    """Return span fractions (m,) that carry all quantities of a blade, and what is lost.

    All grids of the definition and its stations are united; then the intervals in which PCHIP
    on the common grid leaves a quantity's own curve by more than `tolerance` [m] are halved.

    Parameters
    ----------
    definition : BladeDefinition
        The blade.
    tolerance : float
        As said [m].
    over_z : bool
        Whether a reader of the format interpolates over z, not over the span fraction.
    also : (k,) array
        Span fractions that the grid must hold too: PCHIP changes with every point of its grid.

    Returns
    -------
    grid, loss
        The grid, and the largest deviation of a quantity left between its points [m].
    """
    quantities = _quantities(definition)
    error = _error(definition, over_z)
    return _halved(_united(definition, quantities, also), error, tolerance)


def lost(definition: BladeDefinition, grid: Array, *, over_z: bool = False) -> float:
    """Return the largest deviation [m] of a quantity between the points of a grid (m,)."""
    return float(_error(definition, over_z)(grid).max())


def _error(definition: BladeDefinition, over_z: bool) -> Callable[[Array], Array]:
    """Return what tells how far off a grid (m,) leaves quantities in its intervals (m - 1,) [m]."""
    quantities = _quantities(definition)
    along = (
        definition.axis.z if over_z else Distribution(np.array([0.0, 1.0]), np.array([0.0, 1.0]))
    )

    def error(grid: Array) -> Array:
        low, step = grid[:-1], np.diff(grid)
        probes = low[:, None] + step[:, None] * (np.arange(PROBES) + 0.5) / PROBES
        worst = np.zeros(len(step))
        for quantity, weight in quantities:
            curve = pchip(along(grid), quantity(grid))
            apart = np.abs(curve(along(probes)) - quantity(probes)) * weight(probes)
            worst = np.maximum(worst, apart.max(axis=1))
        for quantity, lever in ((definition.axis.x, FLAP_LEVER), (definition.axis.y, EDGE_LEVER)):
            curve = pchip(along(grid), quantity(grid))
            turned = curve(along(probes), 1) * along(probes, 1) - quantity(probes, 1)
            turned = turned / definition.axis.z(probes, 1) * lever * definition.chord(probes)
            worst = np.maximum(worst, np.abs(turned).max(axis=1))
        return worst

    return error


def shape_grid(blade: Blade, grid: Array) -> Array:
    """Return a grid with more points where sections change faster than the grid resolves."""

    def error(grid: Array) -> Array:
        middle = 0.5 * (grid[:-1] + grid[1:])
        ends = blade.profiles(grid)
        bow = np.abs(blade.profiles(middle) - 0.5 * (ends[:-1] + ends[1:]))
        largest: Array = bow.max(axis=(1, 2)) * blade.chord(middle)
        return largest

    return _halved(grid, error, SHAPE_TOLERANCE)[0]


def _halved(grid: Array, error: Callable[[Array], Array], tolerance: float) -> tuple[Array, float]:
    """Halve intervals until the error of each is within the tolerance, or room runs out."""
    while True:
        errors, step = error(grid), np.diff(grid)
        coarse = (errors > tolerance) & (step > CLOSEST)
        if not coarse.any() or len(grid) + coarse.sum() > MOST_NODES:
            return grid, float(errors.max())
        grid = np.sort(np.concatenate([grid, (grid[:-1] + 0.5 * step)[coarse]]))


def _united(
    definition: BladeDefinition,
    quantities: list[tuple[Distribution, Distribution]],
    also: ArrayLike,
) -> Array:
    """Return all grid points and stations, the ends among them, near doubles left out."""
    grids = [quantity.grid for quantity, _ in quantities]
    stations = [station.eta for station in definition.stations]
    return united([0.0, 1.0], stations, *grids, also, apart=CLOSEST)


def _quantities(definition: BladeDefinition) -> list[tuple[Distribution, Distribution]]:
    """Return each quantity with what turns it into metres on the surface."""
    one, chord = Distribution.constant(1.0), definition.chord
    axis = definition.axis
    pairs = [(chord, one), (definition.twist, chord), (axis.x, one), (axis.y, one), (axis.z, one)]
    if definition.section_offset_y is not None:
        pairs.append((definition.section_offset_y, one))
    if definition.pitch_axis is not None:
        pairs.append((definition.pitch_axis, chord))
    if definition.section_offset_x is not None:
        pairs.append((definition.section_offset_x, one))
    if definition.relative_thickness is not None:
        amplified = Distribution(chord.grid, SHAPE_LEVER * chord.values)
        pairs.append((definition.relative_thickness, amplified))
    return pairs
