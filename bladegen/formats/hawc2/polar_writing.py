"""HAWC2: profile coefficients (pc file) of a blade, in sets that HAWC2 interpolates rightly.

Within a set HAWC2 interpolates in thickness, so a set holds a run of stations over which the
thickness only falls or only rises.  Where it turns, the next set begins with the same station;
where it stays the same but polars change, the next set takes over half-way.  Every set reaches
to 100 %.  HAWC2 knows one Reynolds number a profile: that of the polars which is nearest to the
chord's.  Coefficients go about the quarter chord.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from bladegen.airfoils.polars import Polar
from bladegen.definition.blade_definition import THICKNESS_RIPPLE, BladeDefinition
from bladegen.definition.blending import between, completed
from bladegen.definition.estimates import CYLINDER_DRAG, chord_reynolds
from bladegen.formats.common.number_text import aligned, exact, one_line
from bladegen.formats.common.polars import about_quarter
from bladegen.formats.hawc2.polar_reading import RE_MARK, SOURCE_MARK
from bladegen.support.arrays import Array

__all__ = ["Sets", "profile_sets"]

RIPPLE = 100.0 * THICKNESS_RIPPLE  # % of thickness; less is no change
ROUND = 100.0  # % thick: a cylinder
DIGITS = 12  # of angles in degrees


@dataclass(frozen=True)
class _Profile:
    """A station's polar, as a pc file holds it: thickness in %."""

    eta: float
    name: str
    thickness: float
    polar: Polar


@dataclass
class _Run:
    """Stations of one set, and the span fraction from which on it holds."""

    start: float
    profiles: list[_Profile] = field(default_factory=list)

    def takes(self, profile: _Profile) -> bool:
        """Tell whether a profile goes on as the run does, thicker or thinner."""
        known = [one.thickness for one in self.profiles]
        return len(known) < 2 or (profile.thickness < known[-1]) == (known[1] < known[0])


@dataclass(frozen=True)
class Sets:
    """A pc file: its lines, and the number of the set at each row of the ae file.

    Parameters
    ----------
    lines : list of str
        Of the file.
    numbers : list of int
        From 1 on.
    count : int
        How many sets there are.
    moved : tuple of str
        Airfoils whose moments were brought to the quarter chord.
    """

    lines: list[str]
    numbers: list[int]
    count: int
    moved: tuple[str, ...]


def profile_sets(
    definition: BladeDefinition, stations: Sequence[tuple[float, str]], eta: Array, rthick: Array
) -> Sets | None:
    """Return the pc file of a blade; None unless all stations have polars.

    Parameters
    ----------
    definition : BladeDefinition
        The blade.
    stations : sequence of (eta, name)
        Where profiles are wanted, root to tip.
    eta, rthick : (m,) arrays
        The rows of the ae file: span fraction, and thickness over chord.
    """
    profiles: list[_Profile] = []
    moved: dict[str, None] = {}
    for at, name in stations:
        place = between(definition, at)
        polar, brought = about_quarter(place, chord_reynolds(definition, at))
        if polar is None:
            return None
        if brought:
            moved[name] = None
        thickness = 100.0 * float(np.interp(at, eta, rthick))
        profiles.append(_Profile(at, name, thickness, completed(polar)))
    runs = _runs(profiles)
    numbers = 1 + np.searchsorted([run.start for run in runs[1:]], eta, side="right")
    round_ = next((p for p in profiles if abs(p.thickness - ROUND) < RIPPLE), None)
    sets = []
    for k, run in enumerate(runs):
        rows = 100.0 * rthick[numbers == k + 1]
        sets.append(_whole(run.profiles, float(rows.min()) if rows.size else ROUND, round_))
    return Sets(_lines(sets), numbers.tolist(), len(sets), tuple(moved))


def _runs(profiles: Sequence[_Profile]) -> list[_Run]:
    """Divide stations into runs of one direction of the thickness."""
    runs = [_Run(0.0, [profiles[0]])]
    for before, profile in pairwise(profiles):
        run = runs[-1]
        last = run.profiles[-1]
        if abs(profile.thickness - last.thickness) < RIPPLE:
            if not last.polar.has_figures_of(profile.polar):
                runs.append(_Run(0.5 * (before.eta + profile.eta), [profile]))
        elif run.takes(profile):
            run.profiles.append(profile)
        else:
            runs.append(_Run(before.eta, [last, profile]))
    return runs


def _whole(run: Sequence[_Profile], least: float, round_: _Profile | None) -> list[_Profile]:
    """Return a set's profiles by thickness, from the thinnest section that uses it to 100 %."""
    ordered = sorted(run, key=lambda profile: profile.thickness)
    if least < ordered[0].thickness:  # by the ripple of a thickness that is meant to be level
        ordered[0] = replace(ordered[0], thickness=least)
    thickest = ordered[-1]
    if abs(thickest.thickness - ROUND) < RIPPLE:
        ordered[-1] = replace(thickest, thickness=ROUND)
    elif thickest.thickness < ROUND:
        ordered.append(replace(round_ or _cylinder(thickest), thickness=ROUND))
    if len(ordered) == 1:  # a cylinder alone; HAWC2 interpolates between two
        ordered.append(replace(ordered[0], thickness=ordered[0].thickness + 1.0))
    return ordered


def _cylinder(beside: _Profile) -> _Profile:
    """Return the polar of a cylinder, for a blade that has none."""
    alpha = np.array([-np.pi, np.pi])
    level = np.zeros(2)
    polar = Polar(
        alpha, level, level + CYLINDER_DRAG, level, source="a cylinder, so that the set is whole"
    )
    return replace(beside, name="cylinder", polar=polar)


def _lines(sets: Sequence[Sequence[_Profile]]) -> list[str]:
    """Return the lines of a pc file."""
    lines = [f"{len(sets)} sets of profile coefficients: alpha [deg], Cl, Cd, Cm; by bladegen"]
    for profiles in sets:
        lines.append(str(len(profiles)))
        for k, one in enumerate(profiles):
            polar = one.polar
            told = [one_line(one.name), f"{RE_MARK} {exact(polar.reynolds or 0.0)}"]
            if polar.source:
                told.append(f"{SOURCE_MARK} {one_line(polar.source)}")
            thick = exact(one.thickness)
            lines.append(f"{k + 1:3d} {len(polar.alpha):5d} {thick} {'; '.join(told)}")
            angles = np.degrees(polar.alpha).round(DIGITS)
            rows = np.stack([angles, polar.cl, polar.cd, polar.cm], axis=1)
            lines += map(aligned, rows.tolist())
    return lines
