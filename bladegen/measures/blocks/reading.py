"""Blocks of points (ni, nj, nk, 3) from PLOT3D and CGNS files that anyone wrote.

PLOT3D: one block or several, in three dimensions, Fortran unformatted records of either order of
bytes and either precision, or text; marks of blanked points are passed over.  CGNS: structured
zones of the first base, in the HDF5 mapping.  Lengths are those of the file.
"""

from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.errors import FileError
from bladegen.support.arrays import Array

__all__ = ["read"]

MOST = 100_000  # blocks
MARK = 4  # bytes of a record's mark, and of an integer

Blocks = list[tuple[str, Array]]


def read(path: Path) -> Blocks:
    """Return the names and points (ni, nj, nk, 3) of a file's blocks.

    Raises
    ------
    FileError
        If it is damaged, has no structured block, or has a number that is not finite.
    """
    readers = {".p3d": _records, ".fmt": _text, ".cgns": _zones}
    blocks = readers[path.suffix.lower()](path)
    if not blocks:
        raise FileError(str(path), ["has no structured block"])
    for name, points in blocks:
        if min(points.shape) < 1 or not np.isfinite(points).all():
            raise FileError(str(path), [f"{name}: has a coordinate that is no finite number"])
        if sorted(points.shape[:3])[1] < 2:
            raise FileError(str(path), [f"{name}: is a line of points, not a surface or volume"])
    return blocks


def _records(path: Path) -> Blocks:
    """Read PLOT3D's Fortran records."""
    data = path.read_bytes()
    order = next((c for c in "<>" if _number(data, 0, c) in (MARK, 3 * MARK)), None)
    if order is None:
        raise FileError(str(path), ["does not begin with a record of PLOT3D: one count, or 3"])
    records, integer = _split(path, data, order), f"{order}i4"
    if len(records[0]) == MARK:
        count, *records = records
        number = int(np.frombuffer(count, integer)[0])
        if not 0 < number <= MOST or not records or len(records[0]) != 3 * MARK * number:
            raise FileError(str(path), [f"has no three sizes for each of its {number} blocks"])
    shapes = np.frombuffer(records[0], integer).reshape(-1, 3).tolist()
    if len(records) != len(shapes) + 1:
        said = f"has {len(records) - 1} blocks, its head says {len(shapes)}"
        raise FileError(str(path), [said])
    return [
        (f"block {number}", _filled(path, record, shape, order))
        for number, (shape, record) in enumerate(zip(shapes, records[1:], strict=True), start=1)
    ]


def _split(path: Path, data: bytes, order: str) -> list[bytes]:
    """Return what lies between the marks of Fortran records, each of which has two."""
    records: list[bytes] = []
    place = 0
    while place < len(data):
        size = _number(data, place, order)
        end = place + MARK + size
        if size < 0 or end + MARK > len(data) or _number(data, end, order) != size:
            raise FileError(str(path), [f"record {len(records) + 1} does not end where it says"])
        records.append(data[place + MARK : end])
        place = end + MARK
    return records


def _filled(path: Path, record: bytes, shape: list[int], order: str) -> Array:
    """Return the points of a record: of 8 or 4 bytes a number, with marks of points or without."""
    count = prod(shape)
    real = next(
        (r for r in (8, 4) for mark in (0, MARK) if len(record) == count * (3 * r + mark)), 0
    )
    if min(shape) < 1 or not real:
        said = f"a block of {shape} points does not fill its record of {len(record)} bytes"
        raise FileError(str(path), [said])
    return _placed(np.frombuffer(record, f"{order}f{real}", 3 * count), shape)


def _number(data: bytes, place: int, order: str) -> int:
    """Return the integer of four bytes at a place, -1 behind the end."""
    part = data[place : place + MARK]
    return int(np.frombuffer(part, f"{order}i4")[0]) if len(part) == MARK else -1


def _text(path: Path) -> Blocks:
    """Read PLOT3D's text: a count, three sizes a block, and all numbers."""
    try:
        words = path.read_text(encoding="ascii").split()
        number = int(words[0]) if words else 0
        if not 0 < number <= MOST or len(words) < 1 + 3 * number:
            said = "does not begin with a count of blocks and three sizes each"
            raise FileError(str(path), [said])
        start = 1 + 3 * number
        shapes = np.array(words[1:start], dtype=np.int64).reshape(-1, 3).tolist()
        values = np.array(words[start:], dtype=np.float64)
    except ValueError:
        raise FileError(str(path), ["has something that is no number"]) from None
    counts = [3 * prod(shape) for shape in shapes]
    if min(map(min, shapes)) < 1 or sum(counts) != len(values):
        said = f"has {len(values)} coordinates, its head says {sum(counts)}"
        raise FileError(str(path), [said])
    parts = np.split(values, np.cumsum(counts)[:-1])
    return [
        (f"block {number}", _placed(part, shape))
        for number, (part, shape) in enumerate(zip(parts, shapes, strict=True), start=1)
    ]


def _placed(values: Any, size: list[int]) -> Array:
    """Return points of all x, then all y, then all z, i running fastest."""
    axes = values.reshape(3, *size[::-1]).astype(np.float64)
    points: Array = axes.transpose(3, 2, 1, 0)
    return points


def _zones(path: Path) -> Blocks:
    """Read the structured zones of CGNS."""
    import h5py

    try:
        file = h5py.File(path, "r")
    except OSError:
        raise FileError(str(path), ["is no CGNS file on HDF5"]) from None
    with file:
        base = next((one for one in _children(file, "CGNSBase_t")), None)
        if base is None:
            raise FileError(str(path), ["has no base"])
        blocks = []
        for zone in _children(base, "Zone_t"):
            name = zone.name.rpartition("/")[2]
            kind = next(_children(zone, "ZoneType_t"), None)
            if kind is not None and bytes(kind[" data"][()]).strip(b"\0 ") != b"Structured":
                raise FileError(str(path), [f"zone {name}: is unstructured; blocks alone are read"])
            held = next(_children(zone, "GridCoordinates_t"), None)
            if held is None:
                raise FileError(str(path), [f"zone {name}: has no coordinates"])
            axes = [np.asarray(held[f"Coordinate{axis}/ data"][()], dtype=float) for axis in "XYZ"]
            if len({axis.shape for axis in axes}) > 1 or axes[0].ndim not in (2, 3):
                raise FileError(str(path), [f"zone {name}: its coordinates are no block"])
            points = np.stack([axis.T for axis in axes], axis=-1)
            blocks.append((name, points if points.ndim == 4 else points[:, :, None]))
        return blocks


def _children(node: Any, label: str) -> Any:
    """Give the nodes below one that have a label."""
    for child in node.values():
        said = child.attrs.get("label", b"")
        if bytes(said if isinstance(said, bytes) else str(said).encode()) == label.encode():
            yield child
