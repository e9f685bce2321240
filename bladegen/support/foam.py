"""OpenFOAM dictionaries as text: entries that a person would write and can read again.

A dictionary is a dict: a dict in it is a block, a tuple a list on one line, a list a list with a
line for each of its members, text stands as it is.  Reference: OpenFOAM's user guide, "Basic
input/output file format".
"""

from collections.abc import Mapping, Sequence
from typing import Any

__all__ = ["Entries", "dictionary", "entries", "number", "vector"]

Entries = Mapping[str, Any]
INDENT = "    "
COLUMN = 24  # at which the values of a block begin
DIGITS = 9  # of numbers


def dictionary(
    name: str, values: Entries | Sequence[str], *, kind: str = "dictionary", note: str = ""
) -> str:
    """Return a whole file: its header, a line that says what it is, and its entries.

    Parameters
    ----------
    name : str
        The object's name, that of the file.
    values : mapping, or sequence of str
        The entries; lines stand as they are.
    kind : str
        The class in the header, such as "volVectorField".
    note : str
        A comment, a line or several.
    """
    head = {"version": "2.0", "format": "ascii", "class": kind, "object": name}
    lines = [*entries({"FoamFile": head}), *(f"// {line}" for line in note.splitlines()), ""]
    lines += entries(values) if isinstance(values, Mapping) else values
    return "\n".join([*lines, ""])


def entries(values: Entries, depth: int = 0) -> list[str]:
    """Return the lines of entries, indented by a depth.

    >>> entries({"solver": "GAMG", "relTol": 0.1, "inner": {"axis": (0.0, 0.0, 1.0)}})[0]
    'solver                  GAMG;'
    """
    lines = []
    pad = INDENT * depth
    for key, value in values.items():
        if isinstance(value, Mapping):
            lines += [f"{pad}{key}", f"{pad}{{", *entries(value, depth + 1), f"{pad}}}"]
        elif isinstance(value, list):
            rows = [f"{pad}{INDENT}{_shown(row)}" for row in value]
            lines += [f"{pad}{key}", f"{pad}(", *rows, f"{pad});"]
        elif key.startswith("#"):
            lines.append(f"{pad}{key} {value}")
        else:
            lines.append(f"{pad}{key:<{COLUMN - 1}} {_shown(value)};")
    return lines


def number(value: float) -> str:
    """Return a number with as many digits as a mesher can use.

    >>> number(0.1), number(-0.0), number(12)
    ('0.1', '0', '12')
    """
    return f"{value + 0.0:.{DIGITS}g}"


def vector(values: Sequence[float]) -> str:
    """Return numbers in brackets.

    >>> vector((1.0, 0.5, -0.0))
    '(1 0.5 0)'
    """
    return _shown(tuple(values))


def _shown(value: Any) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, tuple):
        return f"({' '.join(map(_shown, value))})"
    return number(value)
