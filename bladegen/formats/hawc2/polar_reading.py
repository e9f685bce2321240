"""HAWC2: profile coefficients (pc file) of a blade, brought to its airfoils.

A pc file holds sets, each of profiles in the order of their thickness [%]: a line of number,
rows, thickness and free text, then rows of alpha [deg], Cl, Cd, Cm about the quarter chord.  The
ae file says which set holds where; within a set HAWC2 interpolates in thickness, and so does this
reader where a station is as thick as none of the profiles.  bladegen's own texts tell name,
Reynolds number and source.  What cannot be read is left out and said.
"""

import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from bladegen.airfoils.polars import Polar, blended
from bladegen.definition.blade_definition import Airfoil, Distribution, Station
from bladegen.errors import DefinitionError, FileError, Finding
from bladegen.formats.common.document import Notes
from bladegen.formats.common.polars import COEFFICIENT, REYNOLDS, TURN
from bladegen.formats.common.text_file import number, read_lines
from bladegen.support.arrays import Array

__all__ = ["QUARTER", "RE_MARK", "SOURCE_MARK", "Profile", "profile_sets", "with_profiles"]

QUARTER = 0.25  # of the chord: what coefficients in pc files are about
RE_MARK, SOURCE_MARK = "Re", "from"  # in the texts of bladegen's profiles, between semicolons
MOST_SETS, MOST_PROFILES, MOST_ROWS = 1000, 1000, 10_000
MOST_LETTERS = 600  # of a source
SAME = 0.02  # % of thickness; stations nearer than this to a profile take it as it is
ALIKE = 0.5  # %; profiles farther than this from every station are left out, and said
BEYOND = 0.1  # %; how far a station may be out of a set's thicknesses


@dataclass(frozen=True)
class Profile:
    """A profile of a set: its thickness [%] and its coefficients."""

    thickness: float
    polar: Polar


class _UnreadableError(Exception):
    """Why a file's polars are left out."""


def profile_sets(path: Path, notes: Notes) -> list[list[Profile]]:
    """Return the sets of a pc file; none if it is unusable, which a finding tells."""
    try:
        return _sets(read_lines(path))
    except (_UnreadableError, DefinitionError) as error:
        said = str(error)
    except FileError as error:
        said = error.problems[0]
    notes.findings.append(Finding(path.name, f"polars left out: {said}"))
    return []


def with_profiles(
    stations: tuple[Station, ...],
    sets: list[list[Profile]],
    grid: Array,
    numbers: Array,
    rthick: Distribution,
    notes: Notes,
) -> tuple[Station, ...]:
    """Return stations whose airfoils have the polars of their thickness and set.

    Parameters
    ----------
    stations : tuple of Station
        The blade's.
    sets : list
        Of the pc file.
    grid, numbers : (m,) arrays
        Span fractions of the rows of the ae file, and the numbers of their sets, from 1 on.
    rthick : Distribution
        Relative thickness.
    notes : Notes
        Takes a finding on stations without polars.
    """
    made: dict[tuple[int, int, float], Airfoil] = {}
    result, bare, met = [], [], dict[int, list[float]]()
    for station in stations:
        nearest = int(np.argmin(np.abs(grid - station.eta)))
        wanted = int(numbers[nearest])
        thickness = 100.0 * float(rthick(station.eta))
        met.setdefault(wanted, []).append(thickness)
        key = id(station.airfoil), wanted, round(thickness, 2)
        if key not in made:
            polar = _at(_numbered(sets, wanted), thickness)
            own = station.airfoil
            if polar is None:
                bare.append(own.name)
            else:
                own = replace(own, polars=(polar,), aerodynamic_center=QUARTER)
            made[key] = own
        result.append(Station(station.eta, made[key]))
    if bare:
        notes.findings.append(
            Finding(
                "pc", f"holds no polars as thick as {len(bare)} airfoils: {', '.join(bare[:4])}"
            )
        )
    unmet = {
        f"{profile.thickness:g} %"
        for wanted, places in met.items()
        for profile in _numbered(sets, wanted)
        if min(places) < profile.thickness < max(places)
        and min(abs(place - profile.thickness) for place in places) > ALIKE
    }
    if unmet:
        said = f"profiles as thick as no airfoil are left out: {', '.join(sorted(unmet)[:4])}"
        notes.findings.append(Finding("pc", said))
    return tuple(result)


def _numbered(sets: list[list[Profile]], number: int) -> list[Profile]:
    """Return the profiles of a set by its number, from 1 on; none if there is no such set."""
    return sets[number - 1] if 1 <= number <= len(sets) else []


