"""Grids to files: PLOT3D, CGNS and VTK's unstructured XML; sections as a table.

PLOT3D: multi-block, three-dimensional with one layer, 8-byte reals; Fortran unformatted records,
little-endian, or text.  CGNS: the SIDS (version 3.4) in its HDF5 mapping, one structured zone a
block with 1-to-1 connectivity, a family a face of the blade, metres.  h5py and pyvista are
imported when first needed.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.support.arrays import Array, Indices
from bladegen.surface.block_files import cgns, plot3d
from bladegen.surface.grids.grid import Block, Grid
from bladegen.surface.grids.interfaces import Corner, Interface
from bladegen.surface.vtk_files import save

__all__ = [
    "families_of",
    "joints_of",
    "numbered",
    "welded",
    "write_cgns",
    "write_plot3d",
    "write_plot3d_text",
    "write_sections",
    "write_vtu",
    "zone_name",
]

WALL = "BCWall"


def write_plot3d(grid: Grid, path: Path, *, scale: float = 1.0) -> None:
    """Write a grid as PLOT3D in Fortran unformatted records, its lengths times `scale`."""
    plot3d.write_binary(_layers(grid), path, scale=scale)


def write_plot3d_text(grid: Grid, path: Path, *, scale: float = 1.0) -> None:
    """Write a grid as PLOT3D in text, its lengths times `scale`; 17 digits keep every bit."""
    plot3d.write_text(_layers(grid), path, scale=scale)


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
    for family in families_of(grid):
        belongs = [block.family == family for block in grid.blocks]
        data.cell_data[family] = np.repeat(np.array(belongs, dtype=np.uint8), sizes)
    save(data, path)


def numbered(grid: Grid) -> tuple[Indices, list[Indices]]:
    """Return which points of all blocks in a row are the first of their kind, and each block's.

    Returns
    -------
    first : (p,) array of int
        Places of the distinct points.
    numbers : list of (ni, nj) arrays of int
        Indices of the blocks' points among these.
    """
    points = np.concatenate([block.points.reshape(-1, 3) for block in grid.blocks])
    _, first, index = np.unique(points, axis=0, return_index=True, return_inverse=True)
    ends = np.cumsum([block.eta.size for block in grid.blocks])
    parts = np.split(index, ends[:-1])
    return first, [
        part.reshape(block.eta.shape) for part, block in zip(parts, grid.blocks, strict=True)
    ]


def welded(grid: Grid) -> tuple[Indices, Indices]:
    """Return which points of all blocks in a row are the first of their kind, and cells of these.

    Returns
    -------
    first : (p,) array of int
        Places of the distinct points.
    cells : (c, 4) array of int
        Indices of each quadrilateral's corners among these, counter-clockwise seen from outside.
    """
    first, numbers = numbered(grid)
    corners = [(own[:-1, :-1], own[1:, :-1], own[1:, 1:], own[:-1, 1:]) for own in numbers]
    return first, np.concatenate([np.stack(four, axis=-1).reshape(-1, 4) for four in corners])


def write_cgns(grid: Grid, path: Path, *, note: str = "") -> None:
    """Write a grid as CGNS in metres, with a note as a descriptor of its base."""
    families = [(family, WALL) for family in families_of(grid)]
    with cgns.base(path, 2, families, note) as base:
        for number, block in enumerate(grid.blocks):
            _zone(base, grid, number, block)


def _zone(base: Any, grid: Grid, number: int, block: Block) -> None:
    ni, nj = block.eta.shape
    sizes = cgns.integers([[ni, nj], [ni - 1, nj - 1], [0, 0]])
    zone = cgns.node(base, zone_name(block), "Zone_t", sizes)
    cgns.node(zone, "ZoneType", "ZoneType_t", "Structured")
    cgns.coordinates(zone, block.points)
    cgns.node(zone, "FamilyName", "FamilyName_t", cgns.camel(block.family))
    held = cgns.node(zone, "ZoneGridConnectivity", "ZoneGridConnectivity_t")
    for i, (donor, own, other, transform) in enumerate(joints_of(grid, number), start=1):
        name = zone_name(grid.blocks[donor])
        joint = cgns.node(held, f"Joint{i}", "GridConnectivity1to1_t", name)
        cgns.node(joint, "PointRange", "IndexRange_t", cgns.index_range(*own))
        cgns.node(joint, "PointRangeDonor", "IndexRange_t", cgns.index_range(*other))
        cgns.node(joint, "Transform", '"int[IndexDimension]"', cgns.integers(transform))


Edge = tuple[Corner, Corner]


def joints_of(grid: Grid, number: int) -> Iterator[tuple[int, Edge, Edge, Corner]]:
    """Give a block's interfaces, seen from it, their ranges increasing.

    For each the other block's place, both edges, and the transform from one to the other.
    """
    for joint in grid.interfaces:
        own, other = (joint.start, joint.stop), (joint.donor_start, joint.donor_stop)
        if joint.block == number:
            yield joint.donor, *_increasing(own, other), joint.transform
        elif joint.donor == number:
            yield joint.block, *_increasing(other, own), _inverse(joint)


def families_of(grid: Grid) -> list[str]:
    """Return the families of a grid's blocks, each once."""
    return list(dict.fromkeys(block.family for block in grid.blocks))


def zone_name(block: Block) -> str:
    """Return a block's name as a zone; families of the same name lie beside zones."""
    return f"Zone{cgns.camel(block.name)}"


def _increasing(own: Edge, other: Edge) -> tuple[Edge, Edge]:
    return (own, other) if own[0] < own[1] else (own[::-1], other[::-1])


def _inverse(joint: Interface) -> Corner:
    """Return a transform seen from the donor; its matrix is orthogonal."""
    found = {abs(b) - 1: (a + 1) * (1 if b > 0 else -1) for a, b in enumerate(joint.transform)}
    return found[0], found[1]


def _layers(grid: Grid) -> list[Array]:
    """Return the blocks' points (ni, nj, 1, 3)."""
    return [block.points[:, :, None] for block in grid.blocks]
