"""Volumes to files: PLOT3D, and CGNS with connectivity, families and boundary conditions.

CGNS: a structured zone a block, k from the wall outward.  The wall has the families of the blade's
faces, the last layer that of the far field, the root plane one of its own, a plane of symmetry.
Metres.
"""

from pathlib import Path
from typing import Any

from bladegen.surface.block_files import cgns, plot3d
from bladegen.surface.grids.grid_files import families_of, joints_of, zone_name
from bladegen.surface.volumes.volume import Volume

__all__ = ["FAR", "ROOT", "write_cgns", "write_plot3d", "write_plot3d_text"]

FAR, ROOT = "far field", "root plane"


def write_plot3d(volume: Volume, path: Path, *, scale: float = 1.0) -> None:
    """Write a volume as PLOT3D in Fortran unformatted records, its lengths times `scale`."""
    plot3d.write_binary(_blocks(volume), path, scale=scale)


def write_plot3d_text(volume: Volume, path: Path, *, scale: float = 1.0) -> None:
    """Write a volume as PLOT3D in text, its lengths times `scale`."""
    plot3d.write_text(_blocks(volume), path, scale=scale)


def write_cgns(volume: Volume, path: Path, *, note: str = "") -> None:
    """Write a volume as CGNS in metres, with a note as a descriptor of its base."""
    families = [(family, "BCWall") for family in families_of(volume.grid)]
    families += [(FAR, "BCFarfield"), (ROOT, "BCSymmetryPlane")]
    with cgns.base(path, 3, families, note) as base:
        for number in range(len(volume.grid.blocks)):
            _zone(base, volume, number)


def _blocks(volume: Volume) -> list[Any]:
    return [volume.block(number) for number in range(len(volume.grid.blocks))]


def _zone(base: Any, volume: Volume, number: int) -> None:
    block, (ni, nj, nk) = volume.grid.blocks[number], volume.shapes[number]
    sizes = cgns.integers([[ni, nj, nk], [ni - 1, nj - 1, nk - 1], [0, 0, 0]])
    zone = cgns.node(base, zone_name(block), "Zone_t", sizes)
    cgns.node(zone, "ZoneType", "ZoneType_t", "Structured")
    cgns.coordinates(zone, volume.block(number))
    held = cgns.node(zone, "ZoneGridConnectivity", "ZoneGridConnectivity_t")
    for i, (donor, own, other, turn) in enumerate(joints_of(volume.grid, number), start=1):
        name = zone_name(volume.grid.blocks[donor])
        joint = cgns.node(held, f"Joint{i}", "GridConnectivity1to1_t", name)
        for label, (begin, end) in (("PointRange", own), ("PointRangeDonor", other)):
            found = cgns.index_range((*begin, 0), (*end, nk - 1))
            cgns.node(joint, label, "IndexRange_t", found)
        cgns.node(joint, "Transform", '"int[IndexDimension]"', cgns.integers([*turn, 3]))
    held = cgns.node(zone, "ZoneBC", "ZoneBC_t")
    faces = [
        ("Wall", block.family, (0, 0, 0), (ni - 1, nj - 1, 0)),
        ("Far", FAR, (0, 0, nk - 1), (ni - 1, nj - 1, nk - 1)),
    ]
    if volume.front.root[volume.front.numbers[number][0]].all():
        faces.append(("Root", ROOT, (0, 0, 0), (0, nj - 1, nk - 1)))
    for name, family, start, stop in faces:
        face = cgns.node(held, name, "BC_t", "FamilySpecified")
        cgns.node(face, "PointRange", "IndexRange_t", cgns.index_range(start, stop))
        cgns.node(face, "FamilyName", "FamilyName_t", cgns.camel(family))
