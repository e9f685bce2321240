"""Grids to files: PLOT3D, CGNS and VTK's unstructured XML; sections as a table.

PLOT3D: multi-block, three-dimensional with one layer, 8-byte reals; Fortran unformatted records,
little-endian, or text.  CGNS: the SIDS (version 3.4) in its HDF5 mapping, one structured zone a
block with 1-to-1 connectivity, a family a face of the blade, metres.  h5py and pyvista are
imported when first needed.
"""

from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.support.arrays import Array, Indices
from bladegen.surface.grids.grid import Block, Grid
from bladegen.surface.grids.interfaces import Corner, Interface
from bladegen.surface.vtk_files import save

__all__ = [
    "welded",
    "write_cgns",
    "write_plot3d",
    "write_plot3d_text",
    "write_sections",
    "write_vtu",
]

LIBRARY_VERSION = 3.4  # of CGNS
UNITS = "Kilogram", "Meter", "Second", "Kelvin", "Degree"
LENGTH = np.array([0, 1, 0, 0, 0], dtype=np.float32)  # exponents of these units
WALL = "BCWall"


def write_plot3d(grid: Grid, path: Path, *, scale: float = 1.0) -> None:
    """Write a grid as PLOT3D in Fortran unformatted records, its lengths times `scale`."""
    header = [np.array([len(grid.blocks)], dtype="<i4")]
    header.append(np.array([_layers(block) for block in grid.blocks], dtype="<i4"))
    with path.open("wb") as file:
        for record in (*header, *(_coordinates(block, scale) for block in grid.blocks)):
            mark = np.array([record.nbytes], dtype="<i4").tobytes()
            file.write(mark + record.tobytes() + mark)


def write_plot3d_text(grid: Grid, path: Path, *, scale: float = 1.0) -> None:
    """Write a grid as PLOT3D in text, its lengths times `scale`; 17 digits keep every bit."""
    with path.open("w", encoding="ascii") as file:
        file.write(f"{len(grid.blocks)}\n")
        file.writelines(" ".join(map(str, _layers(block))) + "\n" for block in grid.blocks)
        for block in grid.blocks:
            np.savetxt(file, _coordinates(block, scale), fmt="%.16e")


def write_sections(eta: Array, u: Array, sections: Array, path: Path) -> None:
    """Write sections (k, n, 3) [m] at spans eta (k,) and landmarks u (n,) as CSV.

    A row a landmark: eta, number of the landmark from 1, u, x, y, z; 17 digits keep every bit.
    """
    k, n, _ = sections.shape
    columns = np.column_stack(
        [
            np.repeat(eta, n),
            np.tile(np.arange(1, n + 1), k),
            np.tile(u, k),
            sections.reshape(-1, 3),
        ]
    )
    with path.open("w", encoding="ascii", newline="\n") as file:
        file.write("eta,landmark,u,x_m,y_m,z_m\n")
        np.savetxt(file, columns, fmt=["%.17g", "%d", *["%.17g"] * 4], delimiter=",")


def write_vtu(grid: Grid, path: Path, *, scale: float = 1.0) -> None:
    """Write a grid as one unstructured VTK grid of quadrilaterals, its lengths times `scale`.

    Blocks share points.  Points carry `eta` and `u`, cells the number of their `block`, and
    under each face's name 1 where they belong to it and 0 elsewhere.
    """
    import pyvista as pv

    first, cells = welded(grid)
    sizes = [block.eta[1:, 1:].size for block in grid.blocks]
    points = np.concatenate([block.points.reshape(-1, 3) for block in grid.blocks])[first]
    data = pv.UnstructuredGrid({pv.CellType.QUAD: cells}, points * scale)
    for name in ("eta", "u"):
        values = np.concatenate([getattr(block, name).reshape(-1) for block in grid.blocks])
        data.point_data[name] = values[first]
    data.cell_data["block"] = np.repeat(np.arange(len(sizes)), sizes)
    for family in _families(grid):
        belongs = [block.family == family for block in grid.blocks]
        data.cell_data[family] = np.repeat(np.array(belongs, dtype=np.uint8), sizes)
    save(data, path)


def welded(grid: Grid) -> tuple[Indices, Indices]:
    """Return which points of all blocks in a row are the first of their kind, and cells of these.

    Returns
    -------
    first : (p,) array of int
        Places of the distinct points.
    cells : (c, 4) array of int
        Indices of each quadrilateral's corners among these, counter-clockwise seen from outside.
    """
    points = np.concatenate([block.points.reshape(-1, 3) for block in grid.blocks])
    _, first, index = np.unique(points, axis=0, return_index=True, return_inverse=True)
    cells, start = [], 0
    for block in grid.blocks:
        ni, nj = block.eta.shape
        own = index[start : start + ni * nj].reshape(ni, nj)
        corners = own[:-1, :-1], own[1:, :-1], own[1:, 1:], own[:-1, 1:]
        cells.append(np.stack(corners, axis=-1).reshape(-1, 4))
        start += ni * nj
    return first, np.concatenate(cells)


