"""Triangle meshes to files of other programs and back, by trimesh, which is imported when needed.

What is read is checked: a triangle leads to a vertex that is there, and coordinates are numbers.
"""

import hashlib
import io
import re
import uuid
import zipfile
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.errors import FileError
from bladegen.support.archive import rewritten
from bladegen.support.arrays import Array, Indices
from bladegen.surface.mesh import SECTIONS, TriangleMesh, from_blade
from bladegen.surface.regions import COLOURS, REGIONS
from bladegen.surface.tips import Tip, flat_tip

__all__ = [
    "obj_text",
    "read",
    "region_word",
    "sound",
    "stl_text",
    "to_trimesh",
    "trimesh_of",
    "with_materials",
    "with_steady_ids",
]

MODEL = "3D/3dmodel.model"  # of a 3MF file, the member with the mesh
MATERIALS = 2  # its resource of materials; 1 is the object
FACET = (
    "facet normal %.6g %.6g %.6g\nouter loop\n"
    + 3 * "vertex %.9g %.9g %.9g\n"
    + "endloop\nendfacet\n"
)
FARTHEST = 1e9  # of a vertex of a file, in its unit: products of three lengths stay finite


def to_trimesh(mesh: TriangleMesh, *, scale: float = 1.0) -> Any:
    """Return the mesh as a trimesh.Trimesh, its lengths times `scale`."""
    import trimesh

    return trimesh.Trimesh(
        vertices=mesh.vertices * scale, faces=mesh.faces, process=False, validate=False
    )


def trimesh_of(blade: Blade, *, stations: int = SECTIONS, tip: Tip | None = None) -> Any:
    """Return a blade's mesh as a `trimesh.Trimesh` [m], for `Blade.mesh`."""
    return to_trimesh(from_blade(blade, stations=stations, tip=flat_tip if tip is None else tip))


def obj_text(mesh: TriangleMesh, header: str, *, scale: float = 1.0) -> str:
    """Return a mesh as a Wavefront OBJ file's text, a group a region, its lengths times `scale`."""
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in (mesh.vertices * scale).tolist()]
    regions = mesh.regions
    assert regions is not None  # a blade's mesh has them
    for number in np.unique(regions).tolist():
        lines.append(f"g {region_word(REGIONS[number])}")
        lines += [f"f {a} {b} {c}" for a, b, c in (mesh.faces[regions == number] + 1).tolist()]
    return "\n".join([f"# {header}", *lines, ""])


