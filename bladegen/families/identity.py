"""What a family is, as text: two families with the same identity hold the same blades.

An identity is a flat table of what a run was asked for and of fingerprints of what it was given;
it stands in `family.json` and is compared before a run goes on.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.variants.designs import Design
from bladegen.errors import FamilyError
from bladegen.exports.provenance import fingerprint
from bladegen.families.family import Family
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arrays import Array
from bladegen.version import __version__

__all__ = ["fingerprint", "identity", "require_current", "require_same"]

FEW = 64  # variants of a plan of any length that tell whether libraries draw as they did


def identity(family: Family) -> dict[str, Any]:
    """Return what a family is: JSON values only."""
    blade, design = family.blade, family.design
    return {
        "bladegen": __version__,
        "blade": blade.name,
        "blade_fingerprint": _blade(blade),
        "space_fingerprint": None if family.space is None else _space(family.space),
        "landmarks": len(blade.u),
        "design": design.kind,
        "seed": design.seed,
        "count": len(design),
        "factors": {
            name: [float(low), float(high)]
            for name, low, high in zip(
                design.what.names, design.what.low, design.what.high, strict=True
            )
        },
        "design_fingerprint": fingerprint(_first(design)),
        "window": [family.window.start, family.window.end],
        "chord_line": family.chord_line,
        "allow_extrapolation": family.allow_extrapolation,
        "allow_odd": family.allow_odd,
        "spans": len(family.eta),
        "invalid": family.invalid,
        "tries": family.tries,
        "thinnest": family.thinnest,
        **({"where": family.where} if family.where else {}),
    }


def _first(design: Design) -> Array:
    """Return where variants of a design lie: all of a table, the first ones of what is drawn."""
    return (
        design.values if design.table is not None else design.at(np.arange(min(FEW, len(design))))
    )


def _space(space: ShapeSpace) -> str:
    return fingerprint([space.u, space.mean, space.modes, space.coordinates])


def _blade(blade: Blade) -> str:
    """Fingerprint what a blade is made from: its definition, not what follows from it."""
    deformations = [
        [_space(one.space), one.t, one.window, one.chord_line] for one in blade.deformations
    ]
    return fingerprint(
        [
            blade.definition,
            blade.u,
            blade.path,
            blade.planes,
            blade.trailing_edge,
            deformations,
            blade.thickenings,
        ]
    )


def require_current(path: Path, found: dict[str, Any]) -> None:
    """Raise if a family was made by version 1, whose blades are others.

    Raises
    ------
    FamilyError
        That says what can still be done with it.
    """
    if found and "chord_line" not in found:  # all families of version 2 say where theirs lies
        raise FamilyError(
            f"{path}: was made by bladegen {found.get('bladegen', '1')}, whose blades lie "
            "elsewhere between stations; its arrays can be read (bladegen info, bg.load_family), "
            "its blades are not made anew; take another folder for a family of this version"
        )


def require_same(path: Path, wanted: dict[str, Any], found: dict[str, Any]) -> None:
    """Raise if a folder holds another family than the one that is asked for.

    Raises
    ------
    FamilyError
        That says in what they differ, and how labels are added.
    """
    require_current(path, found)
    different = [key for key in wanted | found if wanted.get(key) != found.get(key)]
    if different == ["labels"]:
        asked, there = (one.get("labels", {}) for one in (wanted, found))
        missing, others = (
            [k for k in a if k not in b] for a, b in ((asked, there), (there, asked))
        )
        if missing:
            raise FamilyError(
                f"{path}: holds this family without {' and '.join(missing)}; "
                f"`bladegen label {path} {' '.join(missing)}` adds labels"
            )
        if others:
            raise FamilyError(
                f"{path}: holds this family with labels; say --label {','.join(there)} as well"
            )
    if different:
        said = [
            f"{key}: {_short(found.get(key))} there, {_short(wanted.get(key))} asked for"
            for key in different[:3]
        ]
        if "factors" in different:
            said.append("--reach, --vary and --space say what varies and how far")
        raise FamilyError(f"{path}: holds another family ({'; '.join(said)}); take another folder")


def _short(value: Any) -> str:
    """Return a value of an identity as it is told: bounds to three digits."""
    if isinstance(value, dict) and all(isinstance(one, list | tuple) for one in value.values()):
        return ", ".join(f"{name} {low:.3g}:{high:.3g}" for name, (low, high) in value.items())
    return json.dumps(value)
