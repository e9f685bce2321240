"""What frozen dataclasses that hold arrays share: equality, hash, short reprs, pickles.

Each function serves as a method: ``__eq__ = equal``, ``__hash__ = hashed``, ``__repr__ = brief``,
``__getstate__ = state_of``.  What a value has computed (`functools.cached_property`) counts in none
of them.
"""

from dataclasses import MISSING, fields, is_dataclass
from operator import attrgetter
from types import MethodType
from typing import Any, Generic, TypeVar, overload

import numpy as np

from bladegen.errors import visible

__all__ = ["Part", "brief", "equal", "hashed", "state_of"]

FEW = 4  # numbers that are shown one by one
LONGEST = 100  # characters of a part that are shown

T_co = TypeVar("T_co", covariant=True)


def state_of(value: Any) -> dict[str, Any]:
    """Return the fields of a dataclass without what it has computed, as its `__getstate__`."""
    return {entry.name: getattr(value, entry.name) for entry in fields(value)}


def equal(one: Any, other: Any) -> Any:
    """Tell whether a dataclass equals another value: the same class, all fields the same."""
    if type(one) is not type(other):
        return NotImplemented
    return one is other or all(
        _same(getattr(one, entry.name), getattr(other, entry.name)) for entry in fields(one)
    )


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return one is other or np.array_equal(one, other)
    if isinstance(one, tuple) and isinstance(other, tuple):
        return len(one) == len(other) and all(map(_same, one, other))
    if isinstance(one, MethodType) and isinstance(other, MethodType):
        return one.__func__ is other.__func__ and bool(one.__self__ == other.__self__)
    return bool(one == other)


def hashed(value: Any) -> int:
    """Return a hash of a dataclass by its fields: equal values have the same one."""
    return hash((type(value), *(_hash(getattr(value, entry.name)) for entry in fields(value))))


def _hash(value: Any) -> int:
    if isinstance(value, np.ndarray):
        return hash((value.shape, (value + 0.0).tobytes()))  # -0.0 equals 0.0
    if isinstance(value, tuple):
        return hash(tuple(map(_hash, value)))
    if isinstance(value, MethodType):
        return hash((value.__func__, value.__self__))
    return hash(value)


def brief(value: Any) -> str:
    """Return one short line that shows a dataclass: its fields that are not the defaults.

    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True, repr=False)
    ... class Wheel:
    ...     spokes: np.ndarray
    ...     rim: str = "steel"
    ...     __repr__ = brief
    >>> Wheel(np.zeros((32, 2)))
    Wheel(spokes=<32 x 2>)
    """
    shown = [
        f"{entry.name}={_word(getattr(value, entry.name))}"
        for entry in fields(value)
        if entry.repr and not _is_default(entry, getattr(value, entry.name))
    ]
    return f"{type(value).__name__}({', '.join(shown)})"


def _is_default(entry: Any, value: Any) -> bool:
    default = entry.default
    if entry.default_factory is not MISSING:
        default = entry.default_factory()
    return default is not MISSING and _same(value, default)


def _word(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return _numbers(value)
    if isinstance(value, tuple | list):
        return f"({', '.join(map(_word, value))})" if len(value) <= FEW else f"<{len(value)}>"
    if isinstance(value, float):
        return f"{value:g}"
    if callable(value) and not is_dataclass(value):
        return str(getattr(value, "__name__", type(value).__name__))
    text = " ".join(visible(repr(value)).split())
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


def _numbers(values: Any) -> str:
    if values.ndim == 1 and len(values) <= FEW:
        return f"[{', '.join(f'{one:g}' for one in values)}]"
    return f"<{' x '.join(map(str, values.shape))}>"


class Part(property, Generic[T_co]):
    """An attribute of a value that one of its parts holds.

    >>> class Wheel:
    ...     def __init__(self, size): self.size = size
    >>> class Cart:
    ...     size = Part[float]("wheel.size", "Of its wheel [m].")
    ...     def __init__(self, wheel): self.wheel = wheel
    >>> Cart(Wheel(0.5)).size
    0.5
    """

    def __init__(self, place: str, doc: str) -> None:
        super().__init__(attrgetter(place), doc=doc)

    @overload
    def __get__(self, value: None, owner: type | None = None) -> "Part[T_co]": ...

    @overload
    def __get__(self, value: Any, owner: type | None = None) -> T_co: ...

    def __get__(self, value: Any, owner: type | None = None) -> Any:
        return super().__get__(value, owner)
