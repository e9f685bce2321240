"""Parts of the values that a `Blade` holds: under its own names, and changed by these."""

from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any

from bladegen.airfoils.landmarks import Contour
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.blade.changes.deformation import Deformation, Thickening
from bladegen.blade.lofting.edge_widths import Joining
from bladegen.blade.lofting.loft import Loft
from bladegen.blade.lofting.parameters import Parameter
from bladegen.blade.lofting.paths import Path, PathMaker
from bladegen.blade.planform import Planform, SectionPlanes
from bladegen.blade.shape import Shape
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.fair_planform import PlanformFairing
from bladegen.support.arrays import Array
from bladegen.support.values import Part

__all__ = ["composed"]

definition = Part[BladeDefinition]("planform.definition", "What the designer gave.")
planes = Part[SectionPlanes]("planform.planes", "Section planes.")
fair_planform = Part[PlanformFairing | None](
    "planform.fair_planform", "How far chord, twist, offsets and axis moved to be C2, if they did."
)
u = Part[Array]("shape.loft.u", "Landmark parameters (n,); 0.5 is the leading edge.")
eta = Part[Array]("shape.loft.eta", "Span fractions (s,) of the stations.")
representatives = Part[Array]("shape.loft.representatives", "Stations' bases (s, n, 2).")
M = Part[Array]("shape.loft.M", "Linear parts (s, 2, 2): airfoil = representatives @ M + b.")
b = Part[Array]("shape.loft.b", "Centres (s, 2) of the stations' airfoils [chord].")
path = Part[PathMaker]("shape.loft.path", "How stations are joined.")
edge_width = Part[Joining | None]("shape.loft.edge_width", "How edge widths are joined.")
contours = Part[tuple[Contour, ...] | None]("shape.loft.contours", "The faired airfoils.")
fairing = Part[float | None]("shape.loft.fairing", "How far airfoils may have moved [chord].")
splines = Part[SectionSplines]("shape.loft.splines", "Splines through its landmarks.")
parameter = Part[Parameter]("shape.loft.parameter", "The path's parameter over span.")
shape_path = Part[Path]("shape.loft.shape_path", "The path on Gr(n, 2) over `parameter`.")
points = Part[Array]("shape.points", "Stations' shapes on Gr(n, 2), deformed, (s, n, 2).")
shapes = Part[Callable[[Array], tuple[Array, Array, Array, Array]]](
    "shape.shapes", "Shapes (k, n, 2) at spans (k,), the same deformed, M and b."
)
wanted_thickness = Part[Callable[[Array], Array | None]](
    "shape.wanted_thickness", "The relative thickness that rules at spans (k,), if one does."
)
deformations = Part[tuple[Deformation, ...]]("shape.deformations", "What changed shapes.")
thickenings = Part[tuple[Thickening, ...]]("shape.thickenings", "Factors of the thickness.")


def composed(shape: Shape, planform: Planform, parts: dict[str, Any]) -> tuple[Shape, Planform]:
    """Return a shape and a planform with some of their parts changed.

    The definition's relative thickness rules in both.  What no part touches stays the same value,
    and keeps what it has computed.
    """
    kinds = [{entry.name for entry in fields(kind)} for kind in (Planform, Loft, Shape)]
    unknown = parts.keys() - set().union(*kinds)
    if unknown:
        raise TypeError(f"Blade() got an unexpected keyword argument {min(unknown)!r}")
    standing, joined, over = ({key: parts[key] for key in parts if key in own} for own in kinds)
    if standing:
        planform = replace(planform, **standing)
    thickness = planform.definition.relative_thickness
    if joined or thickness is not shape.loft.relative_thickness:
        over["loft"] = replace(shape.loft, **joined | {"relative_thickness": thickness})
    return replace(shape, **over) if over else shape, planform
