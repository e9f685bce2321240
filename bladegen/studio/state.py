"""What a studio page shows: a frozen value, the query of a link, and a history of both.

A state names a blade of the library and what is changed of it.  Every number is a multiple of
its control's step within its control's bounds, so that a link, a command and a slider say the
same.  Twist is in degrees here, as people write it.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any
from urllib.parse import parse_qs, urlencode

import numpy as np

from bladegen.definition.distribution import Distribution
from bladegen.errors import StudioError
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.studio.choices.delivery import USUAL, Delivery
from bladegen.studio.choices.difference import known_part
from bladegen.studio.choices.drawn import CURVES, UNDRAWN, Drawn
from bladegen.studio.choices.loft import PLAIN, Loft
from bladegen.studio.controls import AFFINE, CONTROLS, END, START, Control, controls

__all__ = ["History", "State", "from_query", "to_query"]

LONGEST_QUERY = 2000
STEPS_KEPT = 200  # of a page's history
FAIR = "yes"  # in a link


@dataclass(frozen=True)
class State:
    """A blade and what is changed of it.

    Parameters
    ----------
    blade : str
        Its key in the library.
    t : tuple of float
        Coordinates along the modes [rad].
    window : (float, float), optional
        Where along the span changes fade in; past round roots if None.
    thickness, camber, chord, twist, prebend : float
        See `affine_change.AffineChange`; twist in degrees, prebend is `prebend_scale`.
    at : float
        Span fraction of the section that is shown.
    loft : Loft
        How the blade is made, before any change of it.
    off : str
        Which part of the difference from the baseline is coloured, of `difference.PARTS`.
    files : Delivery
        How files are written.
    curves : Drawn
        How chord, twist and prebend were dragged over span.
    beside : str
        Another blade's key in the library, shown as it is beside this one; "" for none.
    """

    blade: str
    t: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)
    window: tuple[float, float] | None = None
    thickness: float = 1.0
    camber: float = 1.0
    chord: float = 1.0
    twist: float = 0.0
    prebend: float = 1.0
    at: float = 0.5
    loft: Loft = PLAIN
    off: str = "all"
    files: Delivery = USUAL
    beside: str = ""
    curves: Drawn = UNDRAWN

    @property
    def changed(self) -> bool:
        """Whether the blade is another than its baseline."""
        moved = any(control.moved(self) for control in AFFINE)
        return any(self.t) or moved or self.curves != UNDRAWN

    def dragged(self, name: str, knot: int, value: float) -> "State":
        """Return the state with a curve over span dragged at one of its knots."""
        return replace(self, curves=self.curves.having(name, knot, value))

    @property
    def over_span(self) -> dict[str, Distribution]:
        """What was dragged, together with the sliders of chord and twist; twist in degrees."""
        bases = {"chord": self.chord, "twist": self.twist, "prebend": 0.0}
        found = {name: self.curves.over_span(name, base) for name, base in bases.items()}
        return {name: over for name, over in found.items() if over is not None}

    def value(self, name: str) -> float:
        """Return the number of the control `name` that is no end of the window."""
        return self.t[int(name[1:]) - 1] if _is_shape(name) else float(getattr(self, name))

    def having(self, control: Control, value: object) -> "State":
        """Return the state with one number set, or say why it is not allowed."""
        number = control.parsed(value)
        if _is_shape(control.name):
            k = int(control.name[1:]) - 1
            return replace(self, t=(*self.t[:k], number, *self.t[k + 1 :]))
        changed: dict[str, Any] = {control.name: number}
        return replace(self, **changed)

    def within(self, start: object, end: object) -> "State":
        """Return the state with a window, or say why it is not allowed."""
        window = START.parsed(start), END.parsed(end)
        if window[0] > window[1]:
            raise StudioError(
                f"{START.label}: the window got {window[0]:g} to {window[1]:g}, must rise: move "
                f"{START.label} below {END.label}"
            )
        return replace(self, window=window)

    def baseline(self, blade: str) -> "State":
        """Return a blade without changes: the same section shown, made as here."""
        return self.seen_as(State(blade, (0.0,) * len(self.t), loft=self.loft))

    def seen_as(self, other: "State") -> "State":
        """Return another state, looked at and written as this one: no step of a history."""
        return replace(other, at=self.at, off=self.off, files=self.files, beside=self.beside)

    def reset(self) -> "State":
        """Return the baseline, with the same section shown."""
        return self.baseline(self.blade)

    def drawn(self, space: ShapeSpace, rng: np.random.Generator, reach: float) -> "State":
        """Return random changes: shape in the ellipsoid and the box of the data, both times
        `reach`; the rest within a third of what its slider allows.
        """
        known = controls(space)
        while True:
            t = reach * space.sample(1, rng)[0]
            if space.outside(t / reach) is None:
                break
        result = replace(self, t=tuple(known[f"t{k + 1}"].parsed(x) for k, x in enumerate(t)))
        for control in AFFINE:
            middle = float(control.default)
            low, high = ((float(end) - middle) / 3 + middle for end in (control.low, control.high))
            result = result.having(control, rng.uniform(low, high))
        return result


def _is_shape(name: str) -> bool:
    return name[:1] == "t" and name[1:].isdigit()


def to_query(state: State) -> str:
    """Return a state as a link's query: the blade, and what is not the identity."""
    plain = State(state.blade, (0.0,) * len(state.t))
    words = {"blade": state.blade}
    if any(state.t):
        words["t"] = ",".join(f"{value:g}" for value in state.t)
    if state.window is not None:
        words["window"] = ",".join(f"{value:g}" for value in state.window)
    if state.loft.path != plain.loft.path:
        words["path"] = state.loft.path
    if state.loft.fair:
        words["fair"] = FAIR
    if state.off != plain.off:
        words["off"] = state.off
    if state.files.unit != plain.files.unit:
        words["unit"] = state.files.unit
    if state.files.tolerance != plain.files.tolerance:
        words["tolerance"] = f"{state.files.tolerance:g}"
    for name in CURVES:
        if getattr(state.curves, name):
            words[f"over.{name}"] = ",".join(f"{x:g}" for x in state.curves.values(name))
    if state.beside:
        words["beside"] = state.beside
    for entry in fields(State):
        value = getattr(state, entry.name)
        if isinstance(value, float) and value != getattr(plain, entry.name):
            words[entry.name] = f"{value:g}"
    return urlencode(words, safe=",")


