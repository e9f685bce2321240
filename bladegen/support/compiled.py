"""Functions compiled by Numba, which is loaded with the first of them: so import them late.

Numba compiles a function when it is first called and keeps the result on the disk, in the
package's folder or the user's cache.  What it keeps it makes anew when the file of the function
that was called has another text, but not when a constant or a function from elsewhere has: who
changes `sizes`, `section_measures` or a tolerance that they share, writes the release's next
`REVISION` in `kernels`.

Arithmetic is strict: were sums free to be taken in another order, two processes that compile for
themselves could differ in the last digit, and families with them.

Where Numba is not installed (locks/core.txt) the same functions run as they are: the same numbers,
some hundred times as slowly.
"""

import warnings
from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

__all__ = ["NUMBA", "ONE", "ZERO", "announced", "compiled", "is_kept"]

# to pass on: for a plain 1 a function is compiled once more
ZERO: Any = np.int64(0)
ONE: Any = np.int64(1)
NUMBA = find_spec("numba") is not None


def compiled(function: Callable[..., Any]) -> Any:
    """Compile a function, to run without the interpreter's lock; keep the result if possible."""
    if not NUMBA:
        return function
    from numba import njit

    options: dict[str, Any] = {"nogil": True, "error_model": "numpy"}
    try:
        return njit(cache=True, **options)(function)
    except RuntimeError:  # neither the package's folder nor the user's can be written
        return njit(**options)(function)


def is_kept(function: Any) -> bool:
    """Tell whether a function need not be compiled now: it is plain, or it lies on the disk."""
    if not hasattr(function, "py_func"):
        return True
    place = getattr(function.stats, "cache_path", None)
    name = f"{function.py_func.__module__.rpartition('.')[2]}.{function.py_func.__qualname__}-"
    return place is not None and any(Path(place).glob(f"{name}*.nbi"))


@cache
def announced(function: Any) -> None:
    """Warn once that a function and what it calls are going to be compiled, if they are."""
    if not is_kept(function):
        warnings.warn(
            "bladegen compiles its loops, once on this machine: up to 40 s on a busy one",
            stacklevel=4,
        )
