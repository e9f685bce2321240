"""Like compared with like: what files say of their making, before they are held against others.

A blade that is compared with a file is made as the file was, as far as the file says so; what
still differs is told.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from bladegen.blade import PATHS, Blade
from bladegen.errors import BladegenError
from bladegen.inventory import made_by
from bladegen.planform import normal_to_axis, normal_to_z
from bladegen.provenance import Provenance, blade_settings, content_of, made_from
from bladegen.texts import chord_share, finish

__all__ = ["alike"]

PLANES = {"axis": normal_to_axis, "z": normal_to_z}
DIFFERENT = ("command", "unit", "schema", "tolerance mm", "stations")  # no other shape
SURFACE = {"tip": "flat"}  # of a blade that is compared


def alike(things: Sequence[Blade | Path]) -> tuple[list[Blade | Path], list[str]]:
    """Return two things to compare, blades made as the other one was, and what is to be said.

    Parameters
    ----------
    things : two blades or files
        Blades are as definitions are read by default.
    """
    made = [None if isinstance(thing, Blade) else made_by(thing) for thing in things]
    names = [thing.name for thing in things]
    taken, said = list(things), []
    for k, other in ((0, 1), (1, 0)):
        thing, told = things[k], made[other]
        if isinstance(thing, Blade):
            if told is not None and told.definition == content_of(thing.definition):
                taken[k] = remade = _remade(thing, told)
                changed = _changed(thing, remade)
                if changed:
                    said.append(f"{names[k]} is taken as {names[other]} was made: {changed}")
                thing = remade
            made[k] = made_from(thing, SURFACE)
    one, two = made
    if one is not None and two is not None:
        said += [
            f"{what}: {a} in {names[0]}, {b} in {names[1]}"
            for what, a, b in one.differences(two)
            if what not in DIFFERENT
        ]
    return taken, said


def _remade(blade: Blade, told: Provenance) -> Blade:
    """Return a blade made as a file says; as it is where the file's words are none of ours."""
    how = dict(told.settings)
    try:
        made = Blade.from_definition(
            blade.definition,
            landmarks=int(how["landmarks"]),
            path=how["path"] if how["path"] in PATHS else "geodesic",
            planes=PLANES.get(how["planes"], blade.planes),
            trailing_edge=finish(how["trailing_edge"]),
            fairing=chord_share(how["fairing"], "fairing"),
        )
    except (BladegenError, LookupError, ValueError):
        return blade
    return replace(made, mirrored=how.get("mirrored") == "yes")


def _changed(before: Blade, after: Blade) -> str:
    """Say which settings two blades do not share."""
    old, new = blade_settings(before), blade_settings(after)
    return ", ".join(
        f"{key.replace('_', ' ')} {value}" for key, value in new.items() if old.get(key) != value
    )