def write_cgns(grid: Grid, path: Path, *, note: str = "") -> None:
    """Write a grid as CGNS in metres, with a note as a descriptor of its base."""
    import h5py

    memory = BytesIO()  # at a full disk HDF5 cannot close its file
    with h5py.File(memory, "w", track_order=True, libver=("earliest", "v108")) as file:
        _attributes(file, "HDF5 MotherNode", "Root Node of HDF5 File", "MT")
        file.create_dataset(" format", data=_text("IEEE_LITTLE_32", 15))
        version = f"HDF5 Version {h5py.version.hdf5_version}"
        file.create_dataset(" hdf5version", data=_text(version, 33))
        _node(
            file,
            "CGNSLibraryVersion",
            "CGNSLibraryVersion_t",
            np.array([LIBRARY_VERSION], dtype=np.float32),
        )
        base = _node(file, "Base", "CGNSBase_t", _integers([2, 3]))
        _node(base, "DataClass", "DataClass_t", "Dimensional")
        units = np.stack([_text(f"{unit:32}", 32) for unit in UNITS])
        _node(base, "DimensionalUnits", "DimensionalUnits_t", units)
        if note:
            _node(base, "bladegen", "Descriptor_t", note)
        for family in _families(grid):
            node = _node(base, _camel(family), "Family_t")
            _node(node, "FamilyBC", "FamilyBC_t", WALL)
        for number, block in enumerate(grid.blocks):
            _zone(base, grid, number, block)
    path.write_bytes(memory.getbuffer())


def _zone(base: Any, grid: Grid, number: int, block: Block) -> None:
    ni, nj = block.eta.shape
    sizes = _integers([[ni, nj], [ni - 1, nj - 1], [0, 0]])
    zone = _node(base, _zone_name(block), "Zone_t", sizes)
    _node(zone, "ZoneType", "ZoneType_t", "Structured")
    coordinates = _node(zone, "GridCoordinates", "GridCoordinates_t")
    for axis, name in enumerate("XYZ"):
        values = np.ascontiguousarray(block.points[..., axis].T)
        array = _node(coordinates, f"Coordinate{name}", "DataArray_t", values)
        _node(array, "DimensionalExponents", "DimensionalExponents_t", LENGTH)
    _node(zone, "FamilyName", "FamilyName_t", _camel(block.family))
    joined = _node(zone, "ZoneGridConnectivity", "ZoneGridConnectivity_t")
    for i, (donor, own, other, transform) in enumerate(_joints(grid, number), start=1):
        name = _zone_name(grid.blocks[donor])
        joint = _node(joined, f"Joint{i}", "GridConnectivity1to1_t", name)
        _node(joint, "PointRange", "IndexRange_t", _range(*own))
        _node(joint, "PointRangeDonor", "IndexRange_t", _range(*other))
        _node(joint, "Transform", '"int[IndexDimension]"', _integers(transform))


Edge = tuple[Corner, Corner]


def _joints(grid: Grid, number: int) -> Iterator[tuple[int, Edge, Edge, Corner]]:
    """Give a block's interfaces, seen from it, their ranges increasing."""
    for joint in grid.interfaces:
        own, other = (joint.start, joint.stop), (joint.donor_start, joint.donor_stop)
        if joint.block == number:
            yield joint.donor, *_increasing(own, other), joint.transform
        elif joint.donor == number:
            yield joint.block, *_increasing(other, own), _inverse(joint)


def _increasing(own: Edge, other: Edge) -> tuple[Edge, Edge]:
    return (own, other) if own[0] < own[1] else (own[::-1], other[::-1])


def _inverse(joint: Interface) -> Corner:
    """Return a transform seen from the donor; its matrix is orthogonal."""
    found = {abs(b) - 1: (a + 1) * (1 if b > 0 else -1) for a, b in enumerate(joint.transform)}
    return found[0], found[1]


def _range(start: Corner, stop: Corner) -> Any:
    """Return a range of indices as CGNS counts them, from 1."""
    return _integers([start, stop]) + 1


def _node(parent: Any, name: str, label: str, value: Any = None) -> Any:
    """Add a node of the CGNS tree to an HDF5 group."""
    node = parent.create_group(name, track_order=True)
    if isinstance(value, str):
        value = _text(value, len(value))
    kinds = {"int8": "C1", "int32": "I4", "float32": "R4", "float64": "R8"}
    _attributes(node, name, label, "MT" if value is None else kinds[value.dtype.name])
    node.attrs.create("flags", _integers([1]))
    if value is not None:
        node.create_dataset(" data", data=value)
    return node


def _attributes(node: Any, name: str, label: str, kind: str) -> None:
    import h5py

    for key, text, size in (("name", name, 33), ("label", label, 33), ("type", kind, 3)):
        terminated = h5py.h5t.C_S1.copy()
        terminated.set_size(size)
        node.attrs.create(key, np.bytes_(text), dtype=h5py.Datatype(terminated))


def _integers(values: Any) -> Any:
    """Return integers as CGNS holds them, of 32 bits."""
    return np.array(values, dtype=np.int32)


def _text(text: str, size: int) -> Any:
    """Return text as CGNS holds it, bytes padded with zeros."""
    return np.frombuffer(text.encode("ascii").ljust(size, b"\0"), dtype=np.int8)


def _families(grid: Grid) -> list[str]:
    return list(dict.fromkeys(block.family for block in grid.blocks))


def _camel(name: str) -> str:
    return "".join(word.capitalize() for word in name.split())


def _zone_name(block: Block) -> str:
    return f"Zone{_camel(block.name)}"  # families of the same name lie beside zones


def _layers(block: Block) -> tuple[int, int, int]:
    return (*block.eta.shape, 1)


def _coordinates(block: Block, scale: float) -> Array:
    """Return all x, then all y, then all z, i running fastest."""
    values: Array = (scale * block.points).transpose(2, 1, 0).reshape(-1).astype("<f8")
    return values
