"""Files that are whole or not there: written under a temporary name, then renamed."""

import os
import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from bladegen.errors import ExportError

__all__ = ["folder", "replacing", "safe_stem"]


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a temporary path beside `path`, with its suffix, and rename it when all went well.

    Nothing is left behind by a failure.

    Raises
    ------
    ExportError
        If the folder is missing or cannot be written, or the disk is full.
    """
    try:
        handle, name = tempfile.mkstemp(
            prefix=f".{path.stem}.", suffix=path.suffix, dir=path.parent
        )
        os.close(handle)
    except OSError as error:
        raise ExportError(f"{path}: cannot be written: {error.strerror}") from None
    temporary = Path(name)
    try:
        yield temporary
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(path)
    except OSError as error:
        raise ExportError(f"{path}: cannot be written: {error.strerror or error}") from None
    finally:
        temporary.unlink(missing_ok=True)


def folder(path: Path) -> Path:
    """Make a folder, with its parents, if it is not there.

    Raises
    ------
    ExportError
        If it cannot be made, or a file of that name stands in the way.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ExportError(f"{path}: cannot be made a folder: {error.strerror}") from None
    return path


def safe_stem(name: str) -> str:
    """Return a name as a file name's stem: letters, digits, dot, dash and underscore only.

    >>> safe_stem("../../IEA 15 MW")
    'IEA_15_MW'
    """
    plain = re.sub(r"[^A-Za-z0-9._-]+", "_", name).strip("._-")
    return plain[:80] or "blade"


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
