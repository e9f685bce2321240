"""A blade put back into a full turbine file, everything else of which stays as it is.

The file is read twice: by bladegen's own parser, which bounds its size, depth and aliases, and
then by ruamel.yaml, which keeps order, comments and anchors on writing.  Only the outer shape, the
reference axis and the airfoils that the blade names are changed, member by member, so that what
stands beside them (structure, polars of other airfoils, control) is the same document.
"""

import math
import re
from collections.abc import Callable, Iterator, Mapping, MutableMapping
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.definition.blade_definition import Airfoil, BladeDefinition
from bladegen.errors import FileError, Finding
from bladegen.formats.common.document import Node, Notes
from bladegen.formats.common.polars import polars as read_polars
from bladegen.formats.hawc2.into import write_into_htc
from bladegen.formats.openfast.into import write_into_main
from bladegen.formats.proof import GRID, WHOLE, put_in_place, read_back, taken_back
from bladegen.formats.windio import turbine_file
from bladegen.formats.windio import writing1 as windio1
from bladegen.formats.windio import writing2 as windio2
from bladegen.formats.windio.writing import Document
from bladegen.formats.windio.yaml_file import YamlError, load_yaml
from bladegen.support.files import replacing, require_suffix

__all__ = ["write_into"]

WRITERS = {"windIO 2": windio2, "windIO 1": windio1}
OTHERS = {".dat": write_into_main, ".htc": write_into_htc}
YAML = (".yaml", ".yml")
ROTOR = ("assembly", "hub", "drivetrain", "nacelle")
RIVALS = frozenset(  # members of the outer shape that say the same as others, or of the old blade
    {
        "pitch_axis",
        "section_offset_x",
        "section_offset_y",
        "rthick",
        "relative_thickness",
        "surface",
    }
)
PLACE = ("name", "spanwise_position")
KEYS_OF_POLARS = frozenset({"polars", "aerodynamic_center"})
NOWHERE = np.array([[1.0, 0.0], [0.0, 0.0], [1.0, 0.0]])  # a shape, where only polars are asked for
ROUNDING = 1e-14  # relative, of degrees to radians and back
FLOAT = "tag:yaml.org,2002:float"
WIDE = 1_000_000  # characters of a line, so that lists stay on theirs


def write_into(definition: BladeDefinition, turbine: Path, path: Path) -> tuple[Finding, ...]:
    """Write a turbine file with its blade replaced, in the windIO version that it is in.

    AeroDyn's main input and an htc file of HAWC2 are turbine files too, as OTHERS has them.

    Parameters
    ----------
    definition : BladeDefinition
        The blade.
    turbine : Path
        The full turbine file of windIO, AeroDyn's main input (.dat), or an htc file.
    path : Path
        Where to; may be `turbine` itself.

    Returns
    -------
    tuple of Finding
        What the version cannot hold, and what of the turbine may no longer fit the blade.

    Raises
    ------
    FileError
        If the turbine file cannot be read or holds no blade.
    ExportError
        If the file with the blade in it cannot be read, by what was wrong before or else.
    """
    own = turbine.suffix.lower()
    require_suffix(path, YAML if own in YAML else (own,))
    other = OTHERS.get(own)
    if other is not None:
        with taken_back(path):
            said = other(definition, turbine, path)
            partly = any(finding.where == "aero" for finding in said)
            if partly or path.parent.resolve() != turbine.parent.resolve():
                return said  # names lead to files that are elsewhere
            return said + read_back(path, path, definition, GRID)
    with put_in_place(path) as draft:
        said = _into_yaml(definition, turbine, draft)
        return said + read_back(draft, path, definition, WHOLE, turbine)


def _into_yaml(definition: BladeDefinition, turbine: Path, path: Path) -> tuple[Finding, ...]:
    """Write a windIO turbine file with its blade replaced."""
    try:
        plain, _ = load_yaml(turbine)
    except YamlError as error:
        raise FileError(str(turbine), [str(error)]) from None
    found = [v.name for v in turbine_file.VERSIONS if v.recognises(plain)]
    if not found or not isinstance(plain, Mapping):
        raise FileError(str(turbine), [f"holds no blade, must hold {turbine_file.MARK}"])
    findings: list[Finding] = []
    writer: Any = WRITERS[found[0]]
    new = writer.document(definition, lambda w, said: findings.append(Finding(w, said)))
    findings = [finding for finding in findings if finding.where.split(".")[0] not in ROTOR]
    yaml, full = _round_trip(turbine)
    blade = _member(full, ("components", "blade"), turbine)
    changed = [
        name
        for key, value in new["components"]["blade"].items()
        for name in _merge(blade, key, value)
    ]
    said = [*_airfoils(full, new["airfoils"], turbine, writer.polars)]
    findings += said
    _configurations(full, new)
    findings += _doubts(plain, full, changed, unchanged=not (changed or said))
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8") as stream:
        yaml.dump(full, stream)
    return tuple(findings)


