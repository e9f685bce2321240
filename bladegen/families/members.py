"""What a family gives as a sequence: a blade at a place, and a table of all.

These functions are methods of `Family`: no sections are made for a table.
"""

import operator
from typing import TYPE_CHECKING, Any, SupportsIndex, overload

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.errors import FamilyError
from bladegen.support.arguments import shown
from bladegen.support.services import shown_by

if TYPE_CHECKING:
    import pyarrow

__all__ = ["html", "member", "table"]

ROWS = 64  # variants tested at once


@overload
def member(family: Any, place: SupportsIndex) -> Blade: ...


@overload
def member(family: Any, place: slice) -> list[Blade]: ...


def member(family: Any, place: SupportsIndex | slice) -> Blade | list[Blade]:
    """Return the blade that iterating gives at a place, from the end if negative, or a list.

    Raises
    ------
    PlaceError
        If there is none; it is a `FamilyError` and an `IndexError`.
    """
    if isinstance(place, slice):
        return [family.variant(one) for one in range(*place.indices(len(family)))]
    try:
        asked = operator.index(place)
    except TypeError:
        raise FamilyError(f"variant: got {shown(place)}, must be a whole number") from None
    found: Blade = family.variant(asked + len(family) if -len(family) <= asked < 0 else asked)
    return found


def table(family: Any) -> "pyarrow.Table":
    """Return what each variant is, a row a variant, as a `pyarrow.Table`.

    Columns: ``index``, ``name``, ``valid``, ``reason`` (what is wrong, "" if nothing is),
    ``attempts`` (draws), and the factors by name: shape coordinates and ``twist`` in radians,
    others without unit.  ``table().to_pandas()`` is a DataFrame where pandas is installed.
    """
    import pyarrow as pa

    places = np.arange(len(family))
    rows = [family.settled(places[i : i + ROWS]) for i in range(0, len(family), ROWS)]
    values, attempts = (np.concatenate([row[k] for row in rows]) for k in (0, 1))
    reasons = [reason for row in rows for reason in row[2]]
    columns: dict[str, Any] = {
        "index": places,
        "name": [family.name(place) for place in range(len(family))],
        "valid": [not reason for reason in reasons],
        "reason": reasons,
        "attempts": attempts,
    }
    return pa.table(columns | dict(zip(family.design.what.names, values.T, strict=True)))


html = shown_by("family_html")