def _at(profiles: list[Profile], thickness: float) -> Polar | None:
    """Return the polar of a thickness [%], None beyond those of the profiles."""
    if not profiles:
        return None
    known = np.array([profile.thickness for profile in profiles])
    near = int(np.argmin(np.abs(known - thickness)))
    if abs(known[near] - thickness) <= SAME:
        return profiles[near].polar
    if not known[0] - BEYOND <= thickness <= known[-1] + BEYOND:
        return None
    if not known[0] < thickness < known[-1]:
        return profiles[near].polar
    above = int(np.searchsorted(known, thickness))
    one, other = profiles[above - 1], profiles[above]
    weight = (thickness - one.thickness) / (other.thickness - one.thickness)
    source = (
        f"{(one if weight < 0.5 else other).polar.source}; between profiles "
        f"{one.thickness:g} and {other.thickness:g} % thick"
    ).lstrip("; ")
    return blended([one.polar], [other.polar], weight, source)[0]


def _sets(lines: list[str]) -> list[list[Profile]]:
    """Read the sets of a pc file."""
    rows = _Rows(lines)
    sets = []
    for _ in range(rows.count("sets", MOST_SETS)):
        profiles: list[Profile] = []
        for _ in range(rows.count("profiles of a set", MOST_PROFILES)):
            profile = _profile(rows)
            if profiles and not profile.thickness > profiles[-1].thickness:
                raise _UnreadableError(
                    f"line {rows.at}: thickness {profile.thickness:g} follows "
                    f"{profiles[-1].thickness:g}, must increase within a set"
                )
            profiles.append(profile)
        sets.append(profiles)
    return sets


def _profile(rows: "_Rows") -> Profile:
    """Read one profile."""
    words = rows.next()
    place, text = rows.at, rows.text
    stated = [number(word) for word in words[1:3]]
    count, thickness = stated if len(stated) == 2 else (None, None)
    if count is None or not 2 <= count <= MOST_ROWS or thickness is None:
        raise _UnreadableError(f"line {place}: must be number, rows (2 to {MOST_ROWS}), thickness")
    if not 0.0 < thickness <= 200.0:
        raise _UnreadableError(f"line {place}: thickness {thickness:g}, allowed is 0 to 200 %")
    cells = []
    for _ in range(int(count)):
        row = [number(word) for word in rows.next()[:4]]
        if len(row) < 4 or None in row:
            raise _UnreadableError(f"line {rows.at}: must be alpha, Cl, Cd, Cm")
        cells.append(row)
    table = np.array(cells, dtype=np.float64)
    if not np.all(np.abs(table[:, 0]) <= TURN) or not COEFFICIENT.holds(table[:, 1:]).all():
        raise _UnreadableError(
            f"line {place}: allowed are angles from -180 to 180 deg, coefficients of {COEFFICIENT}"
        )
    if not np.all(np.diff(table[:, 0]) > 0):
        raise _UnreadableError(f"line {place}: alpha must increase strictly")
    reynolds, source = _told(text)
    alpha = np.clip(np.radians(table[:, 0]), -np.pi, np.pi)
    return Profile(
        thickness, Polar(alpha, table[:, 1], table[:, 2], table[:, 3], reynolds, source=source)
    )


def _told(text: str) -> tuple[float | None, str]:
    """Return Reynolds number and source from the text behind a profile's numbers."""
    words = text.split(None, 3)
    said = words[3].strip() if len(words) > 3 else ""
    ours = re.match(rf"(?:.*?); {RE_MARK} (\S+)(?:; {SOURCE_MARK} (.*))?$", said)
    if not ours:
        return None, said[:MOST_LETTERS]
    value = number(ours[1])
    sound = value is not None and 0.0 < value <= REYNOLDS.high
    return value if sound else None, (ours[2] or "")[:MOST_LETTERS]


class _Rows:
    """The lines of a file, one after the other, blank ones left out."""

    def __init__(self, lines: list[str]) -> None:
        self._lines = lines
        self.at = 0

    @property
    def text(self) -> str:
        return self._lines[self.at - 1]

    def next(self) -> list[str]:
        while self.at < len(self._lines):
            self.at += 1
            words = self.text.split()
            if words:
                return words
        raise _UnreadableError("the file ends early")

    def count(self, what: str, most: int) -> int:
        """Return the whole number that a line begins with."""
        word = self.next()[0]
        value = number(word)
        if value is None or not 1 <= value <= most or value != int(value):
            raise _UnreadableError(
                f"line {self.at}, number of {what}: got {word[:40]!r}, allowed is 1 to {most}"
            )
        return int(value)
