"""Linear algebra in one thread, for what is small: more threads wait for each other.

On cores that others use as well, two threads of OpenBLAS took fifty times as long as one for the
covariance of 2,000 shapes, and on free ones hardly less.  Sums also depend in their last digit on
how many threads add them up.
"""

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import Any

__all__ = ["one_thread"]

_LOCK = threading.Lock()
_HELD: list[Any] = []  # how to give the threads back, and who still needs one only


@contextmanager
def one_thread() -> Iterator[None]:
    """Keep BLAS to one thread, until all who asked for it have left.

    Who holds it holds it for all threads of the program; OpenBLAS lets its main thread change it
    only, so hold it there around others.
    """
    with _LOCK:
        if not _HELD:
            _HELD.append(
                _controller("scipy.linalg" in sys.modules).limit(limits=1, user_api="blas")
            )
        _HELD.append(None)
    try:
        yield
    finally:
        with _LOCK:
            _HELD.pop()
            if len(_HELD) == 1:
                _HELD.pop().restore_original_limits()


@lru_cache(2)
def _controller(_: bool) -> Any:
    """Return what controls the libraries, which takes milliseconds to find them."""
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()
