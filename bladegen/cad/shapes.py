"""What OCCT's shapes measure, in millimetres: volume, area, and whether they are sound."""

from typing import Any

__all__ = ["MILLIMETRES", "area", "bodies", "is_valid", "members", "quick_volume", "volume"]

MILLIMETRES = 1000.0
VOLUME_TOLERANCE = 1e-8  # relative, by OCCT's own estimate, which is optimistic: right to 1e-6
AREA_TOLERANCE = 1e-6  # relative
QUICK_VOLUME = 1e-3  # relative, as asked of OCCT


def members(shape: Any, kind: str, *, outside: str = "shape") -> list[Any]:
    """Return a shape's members of a kind ("solid", "shell", "face"), none inside of another's."""
    from OCP import TopAbs
    from OCP.TopExp import TopExp_Explorer

    kinds = (getattr(TopAbs, f"TopAbs_{name.upper()}") for name in (kind, outside))
    explorer, found = TopExp_Explorer(shape, *kinds), []
    while explorer.More():
        found.append(explorer.Current())
        explorer.Next()
    return found


def bodies(shape: Any) -> tuple[Any, int]:
    """Return the solids of a shape, without sheets beside them, and how many of these there are.

    A shape without solids is returned as it is.
    """
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Compound

    solids = members(shape, "solid")
    sheets = members(shape, "shell", outside="solid") if solids else []
    if not sheets:
        return shape, 0
    compound, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(compound)
    for one in solids:
        builder.Add(compound, one)
    return compound, len(sheets)


def volume(shape: Any) -> float:
    """Return a shape's volume [mm3], by OCCT's Gauss-Kronrod quadrature of every knot span.

    The volume of a blade is right to 1e-6; `Solid.volume` is exact.
    """
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    options = {"OnlyClosed": False, "IsUseSpan": True}
    BRepGProp.VolumePropertiesGK_s(shape, properties, VOLUME_TOLERANCE, **options)
    return float(properties.Mass())


def quick_volume(shape: Any) -> float:
    """Return a shape's volume [mm3] a hundred times faster: to compare a shape with its copy.

    Twisted blades are off by up to a tenth, the same for the same shape.
    """
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties, QUICK_VOLUME, False, False)
    return float(properties.Mass())


def area(shape: Any) -> float:
    """Return a shape's surface area [mm2]."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(shape, properties, AREA_TOLERANCE, False)
    return float(properties.Mass())


def is_valid(shape: Any) -> bool:
    """Tell whether OCCT finds no fault with a shape's topology and geometry."""
    from OCP.BRepCheck import BRepCheck_Analyzer

    return bool(BRepCheck_Analyzer(shape).IsValid())
