"""Fair planforms: chord, twist, offsets and axis as C2 curves that stay near the given ones.

PCHIP, which windIO recommends, is C1: curvature jumps at every grid point, and reflections on the
surface break there.  A fair curve is the cubic spline whose curvature varies least: it minimises
the integral of the squared third derivative among all that lie within a bound of the given curve,
at its points and between them.  With the values at the knots as unknowns that is a linear least
squares problem with bounds; knots are added where the bound is exceeded between them.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.distribution import SMALLEST_STEP, Distribution, cubic_spline, united
from bladegen.definition.reference_axis import ReferenceAxis
from bladegen.definition.thickness import ruled
from bladegen.errors import DefinitionError, Finding
from bladegen.support.arguments import amount, instance
from bladegen.support.arrays import Array

__all__ = ["PlanformFairing", "fair_planform", "faired"]

MOST_SHARE = 0.05  # of the chord; more is another planform
MOST_TURN = np.radians(5.0)
FEWEST_KNOTS = 8  # that may move; a spline with fewer has no choice
HELD = 0.9  # of the bound, at knots; curves go a little farther between them
OVER = 0.02
BETWEEN = np.linspace(0.0, 1.0, 11)[1:-1]  # of an interval: where curves are compared
ROUNDS = 20  # of halving intervals
RISE = 0.2  # of the lesser of the steps of z beside a point: z still increases
CONVERGED = 1e-12  # of the integral
STRAIGHT = 1e-6  # of the bound: what is nearer to a straight line is one
CHORDS = (100.0, " % of the chord")
UNITS = {
    "twist": (float(np.degrees(1.0)), " deg"),
    "pitch axis": CHORDS,
    "relative thickness": CHORDS,
}

NOWHERE = np.zeros(0)

Bound = Callable[[Array], Array]


@dataclass(frozen=True)
class PlanformFairing:
    """How far a fair planform may lie from the given one.

    Parameters
    ----------
    chord : float
        Of the local chord: bound of chord, offsets, reference axis and thickness each.
    twist : float
        Bound of the twist [rad].
    """

    chord: float = 1e-3
    twist: float = float(np.radians(0.02))

    def __post_init__(self) -> None:
        for name, most, unit in (
            ("chord", MOST_SHARE, "of the chord"),
            ("twist", MOST_TURN, "rad"),
        ):
            value = amount(getattr(self, name), f"fair_planform: {name}", DefinitionError)
            if not 0.0 < value <= most:
                raise DefinitionError(
                    f"fair_planform: {name}: got {value:g}, allowed is more than 0 to {most:.3g} "
                    f"{unit}"
                )

    def __str__(self) -> str:
        share, turn = 100.0 * self.chord, float(np.degrees(self.twist))
        return f"{share:.12g}%,{turn:.12g}deg"


def fair_planform(definition: BladeDefinition, fairing: PlanformFairing) -> BladeDefinition:
    """Return a definition with a fair planform; a finding says by how much it moved.

    Its relative thickness, without which a surface is not fair, stays at the stations.
    """
    must = "a BladeDefinition, such as bladegen.read('iea15mw') or bladegen.read(path) gives"
    instance(definition, BladeDefinition, "definition", must, DefinitionError)
    must = "a bladegen.PlanformFairing, or None to keep the planform"
    instance(fairing, PlanformFairing, "fair_planform", must, DefinitionError)
    definition = ruled(definition)
    stations = np.array([station.eta for station in definition.stations])
    chord, axis, z = definition.chord, definition.axis, definition.axis.z
    rise = RISE * np.diff(z.values)
    least = np.minimum(np.append(rise, rise[-1]), np.insert(rise, 0, rise[0]))

    def length(eta: Array) -> Array:
        bound: Array = fairing.chord * chord(eta)
        return bound

    def rising(eta: Array) -> Array:
        bound: Array = np.minimum(length(eta), np.interp(eta, z.grid, least))
        return bound

    said: list[str] = []

    def fair(name: str, given: Distribution, bound: Bound, held: Array = NOWHERE) -> Distribution:
        made = faired(given, bound, held)
        if made is not given:
            said.append(_moved(name, given, made))
        return made

    def if_given(
        name: str, given: Distribution | None, bound: Bound, held: Array = NOWHERE
    ) -> Distribution | None:
        return None if given is None else fair(name, given, bound, held)

    def share(eta: Array) -> Array:
        return np.full(eta.shape, fairing.chord)

    result = replace(
        definition,
        chord=fair("chord", chord, length),
        twist=fair("twist", definition.twist, lambda eta: np.full(eta.shape, fairing.twist)),
        section_offset_y=if_given("offset y", definition.section_offset_y, length),
        section_offset_x=if_given("offset x", definition.section_offset_x, length),
        pitch_axis=if_given("pitch axis", definition.pitch_axis, share),
        relative_thickness=if_given(
            "relative thickness", definition.relative_thickness, share, stations
        ),
        axis=ReferenceAxis(
            fair("axis x", axis.x, length),
            fair("axis y", axis.y, length),
            fair("axis z", z, rising),
        ),
    )
    moved = ", ".join(said) if said else "it was fair"
    finding = Finding("planform", f"faired within {fairing}: {moved}")
    return replace(result, findings=(*definition.findings, finding))


def faired(quantity: Distribution, bound: Bound, held: Array = NOWHERE) -> Distribution:
    """Return the fairest C2 distribution within a bound of a given one.

    Parameters
    ----------
    quantity : Distribution
        What is given; it stays as it is if it is a straight line.
    bound : callable
        The largest distance at span fractions (k,), positive.
    held : (h,) array, optional
        Span fractions at which it stays, besides its ends.  It leaves the range of its values
        nowhere by more than `OVER` of the bound: a round root is no thicker than round.
    """
    grid = quantity.grid
    straight = np.interp(grid, grid[[0, -1]], quantity.values[[0, -1]])
    if np.all(np.abs(quantity.values - straight) <= STRAIGHT * bound(grid)):
        return quantity
    held = np.concatenate([held, grid[[0, -1]]])
    grid = united(grid, held[(held >= grid[0]) & (held <= grid[-1])])
    for _ in range(ROUNDS):
        near = np.abs(grid[:, None] - held).min(axis=1) > SMALLEST_STEP
        if np.count_nonzero(near) < FEWEST_KNOTS:
            grid = united(grid, 0.5 * (grid[1:] + grid[:-1]))
            continue
        moved = _fairest(grid, quantity(grid), HELD * bound(grid) * near)
        made = Distribution(grid, moved, cubic_spline)
        inner = grid[:-1, None] + np.diff(grid)[:, None] * BETWEEN
        values, limit = made(inner), bound(inner)
        beyond = np.maximum(values - quantity.values.max(), quantity.values.min() - values)
        off = np.maximum(np.abs(values - quantity(inner)), beyond / OVER)
        far = np.any(off > limit, axis=1)
        if not far.any():
            return made
        grid = united(grid, (0.5 * (grid[1:] + grid[:-1]))[far])
    return quantity


def _fairest(grid: Array, values: Array, bound: Array) -> Array:
    """Return the values (n,) within a bound (n,) of given ones whose spline is the fairest."""
    from scipy.optimize import lsq_linear

    low = np.maximum(-bound, values.min() - values)
    high = np.minimum(bound, values.max() - values)
    free = low < high
    middle, steps = 0.5 * (grid[1:] + grid[:-1]), np.diff(grid)
    third = cubic_spline(grid, np.eye(len(grid)))(middle, nu=3) * np.sqrt(steps)[:, None]
    third /= np.abs(third).max()
    shares, limits = third[:, free] * bound[free], (low[free], high[free]) / bound[free]
    size = np.linalg.norm(shares)
    found = lsq_linear(shares / size, -(third @ values) / size, limits, tol=CONVERGED)
    moved: Array = values.copy()
    moved[free] += bound[free] * found.x
    return moved


def _moved(name: str, given: Distribution, made: Distribution) -> str:
    """Say by how much a quantity moved at most, and where."""
    eta = np.union1d(made.grid, np.linspace(0.0, 1.0, 1001))
    off = np.abs(made(eta) - given(eta))
    worst = int(np.argmax(off))
    scale, unit = UNITS.get(name, (1e3, " mm"))
    return f"{name} by at most {scale * off[worst]:.2g}{unit} (eta = {eta[worst]:.3f})"