def _round_trip(path: Path) -> tuple[Any, Any]:
    """Return a parser that makes plain data and keeps what it reads, and what it read."""
    from ruamel.yaml import YAML
    from ruamel.yaml.constructor import RoundTripConstructor
    from ruamel.yaml.error import YAMLError
    from ruamel.yaml.representer import RoundTripRepresenter

    class Constructor(RoundTripConstructor):
        pass

    class Representer(RoundTripRepresenter):
        pass

    Constructor.add_constructor(FLOAT, lambda _, node: _Written(node.value, node.anchor))
    Representer.add_representer(_Written, _Written.represented)
    yaml = YAML(typ="rt")
    yaml.Constructor, yaml.Representer = Constructor, Representer
    yaml.preserve_quotes = True
    yaml.width = WIDE
    text = path.read_text(encoding="utf-8")
    yaml.allow_unicode = not text.isascii()  # characters that the file escapes stay escaped
    yaml.indent(**_indents(text))
    try:
        return yaml, yaml.load(text)
    except (YAMLError, ValueError) as error:
        said = " ".join(str(error).split())
        raise FileError(str(path), [f"cannot be kept as it is: {said}"]) from None


class _Written(float):
    """A number with the text it was written as: ruamel.yaml's own may lose its last digit."""

    text: str
    anchor: str | None

    def __new__(cls, text: str, anchor: str | None) -> "_Written":
        made = super().__new__(cls, _value(text))
        made.text, made.anchor = text, anchor
        return made

    @staticmethod
    def represented(representer: Any, number: "_Written") -> Any:
        return representer.represent_scalar(FLOAT, number.text, anchor=number.anchor)


def _value(text: str) -> float:
    """Return the value of a float of YAML 1.2; infinities and not-a-number have a dot there."""
    return float(re.sub(r"\.(?=inf|nan)", "", text.lower()))


def _indents(text: str) -> dict[str, int]:
    """Return how far a text indents mappings, and lists and their dashes."""
    found = {"mapping": 2, "sequence": 2, "offset": 0}
    key = re.search(r"^\w[^\n]*:[ ]*\n( +)\w", text, re.MULTILINE)
    if key:
        found["mapping"] = len(key[1])
    dash = re.search(r"^( *)\w[^\n:]*:[ ]*\n( *)-( +)\w", text, re.MULTILINE)
    if dash:
        found["offset"] = len(dash[2]) - len(dash[1])
        found["sequence"] = found["offset"] + 1 + len(dash[3])
    return found


def _member(full: Any, keys: tuple[str, ...], turbine: Path) -> Any:
    for key in keys:
        full = full.get(key) if isinstance(full, Mapping) else None
    if not isinstance(full, MutableMapping):
        raise FileError(str(turbine), [f"{'.'.join(keys)}: is missing, must be a mapping"])
    return full


def _merge(holder: Any, key: str, value: Any) -> Iterator[str]:
    """Replace a member of a mapping, mappings within it member by member; say which changed.

    Curves are replaced whole: an alias elsewhere may share the mapping, and must keep it.
    """
    old = holder.get(key)
    if isinstance(old, MutableMapping) and isinstance(value, dict) and "grid" not in value:
        for inner, part in value.items():
            yield from (f"{key}.{name}" for name in _merge(old, inner, part))
        for other in RIVALS.intersection(old).difference(value):
            del old[other]
            yield f"{key}.{other}"
    elif key == "airfoils" and isinstance(old, list):
        kept: dict[Any, Any] = {e.get("name"): e for e in old if isinstance(e, Mapping)}
        value = [{**kept.get(entry["name"], {}), **_position(entry, kept)} for entry in value]
        if not _same(old, value):
            holder[key] = _flow(value)
            yield key
    elif not _same(old, value):
        made = _flow(value)
        if isinstance(old, Mapping) and _same(old.get("grid"), value["grid"]):
            made["grid"] = old["grid"]
        holder[key] = made
        yield key


def _position(entry: Document, kept: Mapping[Any, Any]) -> Document:
    """Return what an entry of the schedule changes: not which polars the file asks for."""
    known = entry["name"] in kept
    return {key: value for key, value in entry.items() if not known or key in PLACE}


def _same(old: Any, new: Any) -> bool:
    """Tell whether two values are the same plain data, numbers up to their rounding."""
    if isinstance(old, Mapping) and isinstance(new, Mapping):
        return set(old) == set(new) and all(_same(old[key], new[key]) for key in new)
    if isinstance(old, list) and isinstance(new, list):
        return len(old) == len(new) and all(map(_same, old, new))
    if isinstance(old, float | int) and isinstance(new, float | int):
        return math.isclose(old, new, rel_tol=ROUNDING, abs_tol=ROUNDING)
    return bool(old == new)


def _flow(value: Any) -> Any:
    """Return a value for ruamel.yaml, lists of numbers on one line."""
    from ruamel.yaml.comments import CommentedMap, CommentedSeq

    if isinstance(value, dict):
        return CommentedMap((key, _flow(part)) for key, part in value.items())
    if isinstance(value, list):
        made = CommentedSeq(_flow(part) for part in value)
        if not any(isinstance(part, dict | list) for part in value):
            made.fa.set_flow_style()
        return made
    return value


