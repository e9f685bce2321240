"""Files that are whole or not there: written under a temporary name, then renamed, and logged.

What is read is a regular file of bounded size; a pipe or a device has no end.
"""

import errno
import hashlib
import logging
import os
import re
import stat
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, BinaryIO

from bladegen.errors import ExportError, FileError
from bladegen.support.arguments import suggestion
from bladegen.support.stopping import held_back

__all__ = [
    "alone",
    "beginning_of",
    "beside",
    "content_of",
    "digest_of",
    "end_of",
    "folder",
    "replacing",
    "require_suffix",
    "safe_stem",
    "unwritable",
]

MANY = 1000  # entries of a folder among which one of a like name is looked for
RETRY = 0.2  # seconds in which a lock whose file was taken away is made anew

logger = logging.getLogger(__name__)


def beside(path: Path, suffixes: Sequence[str] = (), *, folders: bool = False) -> str:
    """Return which entry beside a path that is none may be meant, to end a message with.

    Files of some suffixes, lower case, or folders; "" if none has a like name.
    """
    try:
        found = sorted(path.parent.iterdir())[:MANY]
        meant = [e for e in found if (e.is_dir() if folders else e.suffix.lower() in suffixes)]
    except (OSError, ValueError):  # no folder, or a name that none can have
        return ""
    return suggestion(path.name, [e.name for e in meant], lambda name: str(path.with_name(name)))


def unwritable(path: Path, error: OSError) -> ExportError:
    """Return what to raise if a file cannot be written: a folder that is missing is named."""
    said = f"cannot be written: {error.strerror or error}"
    if isinstance(error, FileNotFoundError) and not path.parent.exists():
        said = f"cannot be written: there is no folder {path.parent}; mkdir -p {path.parent}"
    return ExportError(f"{path}: {said}")


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
        raise unwritable(path, error) from None
    temporary = Path(name)
    try:
        yield temporary
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(path)
        logger.info("wrote %s, %d bytes", path, path.stat().st_size)
    except OSError as error:
        raise unwritable(path, error) from None
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def alone(path: Path, stem: str) -> Iterator[None]:
    """Hold the files of a stem in a folder, so that no second run writes the same ones.

    What is held is a hidden file that is gone afterwards; that of a killed run is in nobody's way.

    Raises
    ------
    ExportError
        If another run holds them, or the folder cannot be written.
    """
    from filelock import FileLock, Timeout

    file = path / f".{stem}.lock"
    lock = FileLock(file, timeout=RETRY, poll_interval=0.1 * RETRY)
    ours = False
    try:
        with held_back():  # or a file would stay that was made and not yet known to be held
            try:
                lock.acquire()
            except Timeout:
                raise ExportError(f"{path}: another run is writing {stem} there") from None
            except OSError as error:
                if error.errno != errno.ENOLCK:  # a file system without locks
                    raise unwritable(path, error) from None
            ours = True
        yield
    finally:
        if ours:
            _given_up(file, lock)


def _given_up(file: Path, lock: Any) -> None:
    """Give a lock up, and take its file away."""
    if os.name == "posix":  # while it is held, so that it is nobody else's
        file.unlink(missing_ok=True)
        lock.release()
    else:  # Windows takes away no file that is open
        lock.release()
        with suppress(OSError):
            file.unlink(missing_ok=True)


@contextmanager
def _regular(path: Path) -> Iterator[BinaryIO]:
    """Open a regular file for reading; anything else would have no end, or hold up its reader.

    Raises
    ------
    FileError
        If it is a folder, a pipe or a device, or cannot be read.
    """
    try:
        # a pipe without a writer would hold up whoever opens it plainly
        handle = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
        try:
            if not stat.S_ISREG(os.fstat(handle).st_mode):
                raise FileError(str(path), ["is no regular file"])
            with os.fdopen(handle, "rb", closefd=False) as stream:
                yield stream
        finally:
            os.close(handle)
    except OSError as error:
        raise FileError(str(path), [f"cannot be read: {error.strerror or error}"]) from None


def content_of(path: Path, most: int) -> bytes:
    """Return what a regular file holds, up to `most` bytes.

    Raises
    ------
    FileError
        If it is no regular file, holds more, or cannot be read.
    """
    with _regular(path) as stream:
        content = stream.read(most + 1)
    if len(content) > most:
        size = f"{most >> 20} MB" if most >= 2**20 else f"{most} bytes"
        raise FileError(str(path), [f"is larger than {size}, the most that is read"])
    return content


def beginning_of(path: Path, count: int) -> bytes:
    """Return the first `count` bytes of a regular file; none if it is no such file."""
    try:
        with _regular(path) as stream:
            return stream.read(count)
    except FileError:
        return b""


def end_of(path: Path, count: int) -> bytes:
    """Return the last `count` bytes of a regular file; none if it is no such file."""
    try:
        with _regular(path) as stream:
            stream.seek(-min(count, stream.seek(0, os.SEEK_END)), os.SEEK_END)
            return stream.read()
    except FileError:
        return b""


def digest_of(path: Path) -> str:
    """Return the SHA-256 of a file as hex digits."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def require_suffix(path: Path, allowed: Sequence[str], field: str = "output") -> None:
    """See that a file that is to be written says by its suffix what it will hold.

    Raises
    ------
    ExportError
        If its suffix is none of the allowed ones (lower case, with their dots).
    """
    if path.suffix.lower() not in allowed:
        raise ExportError(
            f"{field}: got {path}, suffix {path.suffix!r}, allowed are {', '.join(allowed)}; "
            f"such as {path.with_suffix(allowed[0]).name}"
        )


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
