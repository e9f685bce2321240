"""Folders and object stores as places of a family's files: ``s3://bucket/family`` and the like.

A place is a `pathlib.Path` of this machine, or a `upath.UPath` of a store that fsspec knows; both
are joined, looked up and read in the same way.  What differs is here: an object is written whole by
one request, so it needs no temporary name; a store has no locks, no disk that can be full, and
folders only as parts of names.
"""

import os
import re
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import Any

from bladegen.errors import BladegenError, ExportError, FamilyError, FileError
from bladegen.support import files
from bladegen.support.files import content_of

__all__ = [
    "alone",
    "bytes_in",
    "content",
    "copied",
    "filled",
    "flush",
    "folder",
    "group",
    "in_store",
    "located",
    "removed",
    "replacing",
    "told",
]

URL = re.compile(r"([a-z][a-z0-9+.-]+)://", re.IGNORECASE)
LIBRARIES = {"s3": "s3fs", "s3a": "s3fs", "gs": "gcsfs", "gcs": "gcsfs"}
RAISING = ("botocore", "aiobotocore", "s3fs", "gcsfs", "google", "aiohttp", "fsspec")
HINTS = {  # what to type, by the words that libraries say
    "credentials": "set AWS_PROFILE, or AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY; of gs:// run "
    "`gcloud auth application-default login`",
    "bucket does not exist": "make the bucket first (aws s3 mb, gcloud storage buckets create)",
    "connect": "AWS_ENDPOINT_URL names a server of your own, STORAGE_EMULATOR_HOST one of gs://",
}


def in_store(path: Any) -> bool:
    """Tell whether a place is in an object store; of a text, whether it says so."""
    return not isinstance(path, Path) and bool(URL.match(str(path)))


def located(target: str | Path) -> Path:
    """Return the place that a text means.

    Raises
    ------
    FamilyError
        If it is in a store of which the library is missing, or that is not known.
    """
    if not in_store(target):
        return Path(target)
    if not isinstance(target, str):
        return target
    kind = target.partition(":")[0].lower()
    try:
        from upath import UPath

        # listings are remembered by one process, and others write into the same family
        found: Any = UPath(target.rstrip("/"), **({"use_listings_cache": False}))
        _ = found.fs
    except ImportError:
        needed = LIBRARIES.get(kind, f"fsspec's library for {kind}://")
        raise FamilyError(
            f"{target}: object stores need universal_pathlib and {needed}; "
            "pip install 'bladegen[stores]' adds them for s3:// and gs://"
        ) from None
    except ValueError:
        raise FamilyError(
            f"{target}: {kind}:// is no store that fsspec knows; s3://BUCKET/FOLDER and "
            "gs://BUCKET/FOLDER are, and folders of this machine"
        ) from None
    return found  # type: ignore[no-any-return]


@contextmanager
def told(path: Any) -> Iterator[None]:
    """Say in one line what an object store, or the way to it, has failed in.

    Raises
    ------
    ExportError
        Instead of the many kinds of errors that libraries of stores raise.
    """
    try:
        yield
    except BladegenError:
        raise
    except Exception as error:
        home = type(error).__module__.partition(".")[0]
        if not in_store(path) or not (isinstance(error, OSError) or home in RAISING):
            raise
        said = " ".join(str(error).split()) or type(error).__name__
        if isinstance(error, FileNotFoundError):  # gcsfs names the address alone
            said = f"the bucket does not exist, or an object in it ({said})"
        hint = next((hint for words, hint in HINTS.items() if words in said), "")
        raise ExportError(f"{path}: the store says: {said}{hint and '; '}{hint}") from None


def folder(path: Path) -> Path:
    """Make a folder, with its parents, if it is not there; a store needs none."""
    return path if in_store(path) else files.folder(path)


def alone(path: Path, stem: str) -> AbstractContextManager[None]:
    """Hold the files of a stem against a second run, where the place has locks."""
    return nullcontext() if in_store(path) else files.alone(files.folder(path), stem)


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a temporary file of this machine that becomes `path` when all went well."""
    if not in_store(path):
        with files.replacing(path) as temporary:
            yield temporary
        return
    with tempfile.TemporaryDirectory() as room:
        temporary = Path(room) / path.name
        yield temporary
        _remote(path).fs.put_file(str(temporary), _remote(path).path)


@contextmanager
def copied(path: Path) -> Iterator[Path]:
    """Give a file of this machine with what `path` holds: itself, or a copy for the time."""
    if not in_store(path):
        yield path
        return
    with tempfile.TemporaryDirectory() as room:
        temporary = Path(room) / path.name
        _remote(path).fs.get_file(_remote(path).path, str(temporary))
        yield temporary


@contextmanager
def filled(path: Path) -> Iterator[Path]:
    """Give a folder of this machine whose files come to lie in `path` when all went well."""
    if not in_store(path):
        yield path
        return
    with tempfile.TemporaryDirectory() as room:
        yield Path(room)
        for file in sorted(one for one in Path(room).rglob("*") if one.is_file()):
            whole = _remote(path / file.relative_to(room).as_posix())
            whole.fs.put_file(str(file), whole.path)


def content(path: Path, most: int) -> bytes:
    """Return what a file holds, up to `most` bytes.

    Raises
    ------
    FileError
        If it holds more, or cannot be read.
    """
    if not in_store(path):
        return content_of(path, most)
    if _remote(path).stat().st_size > most:
        raise FileError(str(path), [f"is larger than {most} bytes, the most that is read"])
    return path.read_bytes()


def removed(path: Path) -> None:
    """Take away a folder with all that is in it, if it is there."""
    if not in_store(path):
        shutil.rmtree(path, ignore_errors=True)
    elif path.exists():
        _remote(path).fs.rm(_remote(path).path, recursive=True)


def bytes_in(path: Path) -> int:
    """Return how many bytes all files in a folder have."""
    if in_store(path):
        return int(_remote(path).fs.du(_remote(path).path))
    return sum(file.stat().st_size for file in path.rglob("*") if file.is_file())


def group(path: Path, mode: Any, **how: Any) -> Any:
    """Open a Zarr group."""
    import zarr

    if not in_store(path):
        return zarr.open_group(path, mode=mode, **how)
    from zarr.storage import FsspecStore

    store = FsspecStore.from_url(str(path), read_only=mode == "r")
    return zarr.open_group(store, mode=mode, **how)


def flush(path: Path) -> None:
    """See that a file, or all files below a folder, have reached the disk."""
    for file in [path] if path.is_file() else sorted(p for p in path.rglob("*") if p.is_file()):
        handle = os.open(file, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _remote(path: Any) -> Any:
    """Return a place as what it is, with the methods that `pathlib` does not know."""
    return path
