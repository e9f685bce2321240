"""Values as people write them: lengths (0.3mm, 2 mm, 0.002 m), coordinates (0.1,0,0,0@0.5)."""

import math
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from bladegen.blade.changes.deformation import Coordinates, Window
from bladegen.blade.edges import AsGiven, MinimumThickness, Sharp, TrailingEdge
from bladegen.blade.variants.designs import Design, tabulated
from bladegen.errors import BladegenError, DesignError, FileError
from bladegen.formats.common.text_file import decimal_of, delimiter_of, text_of
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arguments import suggestion
from bladegen.support.files import content_of

__all__ = [
    "coordinates",
    "factor_bounds",
    "factor_table",
    "finish",
    "metres",
    "radians",
    "share",
    "span_window",
    "suffixes",
]

MANIFEST = ("index", "name", "valid", "reason", "attempts", "seed", "volume_m3", "surface_m2")
FILES = ("_file", "_sha256", "_problem")
MAX_TABLE = 512 * 2**20  # bytes; a million variants of forty columns
_METRES = {"um": 1e-6, "mm": 1e-3, "cm": 1e-2, "m": 1.0}
_ANGLE = re.compile(r"\s*([-+]?[0-9]*\.?[0-9]+(?:[eE][-+]?[0-9]+)?)\s*(deg|°|rad)?\s*")
_LENGTH = re.compile(r"\s*([0-9]*\.?[0-9]+(?:[eE][-+]?[0-9]+)?)\s*(um|mm|cm|m)\s*")


def suffixes(texts: Sequence[str], known: Iterable[str], remark: str = "") -> tuple[str, ...]:
    """Return the suffixes that formats are asked for by, several in one text or in many.

    A remark ends the message if one is not known.

    Raises
    ------
    BladegenError
        If one is not known.

    >>> suffixes(["step,stl", ".GLB"], [".step", ".stl", ".glb"])
    ('step', 'stl', 'glb')
    """
    asked = [word for text in texts for word in re.split(r"[\s,;]+", text.lower()) if word]
    found = [word.lstrip(".") for word in asked]
    allowed = list(known)
    for word in found or [""]:
        if f".{word}" not in allowed:
            raise BladegenError(
                f"format: got {word!r}: no format has the suffix '.{word}', allowed are "
                f"{', '.join(allowed)}{suggestion(word, allowed, lambda name: name.lstrip('.'))}"
                f"{remark}"
            )
    return tuple(dict.fromkeys(found))


def metres(text: str, field: str, others: str = "", example: str = "0.3mm") -> float:
    """Return a length with its unit in metres.

    Raises
    ------
    BladegenError
        If there is no number or no unit.

    >>> metres("0.3mm", "tolerance")
    0.0003
    """
    match = _LENGTH.fullmatch(text)
    if match is None:
        raise BladegenError(
            f"{field}: got {text!r}, must be a length with its unit ({', '.join(_METRES)}), "
            f"such as {example}{others}{_near_length(text)}"
        )
    return float(f"{float(match[1]) * _METRES[match[2]]:.15g}")


def _near_length(text: str) -> str:
    """Return the length that a text may mean with decimal comma, capitals or a Greek letter."""
    near = text.replace(",", ".").replace("\u03bc", "u").replace("\u00b5", "u").lower()
    near = "".join(near.split())
    return f"; did you mean {near}?" if near != text and _LENGTH.fullmatch(near) else ""


def radians(text: str, field: str) -> float:
    """Return an angle in radians; a number without a unit is in degrees.

    Raises
    ------
    BladegenError
        If it is no angle.

    >>> round(radians("4deg", "precone"), 6)
    0.069813
    """
    match = _ANGLE.fullmatch(text)
    if match is None:
        raise BladegenError(
            f"{field}: got {text!r}, must be an angle in degrees (4, 4deg) or radians (0.07rad)"
        )
    value = float(match[1])
    return value if match[2] == "rad" else math.radians(value)


def finish(text: str, field: str = "trailing-edge") -> TrailingEdge:
    """Return the rule for trailing edges of a text: given, sharp, 2mm, or 2mm,1%.

    Raises
    ------
    BladegenError
        If it is none of these.

    >>> finish("2mm,1%")
    MinimumThickness(thickness=0.002, most=0.01)
    """
    if text.lower() in _NAMED:
        return _NAMED[text.lower()]
    length, comma, share = text.partition(",")
    if not comma or _near_length(text):
        return MinimumThickness(metres(text, field, ", given or sharp", "2mm"))
    match = _PER_CENT.fullmatch(share)
    if match is None or not 0 < float(match[1]) <= 100:
        raise BladegenError(
            f"{field}: got {text!r}, allowed are given, sharp, a length such as 2mm, or with the "
            "most of the local chord that it may be, 2mm,1%"
        )
    return MinimumThickness(metres(length, field, example="2mm"), float(match[1]) / 100.0)


_NAMED: dict[str, TrailingEdge] = {"given": AsGiven(), "sharp": Sharp()}
_PER_CENT = re.compile(r"\s*([0-9]*\.?[0-9]+)\s*%\s*")


