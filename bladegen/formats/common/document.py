"""A cursor over a parsed document that knows its place and collects what is wrong.

A `Node` is a value with its path inside the file.  Asking it for something that it does not
hold notes a problem with path, value and what is allowed, and goes on with None, so that one
reading reports all problems of a file at once.
"""

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bladegen.definition.blade_definition import SMALLEST_RISE, SMALLEST_STEP, Distribution
from bladegen.errors import Finding
from bladegen.support.arguments import alike
from bladegen.support.arrays import Array, ArrayLike, Indices, Mask

__all__ = ["FRACTION", "Node", "Notes", "Range"]

GRID_ROUNDING = 1e-6  # a grid may leave [0, 1] by so much; it is cut, and said
MAX_ENTRIES = 100_000  # far above any published table (399 rows); bounds time and memory
SHOWN_ENTRIES = 5  # wrong entries of one list that are named one by one
SHOWN_PROBLEMS = 100  # problems of one file that are named one by one
SHOWN_CHARACTERS = 40
_ABSENT = object()


@dataclass(frozen=True)
class Range:
    """The numbers that a place may hold: `low` to `high`, without `low` where `above`."""

    low: float
    high: float
    unit: str = ""
    above: bool = False

    def holds(self, values: ArrayLike) -> Mask:
        """Tell which values are allowed; not-a-number never is."""
        values = np.asarray(values, dtype=np.float64)
        mask: Mask = (values > self.low) if self.above else (values >= self.low)
        return mask & (values <= self.high)

    def __str__(self) -> str:
        text = f"{'above ' if self.above else ''}{self.low:g} to {self.high:g} {self.unit}"
        return text.rstrip()


FRACTION = Range(0.0, 1.0, "(root to tip)")


@dataclass
class Notes:
    """What a reading has found so far: problems refuse the file, findings do not."""

    problems: list[str] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)

    def shown(self) -> list[str]:
        """Return each problem once, cut where nobody would read on."""
        problems = list(dict.fromkeys(self.problems))
        more = len(problems) - SHOWN_PROBLEMS
        return problems[:SHOWN_PROBLEMS] + ([f"and {more} more problems"] if more > 0 else [])


