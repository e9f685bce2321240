"""Documents at the edge: safe YAML, and a cursor that collects what is wrong with them.

A `Node` is a value with its path inside the file.  Asking it for something it does not hold
notes a problem with path, value and what is allowed, and goes on, so that one reading reports
all problems of a file at once.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import yaml

from bladegen.arrays import Array
from bladegen.definition import Distribution
from bladegen.errors import FileError, Finding

__all__ = ["Node", "Notes", "load_yaml"]

MAX_BYTES = 64_000_000
GRID_ROUNDING = 1e-6  # a grid may run over [0, 1] by so much; it is cut, and said
_ABSENT = object()


class _Loader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):  # type: ignore[misc]
    """Safe YAML with the numbers of YAML 1.2: `5e-05` is a number, not text."""

    def flatten_mapping(self, node: yaml.MappingNode) -> None:
        for key, _ in node.value:
            if key.tag == "tag:yaml.org,2002:merge":
                raise yaml.constructor.ConstructorError(
                    None, None, "merge keys (<<) are not supported", key.start_mark
                )


_FLOAT = re.compile(
    r"^(?:[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
    r"|[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN))$"
)
_FLOAT_TAG = "tag:yaml.org,2002:float"
_Loader.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in pairs if tag != _FLOAT_TAG]
    for first, pairs in _Loader.yaml_implicit_resolvers.items()
}
_Loader.add_implicit_resolver(_FLOAT_TAG, _FLOAT, list("-+0123456789."))


def load_yaml(path: Path) -> Any:
    """Parse a YAML file safely.

    Raises
    ------
    FileError
        If the file cannot be read, is too large or is no YAML.
    """
    try:
        if path.stat().st_size > MAX_BYTES:
            raise FileError(
                str(path), [f"{path.stat().st_size} bytes, allowed are at most {MAX_BYTES}"]
            )
        text = path.read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise FileError(str(path), [f"cannot be read: {error.strerror}"]) from None
    except UnicodeDecodeError as error:
        raise FileError(str(path), [f"is no text: byte {error.start} is not UTF-8"]) from None
    try:
        return yaml.load(text, Loader=_Loader)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        place = f"line {mark.line + 1}, column {mark.column + 1}: " if mark else ""
        raise FileError(str(path), [f"{place}{error.problem}"]) from None
    except yaml.YAMLError as error:
        raise FileError(str(path), [" ".join(str(error).split())]) from None
    except RecursionError:
        raise FileError(str(path), ["is nested too deeply"]) from None
    except ValueError as error:  # a date or number that YAML admits and Python does not
        raise FileError(str(path), [f"holds a value that cannot be read: {error}"]) from None


@dataclass
class Notes:
    """What a reading has found so far: problems refuse the file, findings do not."""

    problems: list[str] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)


@dataclass(frozen=True)
class Node:
    """A value of a document, its path in the file, and where to note what is wrong."""

    value: Any
    path: str
    notes: Notes

    def problem(self, message: str) -> None:
        """Note a problem at this place."""
        self.notes.problems.append(f"{self.path or 'the document'}: {message}")

    def finding(self, message: str) -> None:
        """Note a remark at this place."""
        self.notes.findings.append(Finding(self.path, message))

    def has(self, key: str) -> bool:
        """Tell whether this is a mapping with a value for `key`."""
        return isinstance(self.value, dict) and self.value.get(key) is not None

    def __getitem__(self, key: str) -> "Node":
        """Go to a member; a missing one is a problem, noted once."""
        path = f"{self.path}.{key}" if self.path else key
        if self.value is _ABSENT:
            return Node(_ABSENT, path, self.notes)
        if not isinstance(self.value, dict):
            self.problem(f"got {_shown(self.value)}, must be a mapping with {key!r}")
            return Node(_ABSENT, path, self.notes)
        if self.value.get(key) is None:
            self.notes.problems.append(f"{path}: is missing, must be given")
            return Node(_ABSENT, path, self.notes)
        return Node(self.value[key], path, self.notes)

    def __iter__(self) -> Iterator["Node"]:
        """Go through the members of a list."""
        if self.value is _ABSENT:
            return
        if not isinstance(self.value, list):
            self.problem(f"got {_shown(self.value)}, must be a list")
            return
        for i, value in enumerate(self.value):
            yield Node(value, f"{self.path}[{i}]", self.notes)

    def text(self) -> str | None:
        """Return the value if it is text."""
        if isinstance(self.value, str | int) and not isinstance(self.value, bool):
            return str(self.value)
        if self.value is not _ABSENT:
            self.problem(f"got {_shown(self.value)}, must be text")
        return None

    def number(self) -> float | None:
        """Return the value if it is a finite number."""
        if self.value is _ABSENT:
            return None
        number = _number(self.value)
        if number is None:
            self.problem(f"got {_shown(self.value)}, must be a finite number")
        return number

    def numbers(self) -> Array | None:
        """Return the value if it is a list of finite numbers."""
        if self.value is _ABSENT:
            return None
        if not isinstance(self.value, list):
            self.problem(f"got {_shown(self.value)}, must be a list of numbers")
            return None
        numbers = [_number(value) for value in self.value]
        for i, number in enumerate(numbers):
            if number is None:
                self.notes.problems.append(
                    f"{self.path}[{i}]: got {_shown(self.value[i])}, must be a finite number"
                )
        if None in numbers:
            return None
        return np.array(numbers, dtype=np.float64)

    def span(self) -> float | None:
        """Return the value if it is a span fraction, 0 to 1."""
        eta = self.number()
        if eta is None:
            return None
        if not -GRID_ROUNDING <= eta <= 1 + GRID_ROUNDING:
            self.problem(f"got {eta:g}, allowed is 0 (root) to 1 (tip)")
            return None
        return min(max(eta, 0.0), 1.0)

    def distribution(
        self, *, factor: float = 1.0, lowest: float | None = None, rising: bool = False
    ) -> Distribution | None:
        """Return the quantity that `grid` and `values` give.

        Parameters
        ----------
        factor : float
            From the file's unit to metres, radians or fractions.
        lowest : float, optional
            Values must be greater.
        rising : bool
            Values must increase.
        """
        grid, values = self["grid"].numbers(), self["values"].numbers()
        if grid is None or values is None:
            return None
        grid, kept = self["grid"]._grid(grid, values)
        if len(grid) != len(values):
            self.problem(f"grid has {len(grid)} entries and values {len(values)}, must be alike")
            return None
        before = len(self.notes.problems)
        for i in np.flatnonzero(np.diff(grid[kept]) <= 0):
            a, b = grid[kept][i : i + 2]
            self.problem(f"grid[{i + 1}] is {b:g} after {a:g}, must increase")
        if lowest is not None:
            for i in np.flatnonzero(values <= lowest):
                self.problem(f"values[{i}] is {values[i]:g}, must be greater than {lowest:g}")
        if rising:
            for i in np.flatnonzero(np.diff(values[kept]) <= 0):
                a, b = values[kept][i : i + 2]
                self.problem(f"values[{i + 1}] is {b:g} after {a:g}, must increase")
        if len(kept) < 2:
            self.problem(f"has {len(kept)} grid points, at least 2 are needed")
        if len(self.notes.problems) > before:
            return None
        return Distribution(grid[kept], factor * values[kept])

    def _grid(self, grid: Array, values: Array) -> tuple[Array, npt.NDArray[np.intp]]:
        """Cut rounding off a grid's ends; return it and the entries that are no repetition."""
        for i in np.flatnonzero((grid < -GRID_ROUNDING) | (grid > 1 + GRID_ROUNDING)):
            self.notes.problems.append(
                f"{self.path}[{i}]: got {grid[i]:g}, allowed is 0 (root) to 1 (tip)"
            )
        cut = np.clip(grid, 0.0, 1.0)
        if np.any(cut != grid):
            self.finding("runs over 0 to 1 by rounding; cut")
        kept = np.arange(len(cut), dtype=np.intp)
        if len(cut) == len(values):
            repeated = (np.diff(cut) == 0) & (np.diff(values) == 0)
            kept = np.flatnonzero(np.concatenate([[True], ~repeated]))
            if len(kept) < len(cut):
                self.finding(f"{len(cut) - len(kept)} repeated entries dropped")
        return cut, kept


def _number(value: Any) -> float | None:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if math.isfinite(number) else None


def _shown(value: Any) -> str:
    """Show a value of any size in a few words."""
    if isinstance(value, dict):
        return f"a mapping of {len(value)}"
    if isinstance(value, list):
        return f"a list of {len(value)}"
    text = repr(value)
    return text if len(text) <= 40 else text[:37] + "..."