def stl_text(
    mesh: TriangleMesh, *, scale: float = 1.0, names: Sequence[str] = tuple(REGIONS)
) -> str:
    """Return a mesh as an STL file's text, a solid a region by name, its lengths times `scale`.

    Vertices are written alike wherever they come, so that readers join solids at their seams.
    """
    regions = mesh.regions
    assert regions is not None  # a blade's mesh has them
    corners = mesh.vertices[mesh.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(across, axis=1, keepdims=True)
    normals = np.divide(across, length, out=np.zeros_like(across), where=length > 0.0)
    rows = np.concatenate([normals[:, None], corners * scale], axis=1).reshape(-1, 12)
    parts = []
    for number in np.unique(regions).tolist():
        name = region_word(names[number])
        some = rows[regions == number]
        facets = FACET * len(some) % tuple(some.ravel().tolist())
        parts.append(f"solid {name}\n{facets}endsolid {name}\n")
    return "".join(parts)


def region_word(name: str) -> str:
    """Return a region's name as one word, for files that split names at blanks.

    >>> region_word("suction side")
    'suction_side'
    """
    return name.replace(" ", "_")


def with_materials(package: bytes, mesh: TriangleMesh, name: str) -> bytes:
    """Return a 3MF file of a mesh, its object named and each triangle of its region's material."""
    assert mesh.regions is not None  # a blade's mesh has them
    bases = "".join(
        f'<base name="{region}" displaycolor="#{"".join(f"{part:02X}" for part in colour)}"/>'
        for region, colour in COLOURS.items()
    )
    number = iter(mesh.regions.tolist())

    def changed(member: str, data: bytes) -> bytes:
        if member != MODEL:
            return data
        materials = f'<resources><basematerials id="{MATERIALS}">{bases}</basematerials>'
        data = data.replace(b"<resources>", materials.encode(), 1)
        title = escape(name).encode("ascii", "xmlcharrefreplace")
        told = b'name="%s" pid="%d" pindex="0"' % (title, MATERIALS)
        data = data.replace(b'name="geometry_0"', told, 1)
        return re.sub(
            rb'(<triangle v1="\d+" v2="\d+" v3="\d+")',
            lambda found: found[1] + b' pid="%d" p1="%d"' % (MATERIALS, next(number)),
            data,
        )

    return rewritten(package, changed)


def with_steady_ids(package: bytes) -> bytes:
    """Return a 3MF file with identifiers that follow from its content, instead of random ones."""
    with zipfile.ZipFile(io.BytesIO(package)) as archive:
        plain = b"".join(_UUID.sub(b"", archive.read(info)) for info in archive.infolist())
    seed = hashlib.sha256(plain).hexdigest()
    known: dict[bytes, bytes] = {}

    def steady(found: re.Match[bytes]) -> bytes:
        name = f"{seed}/{len(known)}"
        known.setdefault(found[0], str(uuid.uuid5(uuid.NAMESPACE_OID, name)).encode())
        return known[found[0]]

    return rewritten(package, lambda _, content: _UUID.sub(steady, content))


_UUID = re.compile(rb"(?<=UUID=\")[0-9a-fA-F-]{36}(?=\")")


def read(path: Path) -> Any:
    """Read a mesh file of any format that trimesh knows, as one trimesh.Trimesh.

    Files that it names beside itself (materials, pictures) are not opened.

    Raises
    ------
    FileError
        If trimesh cannot make sound triangles of it.
    """
    import trimesh

    try:
        kind = path.suffix.lower().lstrip(".")
        # a stream with a name leads trimesh to what lies beside
        content = io.BytesIO(path.read_bytes())
        loaded = trimesh.load_mesh(content, file_type=kind, resolver=None)
        vertices, faces = np.asarray(loaded.vertices), np.asarray(loaded.faces)
    except Exception as error:  # trimesh's loaders raise whatever their parsers do
        text = f"{type(error).__name__} {error}"
        raise FileError(str(path), [f"is no mesh that can be read: {text}"]) from None
    if len(vertices) and vertices.shape[1:] != (3,):
        said = f"has points of {vertices.shape[-1]} coordinates, 3 are needed"
        raise FileError(str(path), [said])
    if kind == "glb":  # y is up there, and regions have vertices of their own
        x, y, z = vertices.T
        made = sound(path, np.stack([x, -z, y], axis=-1), faces)
        made.merge_vertices()
        return made
    made = sound(path, vertices, faces, loaded)
    if kind == "stl":
        made.merge_vertices()  # solids of one file have vertices of their own
    return made


def sound(path: Path, vertices: Array, faces: Indices, made: Any = None) -> Any:
    """Return triangles of a file as a trimesh.Trimesh, `made` if there is one already.

    Raises
    ------
    FileError
        If there are none, one leads to a vertex that is not there, or a coordinate is no number.
    """
    if not len(faces):
        raise FileError(str(path), ["holds no triangles"])
    if faces.min() < 0 or faces.max() >= len(vertices):
        bad = int(faces.min() if faces.min() < 0 else faces.max())
        raise FileError(
            str(path), [f"a triangle names vertex {bad}, allowed are 0 to {len(vertices) - 1}"]
        )
    used = np.asarray(vertices)[np.unique(faces)]
    if not np.isfinite(used).all() or np.abs(used).max() > FARTHEST:
        raise FileError(
            str(path), [f"has vertices that are no numbers, or farther away than {FARTHEST:g}"]
        )
    return to_trimesh(TriangleMesh(vertices, faces)) if made is None else made