@dataclass(frozen=True)
class Node:
    """A value of a document, its path in the file, and where to note what is wrong."""

    value: Any
    path: str
    notes: Notes

    def problem(self, message: str) -> None:
        """Note a problem at this place."""
        self.notes.problems.append(f"{self.path}: {message}" if self.path else message)

    def finding(self, message: str) -> None:
        """Note a remark at this place."""
        self.notes.findings.append(Finding(self.path, message))

    def has(self, key: str) -> bool:
        """Tell whether this is a mapping with a value for `key`."""
        return isinstance(self.value, dict) and self.value.get(key) is not None

    def __getitem__(self, key: str) -> "Node":
        """Go to a member; a missing one is a problem, noted once."""
        member = Node(_ABSENT, f"{self.path}.{key}" if self.path else key, self.notes)
        if self.value is _ABSENT:
            return member
        if not isinstance(self.value, dict):
            self.problem(f"got {_shown(self.value)}, must be a mapping")
            return member
        if not self.has(key):
            near = alike(key, [name for name in self.value if isinstance(name, str)])
            meant = f"; {near!r} stands there" if near and near != key else ""
            member.problem(f"is missing, must be given{meant}")
            return member
        return Node(self.value[key], member.path, self.notes)

    def members(self) -> list["Node"]:
        """Return the entries of a list."""
        return [Node(value, f"{self.path}[{i}]", self.notes) for i, value in self._entries()]

    def text(self) -> str | None:
        """Return the value as text; a number is taken as it is written."""
        if isinstance(self.value, str | int | float) and not isinstance(self.value, bool):
            return str(self.value)
        if self.value is not _ABSENT:
            self.problem(f"got {_shown(self.value)}, must be a text")
        return None

    def number(self, allowed: Range) -> float | None:
        """Return the value if it is a number within `allowed`."""
        if self.value is _ABSENT:
            return None
        number = _number(self.value)
        if allowed.holds(number):
            return number
        self.problem(_refusal(self.value, allowed))
        return None

    def numbers(self, allowed: Range) -> Array | None:
        """Return the value if it is a list of numbers within `allowed`."""
        entries = [value for _, value in self._entries()]
        if not entries:
            return None
        plain = set(map(type, entries)) == {float}
        values = np.array(entries if plain else [_number(entry) for entry in entries])
        wrong = np.flatnonzero(~allowed.holds(values))
        self.each(wrong, lambda i: _refusal(entries[i], allowed))
        return None if wrong.size else values

    def each(self, entries: Iterable[Any], message: Callable[[int], str]) -> None:
        """Note a problem on each of the `entries` of a list, those after the fifth as one."""
        places = [int(i) for i in entries]
        for i in places[:SHOWN_ENTRIES]:
            Node(None, f"{self.path}[{i}]", self.notes).problem(message(i))
        if len(places) > SHOWN_ENTRIES:
            self.problem(f"{len(places) - SHOWN_ENTRIES} more entries like these")

    def distribution(
        self,
        allowed: Range,
        *,
        factor: float = 1.0,
        rising: bool = False,
        partial: bool = False,
    ) -> Distribution | None:
        """Return the quantity that `grid` and `values` give.

        Parameters
        ----------
        allowed : Range
            What each value may be, in the file's unit.
        factor : float
            From the file's unit to metres, radians or fractions.
        rising : bool
            Values must increase.
        partial : bool
            A grid need not reach root and tip: there is nothing of the quantity beyond its ends.
        """
        grid, values = self["grid"].span_fractions(), self["values"].numbers(allowed)
        if grid is None or values is None:
            return None
        if len(grid) != len(values):
            self.problem(f"grid has {len(grid)} entries and values {len(values)}, must be alike")
            return None
        repeated = np.flatnonzero((np.diff(grid) == 0) & (np.diff(values) == 0)) + 1
        ordered = self["grid"]._increase(grid, repeated, SMALLEST_STEP)
        if rising:
            ordered &= self["values"]._increase(values, repeated, SMALLEST_RISE)
        if len(grid) - len(repeated) < 2:
            self["grid"].problem("has 1 entry, at least 2 that differ are needed")
            return None
        if not ordered:
            return None
        if repeated.size:
            self.finding(f"{len(repeated)} repeated entries dropped")
            grid, values = np.delete(grid, repeated), np.delete(values, repeated)
        if not partial and (grid[0] > 0 or grid[-1] < 1):
            self.finding(f"grid runs {grid[0]:g} to {grid[-1]:g}; beyond it the end value is held")
        return Distribution(grid, factor * values)

    def span_fractions(self) -> Array | None:
        """Return a list of span fractions; what leaves [0, 1] by rounding is cut, and said."""
        rounded = Range(-GRID_ROUNDING, 1.0 + GRID_ROUNDING)
        entries = [value for _, value in self._entries()]
        if not entries:
            return None
        values = np.array([_number(entry) for entry in entries])
        if not rounded.holds(values).all():
            wrong = np.flatnonzero(~rounded.holds(values))
            self.each(wrong, lambda i: _refusal(entries[i], FRACTION))
            return None
        cut: Array = np.clip(values, 0.0, 1.0)
        if np.any(cut != values):
            self.finding("leaves 0 to 1 by rounding; cut")
        return cut

    def _increase(self, values: Array, repeated: Indices, least: float) -> bool:
        """Tell whether values increase but for `repeated` entries; say which do not."""
        falls = ~(np.diff(values) >= least)
        falls[repeated - 1] = False
        steps = np.flatnonzero(falls) + 1
        self.each(steps, lambda i: f"got {values[i]:g} after {values[i - 1]:g}, must increase")
        return not steps.size

    def _entries(self) -> Iterator[tuple[int, Any]]:
        """Go through a list that is neither empty nor too long."""
        if self.value is _ABSENT:
            return
        if not isinstance(self.value, list):
            self.problem(f"got {_shown(self.value)}, must be a list")
        elif not 1 <= len(self.value) <= MAX_ENTRIES:
            self.problem(f"has {len(self.value)} entries, allowed are 1 to {MAX_ENTRIES}")
        else:
            yield from enumerate(self.value)


def _number(value: Any) -> float:
    """Return a number as a float, anything else as not-a-number."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return math.nan
    try:
        return float(value)
    except OverflowError:  # an integer of more than 308 digits
        return math.inf


def _refusal(value: Any, allowed: Range) -> str:
    demand = "allowed is" if _number(value) == _number(value) else "must be a number,"
    return f"got {_shown(value)}, {demand} {allowed}"


def _shown(value: Any) -> str:
    """Show a value of any kind and size in a few words."""
    if isinstance(value, dict):
        return f"a mapping of {len(value)}"
    if isinstance(value, list):
        return f"a list of {len(value)}"
    text = "nothing" if value is None else repr(value)
    return text if len(text) <= SHOWN_CHARACTERS else text[: SHOWN_CHARACTERS - 3] + "..."
