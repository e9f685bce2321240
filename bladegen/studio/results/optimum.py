"""The shape coordinates with the most lift over drag at a section, by exact gradients.

NeuralFoil's coefficients are differentiable in the section's points, and the points in the
coordinates (`parametric.ParametricBlade`); SciPy's SLSQP follows the gradient.  Coordinates stay
where no section of the blade leaves the space's data, and the section's area within a limit; all
else of the state stays as it is.
"""

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.definition.estimates import THICK
from bladegen.errors import BladegenError, StudioError
from bladegen.parametric.model import ParametricBlade
from bladegen.studio.controls import AFFINE, controls
from bladegen.studio.model import Baseline
from bladegen.studio.results.question import Question
from bladegen.studio.state import State
from bladegen.support.arrays import Array

__all__ = ["LIMITS", "Optimum", "Wish", "bounds", "optimise"]

MOST = 60  # evaluations; most runs need a dozen
TOLERANCE = 1e-5  # of lift over drag, in hundreds
SHARES = 20  # parts of the way to an optimum, of which the longest without an odd section is taken
SLACK = 5e-4  # of the area, to which its limit is kept
CANCEL = "cancel"  # a file of this name in the folder ends the run
PROGRESS = "optimum.json"
LIMITS = {  # of what may be wished: lowest and highest
    "angle": (-5.0, 15.0),
    "band": (0.0, 5.0),
    "reach": (0.05, 1.0),
    "area": (0.0, 0.2),
}


@dataclass(frozen=True)
class Wish:
    """What is looked for.

    Parameters
    ----------
    question : Question
        The state to begin with, and the section.
    folder : str
        Where progress is written.
    angle, band : float
        The angle of attack, and how far on either side of it lift over drag counts as much [deg].
    reynolds : float
        The Reynolds number.
    reach : float
        How much of the way to the data's range coordinates may go.
    area : float
        By how much the section's area may grow.

    Raises
    ------
    StudioError
        If a number is outside `LIMITS`.
    """

    question: Question
    folder: str
    angle: float
    reynolds: float
    band: float = 2.0
    reach: float = 0.5
    area: float = 0.02

    def __post_init__(self) -> None:
        for name, (low, high) in LIMITS.items():
            value = getattr(self, name)
            if not low <= value <= high:
                raise StudioError(f"{name}: got {value:g}, allowed is {low:g} to {high:g}")

    @property
    def angles(self) -> Array:
        """Angles of attack (3,) [rad]."""
        return np.radians(self.angle + self.band * np.array([-1.0, 0.0, 1.0]))

    def cancel(self) -> None:
        """End the run, wherever it is."""
        (Path(self.folder) / CANCEL).touch()

    @property
    def progress(self) -> tuple[int, float, float] | None:
        """How many evaluations there were, the first lift over drag and the best."""
        try:
            words = (Path(self.folder) / PROGRESS).read_text(encoding="utf-8")
            count, first, best = json.loads(words)
        except (OSError, ValueError):  # not begun, or being written
            return None
        return int(count), float(first), float(best)


@dataclass(frozen=True)
class Optimum:
    """The state that was found, lift over drag before and there, and how many evaluations."""

    state: State
    before: float
    after: float
    evaluations: int
    cancelled: bool = False


class _CancelledError(Exception):
    """The run shall end, and nothing shall come of it."""


class _EnoughError(Exception):
    """The run has taken `MOST` evaluations."""


def bounds(baseline: Baseline, state: State, reach: float) -> tuple[Array, Array]:
    """Return how far coordinates (r,) may go, so that no section leaves the space's data."""
    low, high = baseline.room(state)
    known = controls(baseline.space)
    ends = [known[f"t{k + 1}"] for k in range(baseline.space.dimension)]
    lowest, highest = (np.array([float(getattr(c, end)) for c in ends]) for end in ("low", "high"))
    return np.maximum(reach * low, lowest), np.minimum(reach * high, highest)


def optimise(wish: Wish) -> Optimum:
    """Look for the coordinates, and go as far towards them as no section of the blade is odd.

    Raises
    ------
    StudioError
        If shapes do not change at the section, it is too thick, or NeuralFoil is not installed.
    """
    try:
        return _optimised(wish)
    except BladegenError as error:  # of which not all can travel between processes
        raise StudioError(" ".join(str(error).split())) from None