def share(text: str, field: str) -> float:
    """Return a share of a text in per cent.

    >>> share("0.5%", "displacement")
    0.005
    """
    match = _PER_CENT.fullmatch(text)
    if match is None:
        raise BladegenError(f"{field}: got {text!r}, must be a share of the chord, such as 0.5%")
    return float(match[1]) / 100.0


def factor_bounds(texts: Sequence[str], field: str = "vary") -> dict[str, tuple[float, float]]:
    """Return bounds of factors from texts like ``thickness=0.9:1.1``; twist is in degrees.

    Raises
    ------
    BladegenError
        If a text is not of that form.

    >>> factor_bounds(["thickness=0.9:1.1"])
    {'thickness': (0.9, 1.1)}
    """
    bounds = {}
    for text in texts:
        name, _, limits = text.partition("=")
        try:
            values = [float(word) for word in limits.split(":")]
        except ValueError:
            values = []
        if len(values) != 2:
            raise BladegenError(
                f"{field}: got {text!r}, must be NAME=LOW:HIGH in numbers with decimal points, "
                "such as thickness=0.9:1.1, or twist=-2:2 in degrees"
            )
        low, high = np.radians(values) if name == "twist" else values
        bounds[name.strip()] = (float(low), float(high))
    return bounds


def factor_table(space: ShapeSpace | None, path: Path) -> Design:
    """Read a design from a CSV or Parquet file: a row a variant, a column a factor.

    Twist is in degrees, in the column twist_deg.  A CSV file has commas, or semicolons or tabs
    and then decimal points or commas, as spreadsheets write them.  Columns
    that a manifest has beside its factors are passed over, so that a manifest is a table too.

    Raises
    ------
    FileError
        If the file cannot be read, or holds what no design can be.
    """
    import pyarrow as pa
    from pyarrow import csv, parquet

    try:
        content = content_of(path, MAX_TABLE)
        if path.suffix.lower() == ".parquet":
            table = parquet.read_table(pa.BufferReader(content))
        else:
            text = text_of(content)
            mark = delimiter_of(text)
            table = csv.read_csv(
                pa.BufferReader(text.encode()),
                parse_options=csv.ParseOptions(delimiter=mark),
                convert_options=csv.ConvertOptions(decimal_point=decimal_of(text, mark)),
            )
        columns = {
            name: np.asarray(values.to_numpy(), dtype=np.float64)
            for name, values in zip(table.column_names, table.columns, strict=True)
            if not (name.startswith("section") or name in MANIFEST or name.endswith(FILES))
        }
        if "twist_deg" in columns:
            columns["twist"] = np.radians(columns.pop("twist_deg"))
        return tabulated(space, columns)
    except OSError as error:
        raise FileError(str(path), [f"not a table: {error}"]) from None
    except (pa.ArrowException, ValueError, TypeError) as error:
        first = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise FileError(str(path), [f"not a table of numbers: {first}"]) from None
    except DesignError as error:
        raise FileError(str(path), [str(error)]) from None


def coordinates(texts: Sequence[str]) -> Coordinates | None:
    """Return coordinates over span from texts like ``0.1,0,0,0`` or ``0.1,0,0,0@0.5``.

    Raises
    ------
    BladegenError
        If a text holds anything but numbers, or several are given and one has no ``@eta``.

    >>> coordinates(["0.1,0@0.5", "0,0@0.25"]).grid
    array([0.25, 0.5 ])
    """
    if not texts:
        return None
    rows = []
    for text in texts:
        values, _, place = text.partition("@")
        if len(texts) > 1 and not place:
            raise BladegenError(f"pga: got {text!r}, must end in @ETA where several are given")
        rows.append((_span(place) if place else 0.0, _numbers(values, "pga")))
    rows.sort(key=lambda row: row[0])
    if len({len(values) for _, values in rows}) > 1:
        counts = " and ".join(str(len(values)) for _, values in rows)
        raise BladegenError(f"pga: got {counts} coordinates, all must have the same number")
    return Coordinates(np.array([at for at, _ in rows]), np.array([values for _, values in rows]))


def _span(text: str) -> float:
    """Return the span fraction behind an @."""
    try:
        return float(text)
    except ValueError:
        raise BladegenError(
            f"pga: got {text!r} behind @, must be a span fraction from 0 (root) to 1 (tip), such "
            "as @0.5"
        ) from None


def span_window(text: str) -> Window:
    """Return a window over span from a text like ``0.1,0.3``.

    Raises
    ------
    BladegenError
        If it does not hold two span fractions that rise.
    """
    try:
        numbers = [float(word) for word in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != 2:
        raise BladegenError(
            f"window: got {text!r}, must be two span fractions from 0 (root) to 1 (tip) with a "
            "comma between, such as 0.1,0.3"
        )
    return Window(*numbers)


def _numbers(text: str, field: str) -> list[float]:
    try:
        values = [float(word) for word in text.split(",")]
        if all(map(math.isfinite, values)):
            return values
        raise ValueError
    except ValueError:
        raise BladegenError(
            f"{field}: got {text!r}, must be numbers with commas between, such as 0.1,0,0,0"
        ) from None
