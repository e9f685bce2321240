"""Where text files carry what they are made from: a comment of their own, or a title's end.

Each function takes a file's bytes to bytes that hold the line; one that an earlier run left is
replaced.  No line is lost, and where tools count the lines of a file none is added.
"""

import codecs
import re
from collections.abc import Callable

from bladegen.exports.provenance import Provenance

__all__ = ["Put", "commented", "named_columns", "titled"]

Put = Callable[[bytes, Provenance], bytes]

NEAR = 8192  # bytes; the line stands in a file's first ones
LINES = 8  # of them a title is one
_LINE = rb"bladegen [^;\s]+; blade=[^\r\n]*?; id=[0-9a-f]{8}"
_OLD = re.compile(rb"^[ \t]*[#;!][ \t]*" + _LINE + rb"[ \t]*\r?\n|; " + _LINE, re.MULTILINE)
_OURS = re.compile(rb"\d+ (radius \[m\]|sets of profile)|Columns of ElastoDyn")


def commented(mark: str) -> Put:
    """Return what puts the line first, as a comment that begins with a mark."""

    def put(content: bytes, made: Provenance) -> bytes:
        start, content = _fresh(content)
        return start + f"{mark} {made.text}".encode() + _end(content) + content

    return put


def named_columns(content: bytes, made: Provenance) -> bytes:
    """Behind the row of names, which readers of tables take from the first line.

    First in a table that begins with comments of its own.
    """
    if content.startswith(b"#"):
        return commented("#")(content, made)
    names, end, rows = content.partition(b"\n")
    return names + end + f"# {made.text}\n".encode() + rows


def titled(content: bytes, made: Provenance) -> bytes:
    """At the end of a title or remark of files of AeroDyn, ElastoDyn and HAWC2.

    Files of coordinates alone stay as they are: their title is the airfoil's name.
    """
    start, content = _fresh(content)
    lines = content.split(b"\n", LINES)
    place = _title(lines[:LINES])
    if place is None or place >= len(lines) - 1:
        return start + content
    line = lines[place].rstrip()
    lines[place] = line + b"; " * bool(line) + made.text.encode() + _end(content)[:-1]
    return start + b"\n".join(lines)


def _title(lines: list[bytes]) -> int | None:
    """Return which line is a title that says nothing to any program."""
    if lines[0].startswith(b"---"):
        return 1  # of OpenFAST's input files, the second is free
    if _OURS.match(lines[0]):
        return 0
    for k, line in enumerate(lines):
        if line.startswith(b"!") and not re.match(rb"!\s*(airfoil:|-)", line):
            return k
    return None


def _fresh(content: bytes) -> tuple[bytes, bytes]:
    """Return a file's byte order mark, if it has one, and the rest without an earlier line."""
    start = codecs.BOM_UTF8 if content.startswith(codecs.BOM_UTF8) else b""
    rest = content[len(start) :]
    return start, _OLD.sub(b"", rest[:NEAR], count=1) + rest[NEAR:]


def _end(content: bytes) -> bytes:
    """Return how the lines of a file end."""
    return b"\r\n" if content.partition(b"\n")[0].endswith(b"\r") else b"\n"
