"""Values that are made of values: what they are pickled by, and their parts under one name.

A frozen dataclass keeps what it has computed in its `__dict__` (`functools.cached_property`); none
of that belongs into a pickle, which other processes read.
"""

from dataclasses import fields
from operator import attrgetter
from typing import Any, Generic, TypeVar, overload

__all__ = ["Part", "state_of"]

T_co = TypeVar("T_co", covariant=True)


def state_of(value: Any) -> dict[str, Any]:
    """Return the fields of a dataclass without what it has computed, as its `__getstate__`."""
    return {entry.name: getattr(value, entry.name) for entry in fields(value)}


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
