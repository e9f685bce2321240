"""A blade put back into a full turbine file, everything else of which stays as it is.

The file is read twice: by bladegen's own parser, which bounds its size, depth and aliases, and
then by ruamel.yaml, which keeps order, comments and anchors on writing (`round_trip`).  Only the
outer shape, the reference axis and the airfoils that the blade names are changed, member by
member, so that what stands beside them (structure, polars of other airfoils, control) is the same
document.
"""

import math
from collections.abc import Callable, Iterator, Mapping, MutableMapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.definition.blade_definition import Airfoil, BladeDefinition
from bladegen.errors import FileError, Finding
from bladegen.formats.common.document import Node, Notes
from bladegen.formats.common.polars import polars as read_polars
from bladegen.formats.windio import turbine_file
from bladegen.formats.windio.round_trip import flow, round_trip
from bladegen.formats.windio.writing import Document
from bladegen.formats.windio.yaml_file import YamlError, load_yaml
from bladegen.support.files import replacing

__all__ = ["write_into_turbine"]

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


def write_into_turbine(
    definition: BladeDefinition, turbine: Path, path: Path
) -> tuple[Finding, ...]:
    """Write a windIO turbine file with its blade replaced, in the version that it is in.

    Parameters
    ----------
    definition : BladeDefinition
        The blade.
    turbine : Path
        The full turbine file.
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
    """
    try:
        plain, _ = load_yaml(turbine)
    except YamlError as error:
        raise FileError(str(turbine), [str(error)]) from None
    found = [version for version in turbine_file.VERSIONS if version.recognises(plain)]
    if not found or not isinstance(plain, Mapping):
        raise FileError(str(turbine), [f"holds no blade, must hold {turbine_file.MARK}"])
    findings: list[Finding] = []
    plainly = replace(definition, structure=None)  # that of the turbine file stays
    new = found[0].document(plainly, lambda w, said: findings.append(Finding(w, said)))
    findings = [finding for finding in findings if finding.where.split(".")[0] not in ROTOR]
    yaml, full = round_trip(turbine)
    blade = _member(full, ("components", "blade"), turbine)
    changed = [
        name
        for key, value in new["components"]["blade"].items()
        for name in _merge(blade, key, value)
    ]
    said = [*_airfoils(full, new["airfoils"], turbine, found[0].polars)]
    findings += said
    asked = _configurations(full, new)
    unchanged = not (changed or said)
    findings += _doubts(plain, full, changed, unchanged=unchanged)
    own = turbine.read_bytes() if unchanged and not asked else None
    with replacing(path) as temporary:
        if own is not None:  # a dump would rename anchors that stand twice
            temporary.write_bytes(own)
        else:
            with temporary.open("w", encoding="utf-8") as stream:
                yaml.dump(full, stream)
    return tuple(findings)


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
            holder[key] = flow(value)
            yield key
    elif not _same(old, value):
        made = flow(value)
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
            entries.append(flow(airfoil))
            added.append(airfoil["name"])
        elif not _near(entry.get("coordinates"), airfoil["coordinates"]):
            entry.update({key: flow(value) for key, value in airfoil.items()})
            whole = "polars and all" if "polars" in airfoil else "its polars kept"
            yield Finding(
                f"airfoil {airfoil['name']}",
                f"the turbine file has another of that name; replaced, {whole}",
            )
        elif "polars" in airfoil and not _same(_read(entry, polars), airfoil["polars"]):
            for part in KEYS_OF_POLARS.intersection(airfoil):
                entry[part] = flow(airfoil[part])
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


def _configurations(full: Any, new: Document) -> bool:
    """Let the schedule ask for polars that its airfoils have: WISDEM stops at any other.

    Returns whether that changed it.
    """
    changed = False
    shape = new["components"]["blade"].get("outer_shape", {})
    wanted = {entry["name"]: entry for entry in shape.get("airfoils", [])}
    known = {a.get("name"): a.get("polars") for a in full["airfoils"] if isinstance(a, Mapping)}
    for entry in full["components"]["blade"].get("outer_shape", {}).get("airfoils", []):
        own = known.get(entry["name"]) or []
        names = [polar.get("configuration") for polar in own if isinstance(polar, Mapping)]
        ours = wanted.get(entry["name"], {})
        if "configuration" in ours and not set(entry.get("configuration", [None])) <= set(names):
            entry |= {key: flow(ours[key]) for key in ("configuration", "weight")}
            changed = True
    return changed


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
