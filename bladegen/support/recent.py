"""The last few results of a function of bytes, kept by a value for as long as it lives."""

from collections.abc import Callable
from threading import Lock
from typing import Generic, TypeVar

__all__ = ["Recent"]

T = TypeVar("T")


class Recent(Generic[T]):
    """A memory of so many results; what was asked for longest ago is forgotten first.

    >>> squares = Recent(1)
    >>> squares.get(b"3", lambda: 9), squares.get(b"3", lambda: 0), squares.get(b"4", lambda: 16)
    (9, 9, 16)
    >>> squares.get(b"3", lambda: 0)
    0
    """

    def __init__(self, count: int) -> None:
        self._count = count
        self._known: dict[bytes, T] = {}
        self._lock = Lock()

    def get(self, key: bytes, make: Callable[[], T]) -> T:
        """Return what is known by a key, or make it."""
        with self._lock:
            known = self._known.get(key)
        value = make() if known is None else known
        with self._lock:
            self._known.pop(key, None)
            self._known[key] = value
            while len(self._known) > self._count:
                del self._known[next(iter(self._known))]
        return value