def _optimised(wish: Wish) -> Optimum:
    from scipy.optimize import minimize

    state, baseline = wish.question.state, wish.question.baseline
    low, high = bounds(baseline, state, wish.reach)
    if not (high > low).any():
        raise StudioError(
            f"section: shapes do not change at {100 * state.at:.0f} % of the span; move Fade from "
            "and Fade to below it"
        )
    run = _Run.of(wish)
    start = np.clip(state.t, low, high)
    plain = run.area(start)[0]

    def margin(t: Array) -> float:
        return 1.0 + wish.area - run.area(t)[0] / plain

    limit = {"type": "ineq", "fun": margin, "jac": lambda t: -run.area(t)[1] / plain}
    before = run.ratio(np.array(state.t))[0]
    kept: dict[str, Any] = {"count": 0, "best": before, "t": np.array(state.t)}
    folder = Path(wish.folder)

    def less(t: Array) -> tuple[float, Array]:
        if (folder / CANCEL).exists():
            raise _CancelledError
        value, slope = run.ratio(t)
        kept["count"] += 1
        if value > kept["best"] and margin(t) > -SLACK:
            kept.update(best=value, t=t.copy())
        words = json.dumps([kept["count"], before, kept["best"]])
        (folder / PROGRESS).write_text(words, encoding="utf-8")
        if kept["count"] >= MOST:
            raise _EnoughError
        return -value / 100.0, -slope / 100.0

    try:
        minimize(
            less,
            start,
            jac=True,
            bounds=list(zip(low, high, strict=True)),
            constraints=[limit],
            method="SLSQP",
            options={"ftol": TOLERANCE},
        )
    except _EnoughError:
        pass  # the best is kept
    except _CancelledError:
        return Optimum(state, before, before, kept["count"], cancelled=True)
    found = _without_oddities(state, baseline, kept["t"])
    return Optimum(found, before, run.ratio(np.array(found.t))[0], kept["count"])


def _without_oddities(state: State, baseline: Baseline, t: Array) -> State:
    """Return the state as far on the way to t as no check calls odd or bad what was not before."""
    before = _odd(baseline, state)
    for share in np.linspace(1.0, 0.0, SHARES + 1):
        found = _on_the_grid(state, baseline, share * t + (1.0 - share) * np.array(state.t))
        if _odd(baseline, found) <= before:
            return found
    return state


def _odd(baseline: Baseline, state: State) -> set[str]:
    return {one.what for one in baseline.scene(state).checks if one.status in ("odd", "bad")}


def _on_the_grid(state: State, baseline: Baseline, t: Array) -> State:
    """Return a state with coordinates that sliders can have."""
    known = controls(baseline.space)
    for k, value in enumerate(t):
        control = known[f"t{k + 1}"]
        low, high = float(control.low), float(control.high)
        state = state.having(control, min(max(float(value), low), high))
    return state


@dataclass(frozen=True, eq=False)
class _Run:
    """Lift over drag and area of a section as functions of shape coordinates.

    Parameters
    ----------
    model : ParametricBlade
        Of all that a state changes, at the section.
    rest : (p,) array
        The state's parameters, coordinates first.
    axes : (2, 3) array
        Of the section's plane, in space.
    angles : (m,) array
        Angles of attack [rad].
    reynolds : float
    """

    model: ParametricBlade
    rest: Array
    axes: Array
    angles: Array
    reynolds: float

    @classmethod
    def of(cls, wish: Wish) -> "_Run":
        state, baseline = wish.question.state, wish.question.baseline
        eta = np.array([state.at])
        thickness = float(baseline.blade.relative_thickness(eta)[0]) * state.thickness
        if thickness > THICK:
            raise StudioError(
                f"section: is {100 * thickness:.0f} % thick, NeuralFoil knows sections of up to "
                f"{100 * THICK:.0f} %; look at one farther out"
            )
        window = baseline.within(state)
        entries = ("pga", *(control.keyword for control in AFFINE))
        model = ParametricBlade(baseline.blade, baseline.space, entries, eta, window=window)
        rest = np.array([*state.t, *(control.amount(state) for control in AFFINE)])
        bent = baseline.variant(replace(state.reset(), prebend=state.prebend))
        axes = bent.planform.frames(eta)[0][[1, 0]]
        return cls(model, rest, axes, wish.angles, wish.reynolds)

    def _vector(self, t: Array) -> Array:
        vector = self.rest.copy()
        vector[: len(t)] = t
        return vector

    def ratio(self, t: Array) -> tuple[float, Array]:
        """Return the mean of lift over drag at the angles, and its gradient."""
        from bladegen.neuralfoil import coefficients

        x = self._vector(t)
        points = np.repeat(self.model.sections(x) @ self.axes.T, len(self.angles), axis=0)
        found = coefficients(points, self.angles, self.reynolds)
        lift, drag = found.values[:, 0], found.values[:, 1]
        of_lift, of_drag = found.in_points[:, 0], found.in_points[:, 1]
        each = of_lift / drag[:, None, None] - of_drag * (lift / drag**2)[:, None, None]
        slope = self.model.vjp(x, (each.mean(axis=0) @ self.axes)[None])
        return float(np.mean(lift / drag)), slope[: len(t)]

    def area(self, t: Array) -> tuple[float, Array]:
        """Return the section's area [m2], and its gradient."""
        found = self.model.quantities(self._vector(t))
        return float(found["section_area"][0]), found.jacobian("section_area")[0][: len(t)]
