"""A rotor: a blade's copies around the hub with precone, and a plain spinner.

Rotor frame: x along the rotor axis, downwind; z up.  The first blade points up.  A blade's frame
is its own with the root at the hub radius; its suction side faces downwind and its leading edge
goes first, so that the rotor turns clockwise as seen from upwind.  Precone leans tips upwind (to
-x), away from the tower, as windIO's positive cone angle does.  The mirror image turns the other
way.  Metres and radians; the STEP assembly is in millimetres.  cadquery comes late.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.cad import step_documents
from bladegen.cad.shapes import MILLIMETRES
from bladegen.cad.solids import Solid
from bladegen.cad.step_documents import NOBODY, Author, Part, Place
from bladegen.cad.triangles import triangulated
from bladegen.errors import CadError
from bladegen.support.arrays import Array
from bladegen.surface.gltf import Standing, glb
from bladegen.surface.mesh import TriangleMesh

__all__ = ["ASSEMBLED", "KINDS", "Rotor", "rotor_of", "standing", "write_glb", "write_step"]

NOSE, BACK = 1.3, 0.9  # lengths of the spinner ahead of and behind the blades, in its radii
COVER = 1.02  # the spinner's radius over what hides the root sections
KINDS = ("assembly", "fused", "sector")
MOST_BLADES = 8
LARGEST_HUB = 1.0  # radius over the blade's length
LARGEST_CONE = np.radians(45.0)
ASSEMBLED = (
    "rotor: blades begin inside the spinner, parts that lie in each other; --rotor-as fused makes "
    "one body of them"
)
DEFLECTION = 0.005  # m, of the spinner's triangles


@dataclass(frozen=True)
class Rotor:
    """Where the blades of a rotor stand.

    Parameters
    ----------
    blades : int
        How many, evenly around the axis.
    hub_radius : float
        From the axis to the blades' roots [m].
    cone : float
        Precone, positive upwind [rad].
    spinner_radius : float
        Of the plain spinner [m].
    mirrored : bool
        Turn anticlockwise as seen from upwind.
    made_as : str
        One of `KINDS`: parts in an assembly, one solid, or the solid of one blade's sector.
    """

    blades: int
    hub_radius: float
    cone: float
    spinner_radius: float
    mirrored: bool = False
    made_as: str = "assembly"

    def placements(self) -> tuple[Array, Array]:
        """Return rotations (n, 3, 3) and shifts (n, 3) [m]: points are ``p @ R.T + shift``.

        A mirrored blade is to be mirrored in its own y first.
        """
        c, s = np.cos(self.cone), np.sin(self.cone)
        lean = np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])  # z goes to (-s, 0, c)
        azimuth = 2.0 * np.pi * np.arange(self.blades) / self.blades
        ca, sa = np.cos(azimuth), np.sin(azimuth)
        zero, one = np.zeros_like(ca), np.ones_like(ca)
        turn = np.stack(
            [
                np.stack([one, zero, zero], axis=-1),
                np.stack([zero, ca, -sa], axis=-1),
                np.stack([zero, sa, ca], axis=-1),
            ],
            axis=-2,
        )
        rotations = turn @ lean
        return rotations, self.hub_radius * rotations[..., 2]


def rotor_of(
    blade: Blade,
    *,
    mirrored: bool = False,
    hub_radius: float | None = None,
    cone: float | None = None,
    made_as: str = "assembly",
) -> Rotor:
    """Return the rotor that a blade's definition describes.

    Parameters
    ----------
    blade : Blade
        The blade.
    mirrored : bool
        Turn anticlockwise as seen from upwind.
    hub_radius : float, optional
        Instead of the definition's [m].
    cone : float, optional
        Precone instead of the definition's, positive upwind [rad].
    made_as : str
        "assembly", "fused" or "sector".

    Raises
    ------
    CadError
        If there is no hub radius, or no usable number of blades or cone, or no such kind.
    """
    if made_as not in KINDS:
        raise CadError(f"made_as: got {made_as!r}, allowed are {', '.join(KINDS)}")
    facts = blade.definition.rotor
    if hub_radius is not None or cone is not None:
        facts = replace(
            facts,
            hub_radius=facts.hub_radius if hub_radius is None else hub_radius,
            cone=facts.cone if cone is None else cone,
        )
    if facts.hub_radius is None or not facts.hub_radius > 0:
        raise CadError(
            f"{blade.name}: the definition names no hub radius, which a rotor needs; give one "
            "(--hub-radius LENGTH, such as 2m)"
        )
    if not facts.hub_radius <= LARGEST_HUB * blade.length:
        raise CadError(
            f"{blade.name}: hub radius {facts.hub_radius:g} m, allowed is up to the blade's length "
            f"of {blade.length:g} m"
        )
    if not abs(facts.cone or 0.0) <= LARGEST_CONE:
        raise CadError(
            f"{blade.name}: precone {np.degrees(facts.cone or 0.0):g} deg, allowed is "
            f"{-np.degrees(LARGEST_CONE):g} to {np.degrees(LARGEST_CONE):g} deg"
        )
    if not 1 <= facts.blades <= MOST_BLADES:
        raise CadError(f"{blade.name}: {facts.blades} blades, allowed are 1 to {MOST_BLADES}")
    root = blade.sections(np.zeros(1))[0]
    reach = float(np.max(np.linalg.norm(root[:, :2], axis=-1)))
    radius = COVER * float(np.hypot(facts.hub_radius, reach))
    return Rotor(facts.blades, facts.hub_radius, facts.cone or 0.0, radius, mirrored, made_as)


def write_step(
    rotor: Rotor,
    solid: Solid,
    path: Path,
    *,
    schema: str = "ap242",
    timestamp: str | None = None,
    author: Author = NOBODY,
) -> None:
    """Write a rotor as one STEP assembly: the blade's part as blade 1, blade 2, ..., and spinner.

    Options are those of `exchange.write_step`.

    Raises
    ------
    CadError
        If OCCT cannot write the file.
    """
    from OCP.TopLoc import TopLoc_Location

    blade = mirrored_part(solid.part) if rotor.mirrored else solid.part
    places = [
        Place(f"blade {number}", blade, location(rotation, shift))
        for number, (rotation, shift) in enumerate(zip(*rotor.placements(), strict=True), start=1)
    ]
    hub = Part("spinner", spinner(rotor.spinner_radius))
    places.append(Place("spinner", hub, TopLoc_Location()))
    step_documents.write(
        (f"{solid.name} rotor", places), path, schema=schema, timestamp=timestamp, author=author
    )


def location(rotation: Array, shift: Array) -> Any:
    """Return where points ``p @ rotation.T + shift`` are, the shift in metres, as OCCT has it."""
    from OCP.gp import gp_Trsf
    from OCP.TopLoc import TopLoc_Location

    move = gp_Trsf()
    rows = np.concatenate([rotation, shift[:, None] * MILLIMETRES], axis=1)
    move.SetValues(*rows.ravel().tolist())
    return TopLoc_Location(move)


def mirrored_part(part: Part) -> Part:
    """Return a part mirrored in y, under the same names."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf

    mirror = gp_Trsf()
    mirror.SetMirror(gp_Ax2(gp_Pnt(), gp_Dir(0.0, 1.0, 0.0)))
    made = BRepBuilderAPI_Transform(part.shape, mirror, True)
    pieces = [(name, made.ModifiedShape(face), colour) for name, face, colour in part.pieces]
    return Part(part.name, made.Shape(), pieces)