def _fair(state: State, text: str) -> State:
    if text != FAIR:
        raise StudioError(f"link: fair: got {text[:40]!r}, allowed is {FAIR}")
    return replace(state, loft=replace(state.loft, fair=True))


def _tolerance(state: State, text: str) -> State:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")  # which no range allows
    return replace(state, files=replace(state.files, tolerance=value))


def _over(name: str) -> Callable[[State, str], State]:
    return lambda state, text: replace(state, curves=Drawn.parsed(name, text, state.curves))


CHOICES: dict[str, Callable[[State, str], State]] = {
    "path": lambda state, text: replace(state, loft=replace(state.loft, path=text)),
    "fair": _fair,
    "off": lambda state, text: replace(state, off=known_part(text)),
    "unit": lambda state, text: replace(state, files=replace(state.files, unit=text)),
    "tolerance": _tolerance,
    "beside": lambda state, text: replace(state, beside=text),
    **{f"over.{name}": _over(name) for name in CURVES},
}
KEYS = ("blade", "t", "window", *(control.name for control in AFFINE), "at", *CHOICES)  # of links


def from_query(query: str, known: Mapping[str, Control], default: str) -> State:
    """Return the state that a link's query holds; keys that are missing change nothing.

    Parameters
    ----------
    query : str
        Without its question mark.
    known : mapping
        The controls by name, as `controls` gives them.
    default : str
        The blade, where the query names none.

    Raises
    ------
    StudioError
        If a value is not allowed, or a key is none of a link's.
    """
    if len(query) > LONGEST_QUERY:
        raise StudioError(f"link: has {len(query)} characters, allowed are {LONGEST_QUERY}")
    words = {key: values[-1] for key, values in parse_qs(query).items()}
    modes = sum(map(_is_shape, known))
    state = State(words.pop("blade", default), (0.0,) * modes)
    for key, text in words.items():
        numbers = text.split(",")
        if key == "t":
            if len(numbers) != modes:
                raise StudioError(f"link: t: got {len(numbers)} coordinates, must be {modes}")
            for k, number in enumerate(numbers):
                state = state.having(known[f"t{k + 1}"], number)
        elif key == "window":
            if len(numbers) != 2:
                raise StudioError(f"link: window: got {text[:40]!r}, must be two span fractions")
            state = state.within(*numbers)
        elif key in CHOICES:
            state = CHOICES[key](state, text)
        elif key in CONTROLS and key not in ("start", "end"):
            state = state.having(known[key], text)
        else:
            allowed = ", ".join(KEYS)
            raise StudioError(f"link: {key[:40]!r} is unknown, allowed are {allowed}")
    return state


@dataclass(frozen=True)
class History:
    """States one after the other: those before, the present one, and those undone.

    Moves of one control without a pause are one step; the section that is shown is none.
    """

    present: State
    before: tuple[State, ...] = ()
    undone: tuple[State, ...] = ()
    moving: str = ""

    def moved(self, state: State, control: str = "") -> "History":
        """Return the history with a new present, reached by moving `control`."""
        if state == self.present:
            return self
        if self.present.seen_as(state) == self.present:
            return replace(self, present=state)
        if control and control == self.moving:
            return replace(self, present=state, undone=())
        before = (*self.before, self.present)[-STEPS_KEPT:]
        return History(state, before, (), control)

    def paused(self) -> "History":
        """Return the history after a control was let go: its next move is a step of its own."""
        return replace(self, moving="")

    def undo(self) -> "History":
        """Return the history one step back; itself at the start."""
        if not self.before:
            return self
        *before, present = self.before
        return History(self.present.seen_as(present), tuple(before), (*self.undone, self.present))

    def redo(self) -> "History":
        """Return the history one step forth; itself at the end."""
        if not self.undone:
            return self
        *undone, present = self.undone
        return History(self.present.seen_as(present), (*self.before, self.present), tuple(undone))
