"""Tables of numbers as text: every digit of a double, aligned, files whole or not there."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from bladegen.support.files import replacing

__all__ = ["aligned", "exact", "few", "line_end", "one_line", "write_lines"]

LONGEST = 1 << 20  # bytes of a line that are looked at
SHOWN = 4  # names that a message holds
WIDTH = 23  # of "-1.2345678901234567e-123"


def exact(value: float) -> str:
    """Return the shortest text that reads back as the same double."""
    return repr(float(value) + 0.0)  # -0.0 is written as 0.0


def aligned(values: Iterable[float | str]) -> str:
    """Return a row of a table whose columns are as wide as a double with all digits."""
    return " ".join(
        [
            value.rjust(WIDTH) if isinstance(value, str) else f"{value + 0.0:{WIDTH}.16e}"
            for value in values
        ]
    )


def one_line(text: str) -> str:
    """Return a text on one line of printable letters."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def few(names: Sequence[str]) -> str:
    """Return the first names of a list, and whether there are more."""
    return ", ".join(names[:SHOWN]) + (" and more" if len(names) > SHOWN else "")


def line_end(path: Path) -> str:
    """Return how the lines of a file end: as its first one does."""
    with path.open("rb") as stream:
        return "\r\n" if stream.readline(LONGEST).endswith(b"\r\n") else "\n"


def write_lines(path: Path, lines: Sequence[str], end: str = "\n") -> None:
    """Write lines to a file, through a temporary one beside it.

    Bytes that `read_lines` kept by "surrogateescape" are written as they were.
    """
    with replacing(path) as temporary:
        text = "".join(f"{line}{end}" for line in lines)
        temporary.write_bytes(text.encode("utf-8", errors="surrogateescape"))
