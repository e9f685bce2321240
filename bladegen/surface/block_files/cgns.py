"""The tree of a CGNS file in its HDF5 mapping: nodes with labels and values, ranges from 1.

The SIDS, version 3.4; lengths in metres.  h5py is imported when first needed.
"""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["base", "camel", "coordinates", "index_range", "integers", "node"]

LIBRARY_VERSION = 3.4  # of CGNS
UNITS = "Kilogram", "Meter", "Second", "Kelvin", "Degree"
LENGTH = np.array([0, 1, 0, 0, 0], dtype=np.float32)  # exponents of these units


@contextmanager
def base(path: Path, cell: int, families: Iterable[tuple[str, str]], note: str) -> Iterator[Any]:
    """Give the base of a new file, of cells of a dimension in space, to add zones to.

    `families` are names and the boundary conditions that they stand for; a note becomes a
    descriptor.
    """
    import h5py

    memory = BytesIO()  # at a full disk HDF5 cannot close its file
    with h5py.File(memory, "w", track_order=True, libver=("earliest", "v108")) as file:
        _attributes(file, "HDF5 MotherNode", "Root Node of HDF5 File", "MT")
        file.create_dataset(" format", data=_text("IEEE_LITTLE_32", 15))
        version = f"HDF5 Version {h5py.version.hdf5_version}"
        file.create_dataset(" hdf5version", data=_text(version, 33))
        number = np.array([LIBRARY_VERSION], dtype=np.float32)
        node(file, "CGNSLibraryVersion", "CGNSLibraryVersion_t", number)
        made = node(file, "Base", "CGNSBase_t", integers([cell, 3]))
        node(made, "DataClass", "DataClass_t", "Dimensional")
        units = np.stack([_text(f"{unit:32}", 32) for unit in UNITS])
        node(made, "DimensionalUnits", "DimensionalUnits_t", units)
        if note:
            node(made, "bladegen", "Descriptor_t", note)
        for name, condition in families:
            node(node(made, camel(name), "Family_t"), "FamilyBC", "FamilyBC_t", condition)
        yield made
    path.write_bytes(memory.getbuffer())


def coordinates(zone: Any, points: Array) -> None:
    """Add the coordinates of points (ni, ..., 3) [m] to a zone."""
    held = node(zone, "GridCoordinates", "GridCoordinates_t")
    for axis, name in enumerate("XYZ"):
        values = np.ascontiguousarray(points[..., axis].T)
        array = node(held, f"Coordinate{name}", "DataArray_t", values)
        node(array, "DimensionalExponents", "DimensionalExponents_t", LENGTH)


def node(parent: Any, name: str, label: str, value: Any = None) -> Any:
    """Add a node of the CGNS tree to an HDF5 group."""
    made = parent.create_group(name, track_order=True)
    if isinstance(value, str):
        value = _text(value, len(value))
    kinds = {"int8": "C1", "int32": "I4", "float32": "R4", "float64": "R8"}
    _attributes(made, name, label, "MT" if value is None else kinds[value.dtype.name])
    made.attrs.create("flags", integers([1]))
    if value is not None:
        made.create_dataset(" data", data=value)
    return made


def index_range(start: tuple[int, ...], stop: tuple[int, ...]) -> Any:
    """Return a range of indices as CGNS counts them, from 1."""
    return integers([start, stop]) + 1


def integers(values: Any) -> Any:
    """Return integers as CGNS holds them, of 32 bits."""
    return np.array(values, dtype=np.int32)


def camel(name: str) -> str:
    """Return a name as nodes have it.

    >>> camel("suction side")
    'SuctionSide'
    """
    return "".join(word.capitalize() for word in name.split())


def _attributes(made: Any, name: str, label: str, kind: str) -> None:
    import h5py

    for key, text, size in (("name", name, 33), ("label", label, 33), ("type", kind, 3)):
        terminated = h5py.h5t.C_S1.copy()
        terminated.set_size(size)
        made.attrs.create(key, np.bytes_(text), dtype=h5py.Datatype(terminated))


def _text(text: str, size: int) -> Any:
    """Return text as CGNS holds it, bytes padded with zeros."""
    return np.frombuffer(text.encode("ascii").ljust(size, b"\0"), dtype=np.int8)
