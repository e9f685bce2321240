"""Excel workbooks, opened safely: sheets as rows of cells.

A workbook is a zip of XML files: what it unpacks to is bounded before anything is unpacked, and
XML that declares entities is refused.  openpyxl is imported when first needed.
"""

import io
import struct
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any, BinaryIO

from bladegen.errors import FileError
from bladegen.formats.common.table import Cell, Rows
from bladegen.support.files import content_of

__all__ = ["SUFFIXES", "Sheets", "sheet_names", "sheets"]

SUFFIXES = (".xlsx",)
MAX_BYTES = 64 * 2**20  # unpacked; the tables of the IEA 15 MW unpack to 3 MB
MAX_PACKED = 64 * 2**20  # bytes of the file
MAX_MEMBERS = 2000
MAX_ROWS = 20_000
MAX_COLUMNS = 100
_DECLARATIONS = (b"<!DOCTYPE", b"<!ENTITY")

_DAMAGED = (  # what zipfile and zlib raise at bytes that are no archive
    ValueError,
    LookupError,
    EOFError,
    NotImplementedError,
    RuntimeError,
    OverflowError,
    OSError,  # a directory that points before its file
    struct.error,
    zipfile.BadZipFile,
    zlib.error,
)

Sheets = dict[str, Rows]


def sheet_names(path: Path) -> tuple[str, ...]:
    """Return the names of a workbook's sheets; none if it is no workbook that may be opened."""
    try:
        with _opened(path) as book:
            return tuple(book.sheetnames)
    except FileError:
        return ()


def sheets(path: Path, names: tuple[str, ...] | None = None) -> Sheets:
    """Return the rows, numbered from 1, of a workbook's sheets, or of those that are named.

    Raises
    ------
    FileError
        If it is no workbook, or larger than is read.
    """
    with _opened(path) as book:
        found: Sheets = {}
        for sheet in book.worksheets:
            if names is not None and sheet.title not in names:
                continue
            rows = sheet.iter_rows(max_row=MAX_ROWS, max_col=MAX_COLUMNS, values_only=True)
            found[sheet.title] = [(k + 1, tuple(map(_cell, row))) for k, row in enumerate(rows)]
        return found


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    """Open a workbook for reading values, once it is known to be harmless."""
    stream = io.BytesIO(content_of(path, MAX_PACKED))
    _require_harmless(path, stream)
    from openpyxl import load_workbook

    try:
        book = load_workbook(stream, read_only=True, data_only=True, keep_links=False)
        with closing(book):
            yield book
    except Exception as error:  # openpyxl parses late and lets through whatever its parsers raise
        said = " ".join(str(error).split())[:120] or type(error).__name__
        raise FileError(str(path), [f"is no workbook that can be read: {said}"]) from None


def _require_harmless(path: Path, packed: BinaryIO) -> None:
    """Refuse what would unpack to too much, or declares entities."""
    try:
        with zipfile.ZipFile(packed) as archive:
            members = archive.infolist()
            size = sum(member.file_size for member in members)
            if len(members) > MAX_MEMBERS or size > MAX_BYTES:
                raise FileError(
                    str(path),
                    [
                        f"unpacks to {len(members)} files of {size >> 20} MB, allowed are "
                        f"{MAX_MEMBERS} of {MAX_BYTES >> 20} MB"
                    ],
                )
            for member in members:
                if not member.filename.lower().endswith((".xml", ".rels", ".vml")):
                    continue
                with archive.open(member) as stream:  # never gives more than file_size
                    content = stream.read(MAX_BYTES)
                if any(word in content for word in _DECLARATIONS) or b"\0" in content[:4]:
                    raise FileError(
                        str(path), [f"{member.filename}: declares entities, which is not allowed"]
                    )
    except _DAMAGED as error:
        raise FileError(str(path), [f"is no workbook: {error}"]) from None


def _cell(value: object) -> Cell:
    """Return a cell as a number, a text or nothing."""
    if value is None or isinstance(value, str):
        return value
    if isinstance(value, int | float) and not isinstance(value, bool):
        return float(value)
    return str(value)
