"""Tables of numbers as text: every digit of a double, aligned, files whole or not there."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from bladegen.files import replacing

__all__ = ["aligned", "exact", "one_line", "write_lines"]

WIDTH = 23  # of "-1.2345678901234567e-123"


def exact(value: float) -> str:
    """Return the shortest text that reads back as the same double."""
    return repr(float(value) + 0.0)  # -0.0 is written as 0.0


def aligned(values: Iterable[float | str]) -> str:
    """Return a row of a table whose columns are as wide as a double with all digits."""
    return " ".join(
        f"{value if isinstance(value, str) else format(value + 0.0, '.16e'):>{WIDTH}}"
        for value in values
    )


def one_line(text: str) -> str:
    """Return a text on one line of printable letters."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def write_lines(path: Path, lines: Sequence[str]) -> None:
    """Write lines to a file, through a temporary one beside it."""
    with replacing(path) as temporary:
        temporary.write_text("\n".join(lines) + "\n", encoding="utf-8")
