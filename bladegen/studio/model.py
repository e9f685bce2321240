"""From a state to what a page shows: surface, section, curves over span, and checks.

A `Baseline` is a blade prepared once; its `scene` makes a variant of it in milliseconds, through
the same `batch` that families are made with.  Sections stand at every hundredth of the span and
where the blade bends.  Metres and radians, blade frame.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.changes.deformation import AffineChange, Window
from bladegen.blade.variants.batch import Batch, SectionBatch
from bladegen.blade.variants.verdicts import THINNEST
from bladegen.definition.distribution import Distribution
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.studio.checks.verdicts import Measured, checks
from bladegen.studio.choices.difference import left
from bladegen.studio.choices.drawn import KNOTS
from bladegen.studio.controls import AFFINE
from bladegen.studio.scene import Check, Curves, Scene, flattened
from bladegen.studio.state import State
from bladegen.support.arrays import Array, Mask
from bladegen.support.files import safe_stem
from bladegen.views.rendering.offsets import outward_normals

__all__ = ["Baseline", "changes"]

PERCENTS = np.linspace(0.0, 1.0, 101)  # where a section can be looked at
BENDING = 40  # spans that follow the blade's bends
DRAWS = 500
UNMOVED = 1e-3  # of a full change: a knot where the window lets nothing change


def changes(state: State) -> dict[str, Any]:
    """Return what a state asks of `Blade.perturbed`, beside the space; nothing is the identity."""
    asked: dict[str, Any] = {}
    if any(state.t):
        asked["t"] = list(state.t)
    asked |= {control.keyword: control.amount(state) for control in AFFINE if control.moved(state)}
    asked |= _over_span(state)
    if state.window is not None:
        asked["window"] = Window(*state.window)
    return asked


def _over_span(state: State) -> dict[str, Distribution]:
    """Return what was dragged over span, by keyword, twist in radians."""
    found = state.over_span
    if "twist" in found:
        found["twist"] = replace(found["twist"], values=np.radians(found["twist"].values))
    return found


@dataclass(frozen=True, eq=False)
class Baseline:
    """A blade of the library, ready to be shown with changes.

    Parameters
    ----------
    key : str
        Its key in the library.
    blade : Blade
        The blade.
    space : ShapeSpace
        The modes of its shape.
    """

    key: str
    blade: Blade
    space: ShapeSpace

    @cached_property
    def eta(self) -> Array:
        """Span fractions of the sections."""
        fixed = len(np.unique(self.blade.eta)) + 2
        return np.union1d(PERCENTS, self.blade.stations(max(BENDING, fixed)))

    @cached_property
    def window(self) -> Window:
        """Where changes act, if a state says nothing."""
        return Window.beyond_circles(self.blade.definition.stations)

    @cached_property
    def _prepared(self) -> SectionBatch:
        return SectionBatch(self.blade, self.space, self.window, self.eta)

    def _batch(self, state: State) -> Batch:
        batch: Batch = self._sections(state).evaluate(*self._asked(state))
        return batch

    def _sections(self, state: State) -> SectionBatch:
        return self._prepared.within(Window(*state.window)) if state.window else self._prepared

    def _asked(self, state: State) -> tuple[Array, AffineChange]:
        amounts: Any = {control.keyword: control.amount(state) for control in AFFINE}
        for name, over in _over_span(state).items():  # what the batch has at its own spans
            amounts[name] = over if name == "prebend" else over(self.eta)[None]
        return np.array([state.t]), AffineChange(**amounts)

    def at(self, span: float) -> Scene:
        """Return the blade without changes, its section at a span fraction looked at."""
        return replace(self._plain, state=replace(self._plain.state, at=span))

    @cached_property
    def _plain(self) -> Scene:
        return self.scene(State(self.key, (0.0,) * self.space.dimension))

    @cached_property
    def _rest(self) -> tuple[Array, Array]:
        """The surface without changes, and its outward normals, both (k, n, 3)."""
        sections = self._batch(State(self.key, (0.0,) * self.space.dimension)).sections[0]
        return sections, outward_normals(sections)

    def scene(self, state: State) -> Scene:
        """Make what a page shows of a state of this blade."""
        batch = self._batch(state)
        sections = batch.sections[0]
        rest, normals = self._rest
        deviation = np.sum((sections - rest) * normals, axis=-1)
        shown = deviation
        if state.off != "all":
            shown = np.sum(left(sections, rest, state.off) * normals, axis=-1)
        curves = Curves(
            self.eta,
            batch.chord[0],
            np.degrees(batch.twist[0]),
            100.0 * batch.relative_thickness[0],
            self._prebend(state),
        )
        return Scene(
            state,
            self.eta,
            sections,
            shown,
            curves,
            self._checks(state, batch, deviation),
        )

    def _prebend(self, state: State) -> Array:
        added = state.over_span.get("prebend")
        own: Array = state.prebend * self.blade.axis(self.eta)[:, 0]
        return own if added is None else own + added(self.eta)

    def dragged(self, state: State, name: str, knot: int, value: float) -> State:
        """Return a state whose curve passes through a value at a knot, as far as it may go.

        Chord, twist and prebend there are linear in what is dragged, by the window's weight.
        """
        at = np.array([KNOTS[knot]])
        weight = float(self.within(state)(at)[0])
        if name == "prebend":
            wanted = value - state.prebend * float(self.blade.axis(at)[0, 0])
        elif weight < UNMOVED:
            return state
        elif name == "twist":
            wanted = (value - float(np.degrees(self.blade.twist(at)[0]))) / weight - state.twist
        else:
            share = (value / float(self.blade.chord(at)[0]) - 1.0) / weight + 1.0
            wanted = share / (state.chord * (2.0 - state.camber))
        return state.dragged(name, knot, wanted)

    def drawn(self, state: State, rng: np.random.Generator, reach: float = 0.35) -> State:
        """Return a random variant that is sound, at the same window and section."""
        for _ in range(DRAWS):
            state = state.drawn(self.space, rng, reach)
            sections, asked = self._sections(state), self._asked(state)
            if self._left(state).any():
                continue
            faults, thickness, looks = sections.tested(*asked)
            odd = sections.oddities(looks).kinds.any()
            if not (faults.any() or odd or thickness.min() < THINNEST):
                break
        return state

    def within(self, state: State) -> Window:
        """Return where a state's changes act."""
        return Window(*state.window) if state.window else self.window

    def room(self, state: State) -> tuple[Array, Array]:
        """Return how far coordinates (r,) may go without a section that leaves the data."""
        sections = self._sections(state)
        assert sections.domain is not None  # a baseline has a space
        domain, weight = sections.domain, sections.weight
        judged = (weight > 0.0) & np.isfinite(domain.high[:, 0])
        if not weight[np.argmin(np.abs(self.eta - state.at))] > 0.0 or not judged.any():
            return np.zeros(self.space.dimension), np.zeros(self.space.dimension)
        share = weight[judged, None]
        low = ((domain.low - domain.own)[judged] / share).max(axis=0)
        high = ((domain.high - domain.own)[judged] / share).min(axis=0)
        return low, high

    def peek(self, state: State, mode: int) -> tuple[Array, float]:
        """Return the section looked at, moved along a mode by minus, nothing and plus a step.

        Profiles (3, n, 2) as `Scene.profile` has them, and the step: one standard deviation of
        the space's data [rad].
        """
        step = float(np.sqrt(self.space.variances[mode]))
        t = np.tile(state.t, (3, 1))
        t[:, mode] += step * np.array([-1.0, 0.0, 1.0])
        _, change = self._asked(state)
        batch = self._sections(state).evaluate(t, change, tested=False)
        place = int(np.argmin(np.abs(self.eta - state.at)))
        rows = zip(batch.sections[:, place], batch.chord[:, place], strict=True)
        return np.stack([flattened(section, float(chord)) for section, chord in rows]), step

    def variant(self, state: State) -> Blade:
        """Return the blade of a state, tested; what the checks call odd is among its findings.

        Raises
        ------
        PerturbationError
            If a section crosses itself or loses its thickness.
        """
        asked = changes(state)
        if not state.changed:
            return self.blade
        space = self.space if "t" in asked else None
        return self.blade.perturbed(
            space,
            asked.pop("t", ()),
            name=f"{self.blade.name}-variant",
            allow_extrapolation=True,
            allow_odd=True,
            **asked,
        )

    def stem(self, state: State) -> str:
        """Return the name of a state's files, without their suffix."""
        return safe_stem(f"{self.blade.name}-variant" if state.changed else self.blade.name)

    def _checks(self, state: State, batch: Batch, deviation: Array) -> tuple[Check, ...]:
        sections = self._sections(state)
        assert sections.domain is not None  # a baseline has a space
        found = Measured(
            self.eta,
            batch,
            deviation,
            sections.oddities(batch.looks),
            sections.domain,
            sections.step(np.array([state.t]))[0],
            np.sqrt(self.space.variances[: self.space.dimension]),
            self._rest[0],
        )
        return checks(found)

    def _left(self, state: State) -> Mask:
        """Tell which sections leave the space's data, (k,)."""
        sections = self._sections(state)
        assert sections.domain is not None  # a baseline has a space
        left: Mask = sections.domain.left(sections.step(np.array([state.t])))[0]
        return left
