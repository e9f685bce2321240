"""Triangle meshes to glTF 2.0 in one binary file (GLB): named nodes, normals, materials.

glTF has y up: one node at the root turns the blade's frame, z up, into glTF's.  Below it each
region of a blade is a node with a mesh and a material of its own; a mesh that stands in several
places is stored once.  Metres.
"""

import json
import struct
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from bladegen.support.arrays import Array, Indices
from bladegen.surface.mesh import TriangleMesh
from bladegen.surface.regions import COLOURS, REGIONS
from bladegen.version import __version__

__all__ = ["Standing", "glb"]

Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])  # of blades' x, y, z
SIDES = 2  # regions, the first, whose normals run on from one to the other
SMOOTH = 0.5  # cosine; where the sides' common normal leaves a side's own farther, there is an edge
PLAIN = (185, 198, 210)  # sRGB, of what has no regions
ROUGH = 0.5
FLOAT, UNSIGNED = 5126, 5125  # what glTF calls types of numbers
POINTS, INDICES = 34962, 34963  # and uses of buffers
CHUNKS = b"JSON", b"BIN\0"


class Standing(NamedTuple):
    """A mesh in its place: points are ``p @ rotation.T + shift``."""

    name: str
    mesh: TriangleMesh
    rotation: Array
    shift: Array


def glb(name: str, parts: Sequence[Standing]) -> bytes:
    """Return a GLB file's bytes: a node of that name, and below it the parts, in their regions."""
    tree: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": f"bladegen {__version__}"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": name, "matrix": _matrix(Y_UP, np.zeros(3)), "children": []}],
    }
    tree |= {key: [] for key in ("meshes", "materials", "accessors", "bufferViews")}
    data = bytearray()
    known: dict[int, list[tuple[str, int]]] = {}
    alone = len(parts) == 1
    for part in parts:
        if id(part.mesh) not in known:
            known[id(part.mesh)] = _regions(part.mesh, tree, data)
        nodes, regions = tree["nodes"], known[id(part.mesh)]
        parent = nodes[0]
        if not alone:
            nodes[0]["children"].append(len(nodes))
            parent = {"name": part.name, "matrix": _matrix(part.rotation, part.shift)}
            nodes.append(parent | {"children": []})
            parent = nodes[-1]
        for region, number in regions:
            parent["children"].append(len(nodes))
            nodes.append({"name": region if alone else f"{part.name} {region}", "mesh": number})
    tree["buffers"] = [{"byteLength": len(data)}]
    text = json.dumps(tree, separators=(",", ":")).encode()
    chunks = (text.ljust(-(-len(text) // 4) * 4), bytes(data))
    body = b"".join(
        struct.pack("<I4s", len(chunk), kind) + chunk
        for kind, chunk in zip(CHUNKS, chunks, strict=True)
    )
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def _matrix(rotation: Array, shift: Array) -> list[float]:
    """Return a placement as glTF has it: 4 by 4, column by column."""
    move = np.eye(4)
    move[:3, :3], move[:3, 3] = rotation, shift
    return [float(value) for value in move.T.ravel()]


def _regions(mesh: TriangleMesh, tree: dict[str, Any], data: bytearray) -> list[tuple[str, int]]:
    """Add a mesh's regions; return their names and numbers."""
    if mesh.regions is None:
        normals = _normals(mesh, np.ones(len(mesh.faces), dtype=bool))
        return [("surface", _mesh(mesh.vertices, normals, mesh.faces, "surface", tree, data))]
    common = _normals(mesh, mesh.regions < SIDES)
    found = []
    for number in np.unique(mesh.regions).tolist():
        some = mesh.regions == number
        normals = _normals(mesh, some)
        if number < SIDES:
            smooth = np.sum(normals * common, axis=1, keepdims=True) > SMOOTH
            normals = np.where(smooth, common, normals)
        name = REGIONS[number]
        used, faces = np.unique(mesh.faces[some], return_inverse=True)
        faces = faces.reshape(-1, 3)
        found.append((name, _mesh(mesh.vertices[used], normals[used], faces, name, tree, data)))
    return found


def _normals(mesh: TriangleMesh, some: Any) -> Array:
    """Return unit normals at all vertices (v, 3), the means of some triangles' by area."""
    faces = mesh.faces[some]
    a, b, c = (mesh.vertices[faces[:, i]] for i in range(3))
    across = np.cross(b - a, c - a)
    owners, count = faces.T.ravel(), len(mesh.vertices)
    sums = np.stack(
        [np.bincount(owners, np.tile(across[:, i], 3), minlength=count) for i in range(3)], axis=1
    )
    length = np.linalg.norm(sums, axis=1, keepdims=True)
    up = np.tile([0.0, 0.0, 1.0], (count, 1))
    normals: Array = np.divide(sums, length, out=up, where=length > 0.0)
    return normals


def _mesh(
    points: Array, normals: Array, faces: Indices, name: str, tree: dict[str, Any], data: bytearray
) -> int:
    """Add a mesh with its material; return its number."""
    colour = np.array(COLOURS.get(name, PLAIN)) / 255.0
    linear = np.where(colour <= 0.04045, colour / 12.92, ((colour + 0.055) / 1.055) ** 2.4)
    tree["materials"].append(
        {
            "name": name,
            "pbrMetallicRoughness": {
                "baseColorFactor": [*np.round(linear, 6).tolist(), 1.0],
                "metallicFactor": 0.0,
                "roughnessFactor": ROUGH,
            },
        }
    )
    attributes = {
        "POSITION": _accessor(points.astype("<f4"), FLOAT, "VEC3", POINTS, tree, data),
        "NORMAL": _accessor(normals.astype("<f4"), FLOAT, "VEC3", POINTS, tree, data),
    }
    indices = _accessor(faces.astype("<u4").ravel(), UNSIGNED, "SCALAR", INDICES, tree, data)
    primitive = {
        "attributes": attributes,
        "indices": indices,
        "material": len(tree["materials"]) - 1,
    }
    tree["meshes"].append({"name": name, "primitives": [primitive]})
    return len(tree["meshes"]) - 1


def _accessor(
    values: Any, kind: int, shape: str, target: int, tree: dict[str, Any], data: bytearray
) -> int:
    """Add numbers to the buffer; return their accessor's number."""
    view = {"buffer": 0, "byteOffset": len(data), "byteLength": values.nbytes, "target": target}
    data += values.tobytes()
    tree["bufferViews"].append(view)
    accessor = {
        "bufferView": len(tree["bufferViews"]) - 1,
        "componentType": kind,
        "count": len(values),
        "type": shape,
    }
    if shape == "VEC3":
        accessor |= {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
    tree["accessors"].append(accessor)
    return len(tree["accessors"]) - 1
