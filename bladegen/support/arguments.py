"""Arguments as people write them in Python: of their kind, or one line says what they must be.

Each function takes a value, the name that the user knows it by, and the error to raise; it gives
the value back as the kind that is wanted.  A slip then ends where it was made, and not as an
`AttributeError` from the depth.
"""

from collections.abc import Callable, Iterable
from difflib import get_close_matches
from numbers import Integral, Real
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.errors import BladegenError
from bladegen.support.arrays import Array

__all__ = [
    "alike",
    "amount",
    "function",
    "generator",
    "instance",
    "numbers",
    "one_of",
    "path_of",
    "require_within",
    "shown",
    "suggestion",
    "whole",
]

LONGEST = 60  # characters of a value that are shown
ALIKE = 0.6  # of a name and another that may be meant, as `difflib` counts


def shown(value: object) -> str:
    """Return a value as a message shows it: short, or by its kind.

    >>> shown("iea15mw"), shown([1, 2]), shown(np.zeros((3, 2))), shown(print)
    ("'iea15mw'", '[1, 2]', 'an array of shape (3, 2)', 'the function print')
    """
    if isinstance(value, np.ndarray) and value.ndim:
        return f"an array of shape {value.shape}"
    if isinstance(value, type):
        return f"the class {value.__name__}"
    if callable(value) and hasattr(value, "__name__"):
        return f"the function {value.__name__}"
    if value is None or isinstance(value, str | bytes | Real | list | tuple | dict | set):
        text = " ".join(repr(value).split())
        return text if len(text) <= LONGEST else f"{text[:LONGEST]}..."
    name = type(value).__name__
    return f"{'an' if name[0] in 'AEIOUaeiou' else 'a'} {name}"


def instance(
    value: object,
    kinds: type | tuple[type, ...],
    field: str,
    must: str,
    error: type[BladegenError],
) -> None:
    """See that a value is of a kind, or say what it must be and how one is had."""
    if not isinstance(value, kinds):
        raise error(f"{field}: got {shown(value)}, must be {must}")


def function(value: Any, field: str, must: str, error: type[BladegenError]) -> Any:
    """Return a value that can be called, or say what it must be."""
    if not callable(value) or isinstance(value, type):
        raise error(f"{field}: got {shown(value)}, must be {must}")
    return value


def generator(value: object, field: str, error: type[BladegenError]) -> "np.random.Generator":
    """Return a generator of random numbers, or one of a seed; None takes a new one each time."""
    seed = isinstance(value, Integral) and not isinstance(value, bool) and int(value) >= 0
    if value is None or seed or isinstance(value, np.random.Generator):
        return np.random.default_rng(value)  # type: ignore[arg-type]
    raise error(
        f"{field}: got {shown(value)}, must be a numpy.random.Generator, or a seed such as 7"
    )


def amount(value: object, field: str, error: type[BladegenError]) -> float:
    """Return a number that is finite."""
    single = value.item() if isinstance(value, np.ndarray) and value.size == 1 else value
    if not isinstance(single, Real) or isinstance(single, bool | np.bool):
        raise error(f"{field}: got {shown(value)}, must be a number")
    if not np.isfinite(float(single)):
        raise error(f"{field}: got {float(single):g}, must be finite")
    return float(single)


def require_within(
    value: float,
    field: str,
    allowed: tuple[float, float],
    error: type[BladegenError],
    unit: str = "",
) -> None:
    """See that a value lies in a closed range; NaN does not."""
    low, high = allowed
    if not low <= value <= high:
        raise error(f"{field}: got {value:g}, allowed is {low:g} to {high:g}{unit}")


def whole(value: object, field: str, error: type[BladegenError]) -> int:
    """Return a whole number; NumPy's are taken, and 401.0 is."""
    if isinstance(value, Integral) and not isinstance(value, bool):
        return int(value)
    if isinstance(value, Real) and not isinstance(value, bool) and float(value).is_integer():
        return int(float(value))
    raise error(f"{field}: got {shown(value)}, must be a whole number")


def numbers(values: Any, field: str, error: type[BladegenError], form: str = "numbers") -> Array:
    """Return numbers of any shape as an array in double precision, not copied without need."""
    try:
        array = np.asarray(values)
        if array.dtype.kind in "iuf":
            return np.asarray(array, dtype=np.float64)
        if array.dtype.kind == "c":
            form = "real numbers; complex steps are not taken"
    except (TypeError, ValueError):  # a ragged list, or what is no list
        pass
    raise error(f"{field}: got {shown(values)}, must be {form}")


def path_of(value: object, field: str, error: type[BladegenError]) -> Path:
    """Return a path that was given as one, or as a text that can be one."""
    if not isinstance(value, str | Path) or not str(value) or "\0" in str(value):
        raise error(f"{field}: got {shown(value)}, must be a path, such as 'blade.step'")
    return Path(value)


def one_of(value: object, known: Iterable[str], field: str, error: type[BladegenError]) -> str:
    """Return a word that is known, or name those that are, and the one that may be meant."""
    words = list(known)
    if isinstance(value, str) and value in words:
        return value
    raise error(
        f"{field}: got {shown(value)}, allowed are {', '.join(words)}{suggestion(value, words)}"
    )


def suggestion(word: object, known: Iterable[str], wrapped: Callable[[str], str] = str) -> str:
    """Return which known word may be meant by another one, to end a message with; "" if none.

    >>> suggestion("IEA15MW", ["iea15mw", "nrel5mw"])
    '; did you mean iea15mw?'
    """
    near = alike(str(word), known)
    return "" if near is None else f"; did you mean {wrapped(near)}?"


def alike(word: str, known: Iterable[str]) -> str | None:
    """Return the known word that is most like another one; None if none is."""
    plain = {_plain(name): name for name in known}
    near = get_close_matches(_plain(word), plain, 1, ALIKE)
    return plain[near[0]] if near else None


def _plain(name: str) -> str:
    """Return a name without what people write otherwise: case, and signs between words."""
    return "".join(letter for letter in name.casefold() if letter.isalnum()) or name
