"""Zip archives: npz files of arrays with a format version and a checksum, and members changed.

Nothing in such a file is executed: plain arrays and text only.
"""

import hashlib
import io
import struct
import tokenize
import zipfile
import zlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.errors import FileError, SpaceError
from bladegen.support.arrays import Array
from bladegen.support.files import content_of, replacing

__all__ = ["checksum", "load_arrays", "members", "rewritten", "save_arrays"]

VERSION = 2  # 1: each side was divided by arc length for itself
MAX_BYTES = 200 * 2**20  # of the file, and of what it unpacks to
LABELS = ("version", "about", "checksum")
DAMAGED = (  # what zipfile, zlib and numpy raise at bytes that are no archive of arrays
    ValueError,
    LookupError,
    EOFError,
    NotImplementedError,  # a way of packing that zipfile does not know
    RuntimeError,  # a member under a password
    MemoryError,  # a header that claims more than there is
    OverflowError,
    OSError,  # a directory that points before its file
    struct.error,
    tokenize.TokenError,
    zipfile.BadZipFile,
    zlib.error,
)


def save_arrays(path: Path, arrays: dict[str, Array], about: str) -> None:
    """Write arrays to a file; an existing one is replaced once the new one is whole."""
    labels = {"version": VERSION, "about": about, "checksum": checksum(arrays, about)}
    payload: dict[str, Any] = {name: np.array(value) for name, value in labels.items()}
    with replacing(path) as temporary, temporary.open("wb") as stream:
        np.savez_compressed(stream, **(payload | arrays))


def load_arrays(path: Path, names: Sequence[str]) -> tuple[dict[str, Array], str]:
    """Read the named arrays and the text that goes with them.

    Raises
    ------
    SpaceError
        If the file cannot be read, is of another version, or is damaged.
    """
    held = members(path, (*LABELS, *names))
    for name in (*LABELS, *names):
        if name not in held:
            raise SpaceError(f"{path}: is no shape space: it holds no array {name!r}")
    if held["version"].shape != () or held["version"] != VERSION:
        raise SpaceError(
            f"{path}: has version {held['version']}, allowed is {VERSION}, as landmarks are spaced "
            "otherwise; make it again (bladegen space build)"
        )
    arrays = {name: held[name] for name in names}
    about = str(held["about"])
    if str(held["checksum"]) != checksum(arrays, about):
        raise SpaceError(f"{path}: is damaged: its checksum does not match its arrays")
    return arrays, about


def members(path: Path, names: Sequence[str]) -> dict[str, Any]:
    """Return those of the named arrays that an npz file holds.

    Raises
    ------
    SpaceError
        If the file cannot be read, is damaged or too large, or holds Python objects.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(content_of(path, MAX_BYTES))) as archive:
            if sum(member.file_size for member in archive.infolist()) > MAX_BYTES:
                raise SpaceError(f"{path}: unpacks to more than {MAX_BYTES >> 20} MB")
            there = {name.removesuffix(".npy") for name in archive.namelist()}
            return {name: _member(archive, name) for name in names if name in there}
    except FileError as error:
        raise SpaceError(str(error)) from None
    except DAMAGED as error:
        raise SpaceError(f"{path}: is no shape space: {error}") from None


def _member(archive: zipfile.ZipFile, name: str) -> Any:
    with archive.open(f"{name}.npy") as stream:
        return np.lib.format.read_array(stream, allow_pickle=False)


def checksum(arrays: dict[str, Array], about: str) -> str:
    """Return the digest that vouches for arrays and the text that goes with them."""
    digest = hashlib.sha256(about.encode())
    for name, array in arrays.items():
        digest.update(f"{name} {array.shape} {array.dtype.str}".encode())
        digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()


def rewritten(package: bytes, change: Callable[[str, bytes], bytes]) -> bytes:
    """Return a zip file whose members' contents are changed, by their names; all else is kept."""
    result = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(package)) as old, zipfile.ZipFile(result, "w") as new:
        for info in old.infolist():
            new.writestr(info, change(info.filename, old.read(info)))
    return result.getvalue()
