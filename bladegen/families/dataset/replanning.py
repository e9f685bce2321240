"""A family's plan again, from what its folder says: baseline, space and where each variant lies."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from bladegen.blade.blade import Blade
from bladegen.blade.changes.deformation import Window
from bladegen.blade.lofting.paths import DEFAULT
from bladegen.blade.planform import PLANES
from bladegen.blade.variants.designs import tabulated
from bladegen.errors import FamilyError
from bladegen.families.family import Family
from bladegen.families.storage.places import copied
from bladegen.formats.bundled import bundled
from bladegen.formats.reading import read
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arrays import Array

__all__ = ["planned_again"]


def planned_again(
    path: Path,
    told: Mapping[str, Any],
    columns: Mapping[str, Array],
    eta: Array,
    blade: Blade | None,
    space: ShapeSpace | None,
) -> Family:
    """Return a family whose variants lie where a manifest says.

    Parameters
    ----------
    path : Path
        Its folder.
    told : mapping
        What `family.json` and the dataset's attributes say.
    columns : mapping of str to (count,) arrays
        Values of the factors, radians.
    eta : (k,) array
        Span fractions of its sections.
    blade, space : Blade, ShapeSpace, optional
        The baseline and the modes, where the folder does not tell them.

    Raises
    ------
    FamilyError
        If the baseline is no bundled blade and not given.
    """
    space = _space(path, told) if space is None else space
    return Family(
        _baseline(path, told) if blade is None else blade,
        space,
        tabulated(space, columns),
        Window(*told["window"]),
        eta,
        "keep",
        chord_line=told["chord_line"],
    )


def _space(path: Path, told: Mapping[str, Any]) -> ShapeSpace | None:
    if told["space_fingerprint"] is None:
        return None
    own = path / "space.npz"
    if not own.is_file():
        return ShapeSpace.bundled()
    with copied(own) as file:
        return ShapeSpace.load(file)


def _baseline(path: Path, told: Mapping[str, Any]) -> Blade:
    settings, name = told.get("baseline_settings", {}), told.get("baseline", told["blade"])
    if isinstance(settings, str):  # a mapping in families of 2.0.0rc1
        settings = json.loads(settings)
    if name not in bundled() or any(key.startswith("change1.") for key in settings):
        raise FamilyError(
            f"{path}: its baseline {name!r} is no bundled blade; "
            "load_family(path, blade=...) takes it, `bladegen label` --blade FILE"
        )
    made = Blade.from_definition(
        read(name),
        landmarks=told["landmarks"],
        path=settings.get("path", DEFAULT),
        planes=PLANES[settings.get("planes", "flange")],
    )
    return made.mirror_image() if settings.get("mirrored") else made