def _airfoils(
    full: Any, new: list[Document], turbine: Path, polars: Callable[[Airfoil], list[Document]]
) -> Iterator[Finding]:
    """Put airfoils into the file's list: those it has, where they changed; others added."""
    entries = full.get("airfoils")
    if not isinstance(entries, list):
        raise FileError(str(turbine), ["airfoils: is missing, must be a list"])
    known: dict[Any, Any] = {e.get("name"): e for e in entries if isinstance(e, Mapping)}
    added, updated = [], []
    for airfoil in new:
        entry = known.get(airfoil["name"])
        if entry is None:
            entries.append(_flow(airfoil))
            added.append(airfoil["name"])
        elif not _near(entry.get("coordinates"), airfoil["coordinates"]):
            entry.update({key: _flow(value) for key, value in airfoil.items()})
            whole = "polars and all" if "polars" in airfoil else "its polars kept"
            yield Finding(
                f"airfoil {airfoil['name']}",
                f"the turbine file has another of that name; replaced, {whole}",
            )
        elif "polars" in airfoil and not _same(_read(entry, polars), airfoil["polars"]):
            for part in KEYS_OF_POLARS.intersection(airfoil):
                entry[part] = _flow(airfoil[part])
            updated.append(airfoil["name"])
    for names, done in ((added, "added"), (updated, "get other polars, their shapes as they were")):
        if names:
            yield Finding("airfoils", f"{len(names)} {done}: {_first(names)}")


def _first(names: list[str]) -> str:
    """Return the first three of some names, and how many more there are."""
    return ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")


def _read(entry: Any, polars: Callable[[Airfoil], list[Document]]) -> list[Document]:
    """Return the polars of an entry of the file as they would be written."""
    known = Airfoil("read", NOWHERE, polars=read_polars(Node(entry, "", Notes())))
    return polars(known)


def _configurations(full: Any, new: Document) -> None:
    """Let the schedule ask for polars that its airfoils have: WISDEM stops at any other."""
    shape = new["components"]["blade"].get("outer_shape", {})
    wanted = {entry["name"]: entry for entry in shape.get("airfoils", [])}
    known = {a.get("name"): a.get("polars") for a in full["airfoils"] if isinstance(a, Mapping)}
    for entry in full["components"]["blade"].get("outer_shape", {}).get("airfoils", []):
        own = known.get(entry["name"]) or []
        names = [polar.get("configuration") for polar in own if isinstance(polar, Mapping)]
        ours = wanted.get(entry["name"], {})
        if "configuration" in ours and not set(entry.get("configuration", [None])) <= set(names):
            entry |= {key: _flow(ours[key]) for key in ("configuration", "weight")}


def _near(old: Any, new: Document) -> bool:
    """Tell whether coordinates are those of the file, repeated points apart."""
    if not isinstance(old, Mapping):
        return False
    try:
        xy = np.array([old["x"], old["y"]], dtype=np.float64).T
    except (KeyError, TypeError, ValueError):
        return False
    kept = np.concatenate([[True], np.any(np.abs(np.diff(xy, axis=0)) > 1e-9, axis=1)])
    return np.array_equal(xy[kept], np.array([new["x"], new["y"]]).T)


def _doubts(
    plain: Mapping[str, Any], full: Any, changed: list[str], *, unchanged: bool
) -> Iterator[Finding]:
    """Say what was replaced, and what of the turbine was made for the blade before."""
    blade = plain["components"]["blade"]
    if unchanged:
        yield Finding("turbine file", "this is the blade that it holds; nothing replaced")
        return
    if changed:
        yield Finding("replaced", ", ".join(changed))
    yield Finding(
        "turbine file",
        "all else, order, comments and anchors kept, but for comments inside what was replaced",
    )
    bare = _without_polars(full)
    if bare:
        yield Finding(
            "polars",
            f"none for {len(bare)} airfoils of the blade, without which WISDEM stops "
            f"({_first(bare)}); --polars estimate makes some",
        )
    shape = blade.get("outer_shape")
    if isinstance(shape, Mapping) and "surface" in shape:
        yield Finding("outer_shape.surface", "was of the blade before; left out")
    parts = [
        key for key in blade if key not in ("reference_axis", "outer_shape", "outer_shape_bem")
    ]
    if parts:
        yield Finding(
            "components.blade",
            f"kept: {', '.join(parts)}, made for the blade before",
        )


def _without_polars(full: Any) -> list[str]:
    """Return the names of the blade's airfoils that have no polars."""
    blade = full["components"]["blade"]
    if "outer_shape" in blade:
        names = [entry["name"] for entry in blade["outer_shape"]["airfoils"]]
    else:
        names = blade["outer_shape_bem"]["airfoil_position"]["labels"]
    bare = {a["name"] for a in full["airfoils"] if isinstance(a, Mapping) and not a.get("polars")}
    return [name for name in dict.fromkeys(names) if name in bare]