def standing(rotor: Rotor, mesh: TriangleMesh) -> list[Standing]:
    """Return the blade's mesh as blade 1, blade 2, ..., and the spinner, each in its place."""
    blade = mesh
    if rotor.mirrored:
        vertices = mesh.vertices * np.array([1.0, -1.0, 1.0])
        blade = replace(mesh, vertices=vertices, faces=mesh.faces[:, ::-1])
    parts = [
        Standing(f"blade {number}", blade, rotation, shift)
        for number, (rotation, shift) in enumerate(zip(*rotor.placements(), strict=True), start=1)
    ]
    hub = triangulated(spinner(rotor.spinner_radius), DEFLECTION)
    return [*parts, Standing("spinner", hub, np.eye(3), np.zeros(3))]


def write_glb(rotor: Rotor, mesh: TriangleMesh, path: Path) -> None:
    """Write a rotor as GLB: the same parts under the same names, metres."""
    path.write_bytes(glb("rotor", standing(rotor, mesh)))


def spinner(radius: float, angle: float = 2.0 * np.pi) -> Any:
    """Return a solid of OCCT [mm]: an ellipsoidal nose ahead of a cylinder, along x.

    Or its share within an angle [rad], half of it on each side of z.
    """
    import cadquery as cq

    r = radius * MILLIMETRES
    nose = cq.Workplane("XY").moveTo(0, r).ellipseArc(NOSE * r, r, 90, 180)
    outline = nose.lineTo(BACK * r, 0).lineTo(BACK * r, r).close()
    turned = outline.revolve(np.degrees(angle), (0, 0, 0), (1, 0, 0))
    from_y = 90.0 - 0.5 * np.degrees(angle)
    return turned.rotate((0, 0, 0), (1, 0, 0), from_y).val().wrapped
