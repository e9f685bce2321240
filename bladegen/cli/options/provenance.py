"""Like compared with like: what files say of their making, before they are held against others.

A blade that is compared with a file is made as the file was, as far as the file says so; what
still differs is told.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from bladegen.blade.blade import PATHS, Blade
from bladegen.blade.lofting.paths import DEFAULT
from bladegen.blade.planform import PLANES
from bladegen.cli.options.fairing import chord_share, planform_fairing
from bladegen.cli.options.parsing import finish
from bladegen.errors import BladegenError
from bladegen.exports.inventory import made_by
from bladegen.exports.provenance import Provenance, blade_settings, content_of, made_from, word
from bladegen.surface.tips import TIPS, Tip, flat_tip

__all__ = ["alike"]

DIFFERENT = ("command", "unit", "schema", "tolerance mm", "stations")  # no other shape


def alike(things: Sequence[Blade | Path]) -> tuple[list[Blade | Path], list[Tip], list[str]]:
    """Return two things to compare, blades made as the other one was, their tips, and what to say.

    Parameters
    ----------
    things : two blades or files
        Blades are as definitions are read by default.
    """
    made = [None if isinstance(thing, Blade) else made_by(thing) for thing in things]
    names = [thing.name for thing in things]
    taken: list[Blade | Path] = list(things)
    tips: list[Tip] = [flat_tip, flat_tip]
    said = []
    for k, other in ((0, 1), (1, 0)):
        thing, told = things[k], made[other]
        if isinstance(thing, Blade):
            remade = thing if told is None else _remade(thing, told)
            if told is not None and told.definition == content_of(remade.definition):
                taken[k] = remade
                tip = dict(told.settings).get("tip", "flat")
                tips[k] = TIPS.get(tip, flat_tip)
                changed = _changed(thing, remade)
                if tips[k] is not flat_tip:
                    changed = f"{changed}, tip {tip}" if changed else f"tip {tip}"
                if changed:
                    said.append(f"{names[k]} is taken as {names[other]} was made: {changed}")
                thing = remade
            made[k] = made_from(thing, {"tip": word(tips[k])})
    one, two = made
    if one is not None and two is not None:
        found = [row for row in one.differences(two) if row[0] not in DIFFERENT]
        if any(what == "source" for what, _, _ in found):  # then its hash is no news
            found = [row for row in found if row[0] != "definition"]
        said += [f"{what}: {a} in {names[0]}, {b} in {names[1]}" for what, a, b in found]
    return taken, tips, said


def _remade(blade: Blade, told: Provenance) -> Blade:
    """Return a blade made as a file says; as it is where the file's words are none of ours."""
    how = dict(told.settings)
    try:
        made = Blade.from_definition(
            blade.definition,
            landmarks=int(how["landmarks"]),
            path=how["path"] if how["path"] in PATHS else DEFAULT,
            planes=PLANES.get(how["planes"], blade.planes),
            trailing_edge=finish(how["trailing_edge"]),
            fairing=chord_share(how["fairing"], "fairing"),
            fair_planform=planform_fairing(how.get("fair_planform", "off"), "fair-planform"),
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
