"""OpenFOAM's dictionary of a sector's blocks, for blockMesh: vertices, arcs, blocks and patches.

Faces of the two sides are counted alike, from the hub outward and downwind, as cyclic patches must
be.  Reference: OpenFOAM's user guide, "Mesh generation with the blockMesh utility".
"""

from math import hypot
from typing import Any

from bladegen.exports.cases.poly_mesh import FAR
from bladegen.exports.cases.rotors.sector import RING, Edge, Sector
from bladegen.support.foam import vector

__all__ = ["FAR", "HUB", "INLET", "OUTLET", "SIDES", "ZONE", "block_mesh"]

INLET, OUTLET, HUB = "inlet", "outlet", "hub"
SIDES = "side_before", "side_after"
ZONE = "rotor"  # of all cells
AROUND: tuple[Edge, ...] = (
    ("-far_side", "-far_middle"),
    ("-far_middle", "-far_strip"),
    ("-far_strip", "far_strip"),
    ("far_strip", "far_middle"),
    ("far_middle", "far_side"),
)
OUTWARD: tuple[Edge, ...] = (("hub", "side"), ("side", "ring_side"), ("ring_side", "far_side"))
LYING: dict[str, tuple[Edge, ...]] = {  # patches along the axis, by edges across it
    FAR: AROUND,
    HUB: (("-hub", "hub"),),
    SIDES[0]: tuple((f"-{a}", f"-{b}") for a, b in OUTWARD),
    SIDES[1]: OUTWARD,
}


def block_mesh(sector: Sector) -> dict[str, Any]:
    """Return the entries of blockMeshDict."""
    place = {name: i for i, name in enumerate(sector.points)}
    count, last = len(place), len(sector.layers)

    def corners(names: tuple[str, ...], plane: int) -> list[int]:
        return [place[name] + count * plane for name in names]

    blocks = []
    for layer, (cells, longer) in enumerate(sector.layers):
        for face in sector.faces:
            a, b, c, d = face
            ab, dc, ad, bc = (sector.edge(*one) for one in ((a, b), (d, c), (a, d), (b, c)))
            graded = [edge[1] for edge in (ab, dc, dc, ab, ad, bc, bc, ad)] + 4 * [longer]
            shown = vector(corners(face, layer) + corners(face, layer + 1))
            blocks.append(
                f"hex {shown} {ZONE} {vector((ab[0], ad[0], cells))} edgeGrading {vector(graded)}"
            )
    patches = {
        INLET: [corners(face, 0) for face in sector.faces],
        OUTLET: [corners(face, last) for face in sector.faces],
    }
    for name, edges in LYING.items():
        patches[name] = [
            [*corners(edge, layer), *corners(edge[::-1], layer + 1)]
            for layer in range(last)
            for edge in edges
        ]
    ring = tuple((a.replace("far", "ring"), b.replace("far", "ring")) for a, b in AROUND)
    circles = {sector.hub: LYING[HUB], sector.far: AROUND, RING * sector.tip: ring}
    return {
        "scale": 1,
        "vertices": [
            (sector.along_x(plane, hypot(*point)), *point.tolist())
            for plane in range(last + 1)
            for point in sector.points.values()
        ],
        "edges": [
            f"arc {' '.join(map(str, corners(edge, plane)))} "
            f"{vector((sector.along_x(plane, radius), *_between(sector, edge, radius)))}"
            for plane in range(last + 1)
            for radius, edges in circles.items()
            for edge in edges
        ],
        "blocks": blocks,
        "boundary": [_patch(name, faces) for name, faces in patches.items()],
    }


def _between(sector: Sector, edge: Edge, radius: float) -> list[float]:
    """Return the middle of an arc around the axis, y and z."""
    middle = sector.points[edge[0]] + sector.points[edge[1]]
    found: list[float] = (radius * middle / hypot(*middle)).tolist()
    return found


def _patch(name: str, faces: list[list[int]]) -> str:
    """Return a patch on one line."""
    kind = "type patch;"
    if name in SIDES:
        kind = (
            f"type cyclic; neighbourPatch {SIDES[1 - SIDES.index(name)]}; transform rotational; "
            "rotationAxis (1 0 0); rotationCentre (0 0 0);"
        )
    return f"{name} {{ {kind} faces ({' '.join(map(vector, faces))}); }}"
