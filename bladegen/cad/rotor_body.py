"""A rotor as one body: blades and spinner fused, or the sector of one blade between two cuts.

The frame is that of `rotor`.  Where blades come out of the spinner their faces meet along curves of
both, without a fillet: OCCT's fillets fail there, at every radius that was tried (100 to 600 mm, on
all bundled blades).  Millimetres in OCCT's shapes, metres in what is returned.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.cad import step_documents
from bladegen.cad.rotor import Rotor, location, mirrored_part, spinner
from bladegen.cad.shapes import MILLIMETRES, is_valid, members, volume
from bladegen.cad.solids import Solid
from bladegen.cad.step_documents import Part
from bladegen.cad.triangles import by_face, welded
from bladegen.errors import CadError
from bladegen.surface.mesh import TriangleMesh
from bladegen.surface.mesh_files import stl_text

__all__ = ["CUTS", "MAKERS", "SPINNER", "RotorBody", "fused", "sector"]

SPINNER = "spinner"
CUTS = ("cut 1", "cut 2")  # of a sector, the first behind the blade as it turns clockwise
DEFLECTION = 0.003  # m, of triangles
LOST = 1e-4  # of the volume, that fusing may be off by
Named = Sequence[tuple[str, Any, Any]]  # faces by name and colour


@dataclass(frozen=True, eq=False)
class RotorBody:
    """One solid of a rotor, or of its sector, and what was fused.

    Parameters
    ----------
    part : Part
        The solid [mm], its faces named: "blade 1 suction side", ..., "spinner".
    blades : int
        In it.
    blade_volume, spinner_volume, volume : float
        Of each blade and of the spinner before, and of the whole [m3].
    """

    part: Part
    blades: int
    blade_volume: float
    spinner_volume: float
    volume: float

    def __repr__(self) -> str:
        return f"<RotorBody {self.part.name}: {len(self.part.pieces)} faces, {self.volume:.6g} m3>"

    def __str__(self) -> str:
        return (
            f"{self.part.name}: one solid of {self.volume:.6g} m3; {self.overlap:.4g} m3 of it "
            "lay in two parts"
        )

    @property
    def overlap(self) -> float:
        """The volume that was in two parts at once [m3]."""
        return self.blades * self.blade_volume + self.spinner_volume - self.volume

    @property
    def figures(self) -> dict[str, Any]:
        """What a report says of it."""
        return {
            "regions": self.regions,
            "volume_m3": self.volume,
            "overlap_m3": self.overlap,
            "one_solid": True,
            "valid": True,
        }

    def write_step(self, path: Path, **options: Any) -> None:
        """Write it as STEP; options are those of `step_documents.write`."""
        step_documents.write(self.part, path, **options)

    @property
    def regions(self) -> tuple[str, ...]:
        """The names of its faces, each once."""
        return tuple(dict.fromkeys(name for name, *_ in self.part.pieces))

    def mesh(self, deflection: float = DEFLECTION) -> TriangleMesh:
        """Return its triangles [m], within about a deflection [m], by place in `regions`."""
        names, faces = zip(*((name, face) for name, face, _ in self.part.pieces), strict=True)
        made = welded(by_face(self.part.shape, faces, deflection))
        place = np.array([self.regions.index(name) for name in names])
        return replace(made, regions=place[made.regions])

    def write_regions(self, path: Path, deflection: float = DEFLECTION) -> None:
        """Write its triangles [m], within about a deflection [m], as STL, a solid a region."""
        text = stl_text(self.mesh(deflection), names=self.regions)
        path.write_text(text, encoding="ascii", newline="\n")


def fused(rotor: Rotor, solid: Solid) -> RotorBody:
    """Fuse a rotor's blades and its spinner into one solid.

    Raises
    ------
    CadError
        If OCCT makes anything but one valid solid of them.
    """
    name = f"{solid.name} rotor"
    return _fused(name, rotor, solid, rotor.blades, spinner(rotor.spinner_radius), ())


def sector(rotor: Rotor, solid: Solid) -> RotorBody:
    """Fuse the first blade and its share of the spinner, between two half planes through the axis.

    Both cuts are the same outline, turned by the sector's angle: sides of a cyclic domain fit.

    Raises
    ------
    CadError
        If the rotor has one blade, the blade leaves its sector, or OCCT fails.
    """
    if rotor.blades == 1:
        raise CadError(f"{solid.name}: a rotor of one blade has no sector; --rotor-as fused")
    half = np.pi / rotor.blades
    rotation, shift = (values[0] for values in rotor.placements())
    points = np.moveaxis(solid.net.poles, -1, 0).reshape(3, -1).T @ rotation.T + shift
    reach = float(np.max(np.abs(np.arctan2(points[:, 1], points[:, 2]))))
    if not reach < half:
        raise CadError(
            f"{solid.name}: the blade reaches {np.degrees(reach):.3g} deg to one side, allowed is "
            f"{np.degrees(half):.3g} in a sector of {rotor.blades} blades; --rotor-as fused, or "
            "another --hub-radius"
        )
    wedge = spinner(rotor.spinner_radius, angle=2.0 * half)
    return _fused(f"{solid.name} sector", rotor, solid, 1, wedge, CUTS)


def _fused(
    name: str, rotor: Rotor, solid: Solid, blades: int, hub: Any, cuts: tuple[str, ...]
) -> RotorBody:
    """Fuse some of a rotor's blades with a spinner, whose faces between its cuts go by its name."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse
    from OCP.TopTools import TopTools_ListOfShape

    blade = mirrored_part(solid.part) if rotor.mirrored else solid.part
    named: list[tuple[str, Any, Any]] = []
    tools = TopTools_ListOfShape()
    places = zip(range(1, blades + 1), *rotor.placements(), strict=False)
    for number, rotation, shift in places:
        place = location(rotation, shift)
        tools.Append(blade.shape.Moved(place))
        named += [(f"blade {number} {n}", f.Moved(place), colour) for n, f, colour in blade.pieces]
    named += [(word, face, None) for word, face in _spinner_faces(hub, cuts)]
    body, arguments = BRepAlgoAPI_Fuse(), TopTools_ListOfShape()
    arguments.Append(hub)
    body.SetArguments(arguments)
    body.SetTools(tools)
    body.SetNonDestructive(True)
    body.Build()
    made = members(body.Shape(), "solid") if body.IsDone() else []
    whole = made[0] if len(made) == 1 and is_valid(made[0]) else None
    before, own = solid.volume, volume(hub) / MILLIMETRES**3
    if whole is not None:
        part = Part(name, whole, _pieces(body, whole, named))
        result = RotorBody(part, blades, before, own, volume(whole) / MILLIMETRES**3)
        most = blades * before + own
        if -LOST * most < result.overlap < 0.5 * most:
            return result
    raise CadError(
        f"{name}: OCCT could not fuse blades and spinner into one valid solid; without --rotor-as "
        "they are written as an assembly"
    )


