"""The rotor of a HAWC2 model: from the bodies between blade and tower, and how they are turned.

The blade hangs on a hub, the hub on the shaft.  ``relative`` blocks turn a body against the one
it hangs on by Euler angles about the turned body's own axes, one after the other.  The shaft's z
runs upwind, the base's z down: the hub radius is the length of the hub, cone is the angle of the
blade's z against the rotor plane, tilt that of the shaft against the horizontal.  Metres, radians.
"""

from dataclasses import dataclass, field

import numpy as np

from bladegen.definition.blade_definition import Rotor
from bladegen.formats.common.text_file import number
from bladegen.formats.hawc2.model import Command, value
from bladegen.support.arrays import Array

__all__ = ["rotor"]

HUB, SHAFT = "hub", "shaft"
BLADES = range(1, 11)
LONGEST = 1000.0  # m, of a hub
DIGITS = 12  # of angles in degrees
CHAIN = 20  # bodies from the blade to the ground


@dataclass
class _Relative:
    """How a body (`second`) hangs on another (`first`), and by which angles it is turned [deg]."""

    first: str = ""
    second: str = ""
    turns: list[list[float] | None] = field(default_factory=list)

    def note(self, words: list[str]) -> None:
        """Take what a line of the block says; older models write body for mbdy."""
        what = words[0].replace("mbdy", "body")
        if what == "body1":
            self.first = words[1]
        elif what == "body2":
            self.second = words[1]
        elif what == "body2_eulerang":
            self.turns.append(_three(words[1:4]))

    @property
    def rotation(self) -> Array | None:
        """The body's axes as columns (3, 3) in those of the one it hangs on."""
        whole = np.eye(3)
        for turn in self.turns:
            if turn is None:
                return None
            for axis, angle in enumerate(np.radians(turn)):
                whole = whole @ _about(axis, float(angle))
        return whole


def rotor(lines: list[Command], blade: str) -> Rotor:
    """Return what a model says of the rotor around the main_body `blade`.

    What it does not say, or says in another way than the module's head has it, stays unknown.
    """
    lengths, relatives, base = _bodies(lines)
    stated = number(value(lines, "nblades"))
    blades = int(stated) if stated is not None and stated in BLADES else Rotor.blades
    hangs = {one.second: one for one in relatives}
    turned: Array | None = np.eye(3)
    radius, hub, cone, tilt = 0.0, "", None, None
    body = blade.lower()
    for _ in range(CHAIN):
        link = hangs.get(body)
        if link is None:
            break
        turn = link.rotation
        turned = None if turned is None or turn is None else turn @ turned
        body = link.first
        if HUB in body and not cone:
            radius, hub = radius + lengths.get(body, np.nan), body
        elif SHAFT in body:
            cone = None if turned is None else _degrees(np.arcsin(np.clip(turned[2, 2], -1, 1)))
            turned = np.eye(3)
    if turned is not None and cone is not None and body == base:
        tilt = _degrees(np.arcsin(np.clip(-turned[2, 2], -1, 1)))
    known = bool(hub) and 0.0 < radius < LONGEST
    return Rotor(blades, hub_radius=radius if known else None, cone=cone, tilt=tilt)


def _bodies(lines: list[Command]) -> tuple[dict[str, float], list[_Relative], str]:
    """Return the lengths of bodies by name, how they hang together, and what stands on the ground.

    A length is the distance from the first to the last section of c2_def.
    """
    ends: dict[str, list[list[float]]] = {}
    relatives: list[_Relative] = []
    blocks: list[str] = []
    name, base, turned = "", "", False
    for line in lines:
        words = [word.lower() for word in line.words]
        inside = blocks[-1] if blocks else ""
        if words[0] == "begin" and len(words) > 1:
            blocks.append(words[1])
            if words[1] == "relative":
                relatives.append(_Relative())
        elif words[0] == "end" and blocks:
            blocks.pop()
        elif len(words) < 2:
            continue
        elif inside == "main_body" and words[0] == "name":
            name = words[1]
        elif inside == "c2_def" and words[0] == "sec":
            at = _three(words[2:5])
            if at is not None:
                ends.setdefault(name, []).append(at)
        elif inside == "relative":
            relatives[-1].note(words)
        elif inside == "base":
            base = words[1] if words[0] in ("mbdy", "body") else base
            turned |= words[0].endswith("eulerang") and any(_three(words[1:4]) or [1.0])
    lengths = {
        body: float(np.linalg.norm(np.subtract(places[-1], places[0])))
        for body, places in ends.items()
    }
    return lengths, relatives, "" if turned else base


def _three(words: list[str]) -> list[float] | None:
    """Return three finite numbers, None if they are not."""
    found = [value for value in map(number, words) if value is not None and np.isfinite(value)]
    return found if len(found) == 3 else None


def _about(axis: int, angle: float) -> Array:
    """Return the rotation (3, 3) about one of the axes x, y, z."""
    c, s = np.cos(angle), np.sin(angle)
    one, other = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[one, one], matrix[one, other] = c, -s
    matrix[other, one], matrix[other, other] = s, c
    return matrix


def _degrees(angle: float) -> float:
    """Return an angle [rad] without the rounding of its rotations."""
    return float(np.radians(np.degrees(angle).round(DIGITS)))
