"""What the title of a column in a spanwise table stands for: its quantity and its unit."""

import math
import re
from dataclasses import dataclass

from bladegen.errors import Finding
from bladegen.formats.common.document import Range

__all__ = ["UNITS", "named", "with_unit"]

LENGTHS = {
    **dict.fromkeys(("m", "meter", "meters", "metre", "metres"), 1.0),
    **dict.fromkeys(("mm", "millimeter", "millimeters", "millimetre", "millimetres"), 1e-3),
    **dict.fromkeys(("cm", "centimeter", "centimeters", "centimetre", "centimetres"), 1e-2),
    **dict.fromkeys(("in", "inch", "inches"), 0.0254),
    **dict.fromkeys(("ft", "foot", "feet"), 0.3048),
}
ANGLES = {
    **dict.fromkeys(("deg", "degs", "degree", "degrees", "°"), math.pi / 180.0),
    **dict.fromkeys(("rad", "radian", "radians"), 1.0),
}
RATIOS = {
    **dict.fromkeys(("-", "--", "1", "x/c", "t/c", "r/r", "z/l", "frac", "fraction"), 1.0),
    **dict.fromkeys(("of chord", "chord", "chords", "c", "/c"), 1.0),
    **dict.fromkeys(("%", "percent", "per cent", "pct"), 0.01),
    **dict.fromkeys(("% chord", "%chord", "% of chord", "%c", "% c", "percent chord"), 0.01),
}


@dataclass(frozen=True)
class Field:
    """A quantity that a table may hold: its spellings, its units, what it may be in SI units."""

    key: str
    names: tuple[str, ...]
    units: dict[str, float]
    usual: str
    allowed: Range


FIELDS = (
    Field(
        "eta",
        (
            "eta",
            "r r",
            "z l",
            "span fraction",
            "spanwise position",
            "normalized span",
            "normalised span",
            "blfract",
            "grid",
            "span",
        ),
        RATIOS,
        "-",
        Range(-1e-6, 1.0 + 1e-6, "(root to tip)"),
    ),
    Field(
        "z",
        ("z", "span", "radius", "r", "blspn", "spanwise position", "distance from root", "rnodes"),
        LENGTHS,
        "m",
        Range(-1000.0, 1000.0, "m"),
    ),
    Field("chord", ("chord", "c", "blchord"), LENGTHS, "m", Range(0.0, 100.0, "m", above=True)),
    Field(
        "twist",
        ("twist", "bltwist", "twist angle", "aerodynamic twist", "aerotwst", "theta"),
        ANGLES,
        "deg",
        Range(-math.pi / 2, math.pi / 2, "rad"),
    ),
    Field(
        "rthick",
        ("rthick", "relative thickness", "t c", "tc", "thickness", "thickness to chord"),
        RATIOS,
        "-",
        Range(0.0, 1.05, "of the chord", above=True),
    ),
    Field(
        "thickness",
        ("thickness", "absolute thickness"),
        LENGTHS,
        "m",
        Range(0.0, 100.0, "m", above=True),
    ),
    Field(
        "prebend",
        ("prebend", "pre bend", "precurve", "prebend x", "x"),
        LENGTHS,
        "m",
        Range(-1000.0, 1000.0, "m"),
    ),
    Field(
        "sweep",
        ("sweep", "presweep", "pre sweep", "sweep y", "y"),
        LENGTHS,
        "m",
        Range(-1000.0, 1000.0, "m"),
    ),
    Field(
        "pitch_axis",
        ("pitch axis", "pitchaxis", "pitch axis xc", "chord offset", "xoffset"),
        RATIOS,
        "-",
        Range(-1.0, 2.0, "of the chord"),
    ),
    Field("offset_y", ("section offset y", "offset y"), LENGTHS, "m", Range(-1000.0, 1000.0, "m")),
    Field("offset_x", ("section offset x", "offset x"), LENGTHS, "m", Range(-1000.0, 1000.0, "m")),
)
TEXT_NAMES = ("airfoil", "airfoil name", "airfoils", "profile", "airfoil id")
UNITS = {*LENGTHS, *ANGLES, *RATIOS}
ENDINGS = {*LENGTHS, *ANGLES, "frac", "fraction", "percent", "pct"} - {"in"}  # of a name
_BRACKETS = re.compile(r"^(.*?)[\[(]\s*([^\])]*?)\s*[\])]\s*$")


def with_unit(title: str, unit: str | None) -> str:
    """Return a title with the unit that stands below it, if it has none of its own."""
    if unit is None or not title.strip() or _BRACKETS.match(title):
        return title
    return f"{title.strip()} [{unit}]"


def named(title: str, said: list[Finding], at: int) -> tuple[str, str, float, Range] | None:
    """Tell what a column's title stands for."""
    match = _BRACKETS.match(title)
    name, unit = (match[1], match[2].lower()) if match else (title, None)
    if unit is None and name.rstrip().endswith(("%", "°")):
        unit = name.rstrip()[-1]
    words = re.sub(r"[^a-z0-9]+", " ", name.lower()).split()
    if unit is None and len(words) > 1 and words[-1] in ENDINGS:
        unit, words = words[-1], words[:-1]
    if len(words) > 1 and words[-1] == "in":  # chord in mm
        words = words[:-1]
    unit = unit if unit is None else unit.rstrip(".")
    plain = " ".join(words)
    if plain in TEXT_NAMES:
        return "airfoil", title.strip(), 1.0, Range(0.0, 0.0)
    fields = [field for field in FIELDS if plain in field.names]
    if not fields:
        return None
    if unit is not None and unit not in UNITS:
        said.append(Finding(f"row {at}", f"{title!r}: unit {unit!r} is not known; passed over"))
        return None
    for field in fields:
        if unit is not None and unit in field.units:
            return field.key, title.strip(), field.units[unit], field.allowed
    if unit is not None:
        said.append(Finding(f"row {at}", f"{title!r}: no quantity in {unit!r}; passed over"))
        return None
    field = fields[0]
    if field.usual != "-":
        said.append(Finding(f"row {at}", f"{title!r} names no unit; taken as {field.usual}"))
    return field.key, title.strip(), field.units[field.usual], field.allowed