def _spinner_faces(hub: Any, cuts: tuple[str, ...]) -> list[tuple[str, Any]]:
    """Return a spinner's faces by name: its cuts, if it has any, and the others by its own."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    def across(face: Any) -> float:
        properties = GProp_GProps()
        BRepGProp.SurfaceProperties_s(face, properties)
        return float(properties.CentreOfMass().Y())

    faces = members(hub, "face")
    sides = sorted(filter(_is_cut, faces), key=across, reverse=True) if cuts else []
    others = [face for face in faces if not any(face.IsSame(side) for side in sides)]
    return [*zip(cuts, sides, strict=True), *((SPINNER, face) for face in others)]


def _is_cut(face: Any) -> bool:
    """Tell whether a face is a plane through the axis: its normal is normal to x."""
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.GeomAbs import GeomAbs_Plane
    from OCP.TopoDS import TopoDS

    surface = BRepAdaptor_Surface(TopoDS.Face_s(face))
    flat = surface.GetType() == GeomAbs_Plane
    return bool(flat and abs(surface.Plane().Axis().Direction().X()) < 0.5)


def _pieces(body: Any, whole: Any, named: Named) -> list[tuple[str, Any, Any]]:
    """Return the faces of a fused solid, looking outward, under the names of those before."""
    became = [
        (one, name, colour)
        for name, face, colour in named
        if not body.IsDeleted(face)
        for one in list(body.Modified(face)) or [face]
    ]
    faces = members(whole, "face")
    return [
        (name, face, colour) for one, name, colour in became for face in faces if face.IsSame(one)
    ]


MAKERS = {"fused": fused, "sector": sector}
