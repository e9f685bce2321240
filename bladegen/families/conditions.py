"""Conditions on the variants of a family, as people write them: t1 < 0.1 and volume > 600.

A condition is ``NAME OP NUMBER``; several are joined by ``and``.  ``chord@0.7`` is what an
array over span has at 70 % of it.  Nothing is evaluated but that.
"""

import operator
import re
from collections.abc import Callable, Collection
from typing import Any

import numpy as np

from bladegen.errors import FamilyError
from bladegen.support.arguments import shown, suggestion
from bladegen.support.arrays import Array, Mask

__all__ = ["at_spans", "called", "factor_numbers", "matching", "named", "numbers", "placed"]

CHANGES = ("thickness", "camber", "chord", "twist")
OPERATORS: dict[str, Callable[[Any, Any], Any]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}
CONDITION = re.compile(r"\s*([A-Za-z_][A-Za-z0-9_]*(?:@[0-9.]+)?)\s*(<=|>=|==|!=|<|>)\s*(\S+)\s*")
AND = re.compile(r"\s+and\s+|\s*&&?\s*|\s*,\s*")


def called(factor: str) -> str:
    """Return the name that conditions and datasets have for a factor of a design."""
    return f"{factor}_change" if factor in CHANGES else factor


def factor_numbers(names: tuple[str, ...], values: Array) -> dict[str, Array]:
    """Return values (b, d) of factors, as datasets have them: twist in degrees; by their names."""
    columns = dict(zip(names, values.T, strict=True))
    return {called(k): np.degrees(v) if k == "twist" else v for k, v in columns.items()}


def numbers(table: Any, columns: dict[str, str]) -> dict[str, Array]:
    """Return the columns (by the names of their arrays) of a manifest that hold a number a row."""
    import pyarrow as pa

    found = {}
    for name, column in columns.items():
        kind = table.schema.field(column).type
        if pa.types.is_boolean(kind) or pa.types.is_integer(kind) or pa.types.is_floating(kind):
            values = table.column(column).combine_chunks().to_numpy(zero_copy_only=False)
            found[name] = np.asarray(values, dtype=np.float64)
    return found


def at_spans(
    eta: Array, names: tuple[str, ...], values: Callable[[str, slice], Array]
) -> dict[str, Array]:
    """Return what arrays over span hold at a place, by names like "chord@0.7".

    Between two sections they are taken to be straight.

    Parameters
    ----------
    eta : (k,) array
        Span fractions of the sections.
    names : tuple of str
        Names with a place, as `placed` finds them right.
    values : callable
        Gives the columns (variants, 2) of an array, by its name and a slice of the sections.
    """
    found = {}
    for name in names:
        array, _, place = name.partition("@")
        where = float(place)
        after = int(np.clip(np.searchsorted(eta, where), 1, len(eta) - 1))
        share = (where - eta[after - 1]) / (eta[after] - eta[after - 1])
        found[name] = values(array, slice(after - 1, after + 1)) @ np.array([1.0 - share, share])
    return found


def placed(eta: Array, names: tuple[str, ...], spanwise: Collection[str]) -> tuple[str, ...]:
    """Return those of some names that are of arrays over span.

    Raises
    ------
    FamilyError
        If one is that of an array over span without a place, or the place is beyond the blade.
    """
    found = tuple(name for name in names if name.partition("@")[0] in spanwise)
    for name in found:
        array, at, place = name.partition("@")
        where = _number(place) if at else None
        if where is None or not eta[0] <= where <= eta[-1]:
            raise FamilyError(
                f"where: {name!r} has to say where on the span, {eta[0]:g} to {eta[-1]:g}, such as "
                f"'{array}@0.7'"
            )
    return found


def matching(values: dict[str, Array], text: str) -> Mask:
    """Return which variants fulfil all conditions of a text, (variants,).

    Parameters
    ----------
    values : dict of (variants,) arrays
        What conditions may name.
    text : str
        Such as ``thickness_change < 1.02 and volume > 600``.

    Raises
    ------
    FamilyError
        If it is no condition, or names something else.
    """
    held: Mask | None = None
    for name, compared, number in _parsed(text):
        if name not in values:
            raise FamilyError(
                f"where: there is no {name!r} of a variant, but {', '.join(values)}"
                f"{suggestion(name, values)}"
            )
        fulfilled = np.asarray(OPERATORS[compared](values[name], number), dtype=bool)
        held = fulfilled if held is None else held & fulfilled
    return np.asarray(held)


def named(text: str) -> tuple[str, ...]:
    """Return the names in conditions.

    Raises
    ------
    FamilyError
        If it is no condition.
    """
    return tuple(name for name, _, _ in _parsed(text))


def _parsed(text: str) -> list[tuple[str, str, float]]:
    """Return names, operators and numbers of conditions."""
    if not isinstance(text, str):
        raise FamilyError(f"where: got {shown(text)}, must be a text, such as 'volume > 600'")
    found = []
    for part in AND.split(text.strip()):
        match = CONDITION.fullmatch(part)
        number = None if match is None else _number(match[3])
        if match is None or number is None:
            raise FamilyError(
                f"where: got {part!r}, must be NAME, one of {' '.join(OPERATORS)}, and a number, "
                "such as 'volume > 600 and valid == true'"
            )
        found.append((match[1], match[2], number))
    return found


def _number(word: str) -> float | None:
    if word.lower() in ("true", "false"):
        return float(word.lower() == "true")
    try:
        return float(word)
    except ValueError:
        return None
