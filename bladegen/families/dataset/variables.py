"""What a family's dataset holds: variables, their dimensions, units and meaning.

Each is a column of the manifest under the name that a dataset gives it.  Parameters that share
their name with a distribution over span (thickness, camber, chord, twist) end in ``_change``.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from bladegen.curves import polygons
from bladegen.families.conditions import called
from bladegen.families.labels.figures import FIGURES
from bladegen.measures.spanwise import UNITS

__all__ = ["COORDINATES", "Variable", "parameter", "variables"]

COORDINATES = ("variant", "name", "eta", "u")  # beside those of dimensions
ONE = "1"
MEANING = {
    "area": "area of the section",
    "centroid_x": "centroid of the section, along the chord from the leading edge",
    "centroid_y": "centroid of the section, normal to the chord",
    "inertia_xx": "second moment of area about the centroid, integral of y^2",
    "inertia_yy": "second moment of area about the centroid, integral of x^2",
    "inertia_xy": "product moment of area about the centroid",
    "perimeter": "length around the section",
}


@dataclass(frozen=True)
class Variable:
    """One variable of a dataset.

    Parameters
    ----------
    name : str
        In the dataset.
    column : str
        In the manifest.
    dims : tuple of str
        Its dimensions.
    long_name : str
        What it is.
    units : str
        As CF and UDUNITS spell them; "" for texts and flags.
    """

    name: str
    column: str
    dims: tuple[str, ...]
    long_name: str
    units: str = ""

    @property
    def attributes(self) -> dict[str, str]:
        """What the array says of itself."""
        said = {"long_name": self.long_name}
        return said | {"units": self.units} if self.units else said


FLAT = (
    Variable("variant", "index", ("variant",), "place of the variant in its family", ONE),
    Variable("name", "name", ("variant",), "name of the variant"),
    Variable("valid", "valid", ("variant",), "whether all sections are sound"),
    Variable("reason", "reason", ("variant",), "what is not sound"),
    Variable("attempts", "attempts", ("variant",), "how many draws it took", ONE),
    Variable("volume", "volume_m3", ("variant",), "volume within the skin", "m3"),
    Variable(
        "surface",
        "surface_m2",
        ("variant",),
        "area of the skin and of root and tip",
        "m2",
    ),
    Variable("sections_sha256", "sections_sha256", ("variant",), "SHA-256 of the sections"),
)
SPANWISE = (
    Variable("chord", "section_chord_m", ("variant", "span"), "chord", "m"),
    Variable(
        "twist",
        "section_twist_deg",
        ("variant", "span"),
        "twist, positive moves the leading edge upwind",
        "degree",
    ),
    Variable(
        "thickness",
        "section_relative_thickness",
        ("variant", "span"),
        "largest thickness over chord",
        ONE,
    ),
    *(
        Variable(
            name, f"section_{name}_{UNITS[name]}", ("variant", "span"), MEANING[name], UNITS[name]
        )
        for name in polygons.MEASURES
    ),
)

LABELLED = tuple(
    Variable(one.name, one.name, ("variant", *one.dims), one.long_name, one.units)
    for figures in FIGURES.values()
    for one in figures
)


def parameter(factor: str) -> Variable:
    """Return the variable of a factor of the design."""
    dims = ("variant",)
    if factor == "twist":
        return Variable(called(factor), "twist_deg", dims, "change of twist", "degree")
    if called(factor) != factor:
        return Variable(called(factor), factor, dims, f"factor of {factor}", ONE)
    if factor.startswith("t") and factor[1:].isdigit():
        said = f"normal coordinate along principal geodesic {factor[1:]}"
        return Variable(factor, factor, dims, said, "radian")
    return Variable(factor, factor, dims, f"factor of {factor.replace('_', ' ')}", ONE)


def variables(columns: Sequence[str], factors: Sequence[str]) -> list[Variable]:
    """Return the variables of a family whose manifest has some columns."""
    own = [*FLAT, *map(parameter, factors), *SPANWISE, *LABELLED]
    known = {one.column for one in own} | {"seed"}
    files = [
        Variable(name, name, ("variant",), _of_file(name)) for name in columns if name not in known
    ]
    return [one for one in own if one.column in columns] + files


def _of_file(column: str) -> str:
    """Say what a column of the variants' own files holds."""
    kind, _, what = column.rpartition("_")
    words = {
        "file": "file",
        "sha256": "SHA-256 of the file",
        "problem": "what is wrong with the file",
    }
    return f"{words.get(what, what)}, {kind}"
