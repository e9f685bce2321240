"""What looks in a definition as if its file had other units or signs: findings, never refusals.

Blades of published turbines bend upwind, turn their roots into the wind, and carry their axis 24
to 53 per cent behind the leading edge; a file that says otherwise may be right, but more often its
twist is in radians, its offset in chords, or its axis points the other way.  A definition in metres
and radians gives findings with the figures that make one look twice.
"""

from collections.abc import Callable, Iterator

import numpy as np

from bladegen.definition.blade_definition import Airfoil, BladeDefinition, Distribution
from bladegen.errors import Finding
from bladegen.support.arrays import Array

__all__ = ["doubts"]

UNTWISTED = np.radians(1e-3)
SMALL_TWIST = np.radians(1.0)  # published blades twist by 11 to 25 degrees
INNER, OUTER = np.linspace(0.1, 0.4, 9), np.linspace(0.8, 1.0, 9)
LARGE_TWIST = np.radians(45.0)
TURNED = np.radians(3.0)  # by which an outer part may be turned more than an inner one
BENT_DOWNWIND = 0.002  # of the length
SWEPT_FORWARD = 0.01  # of the length
AXIS = (0.15, 0.7)  # of the chord; published are 0.24 to 0.53
ROUND = 0.98  # of the chord: a root so thick is a cylinder
CENTRE = 0.05  # of the chord, by which a cylinder may stand off the axis it is turned about
SPANS = np.linspace(0.02, 0.9, 89)  # tips may have any axis
SLENDER = (0.01, 0.3)  # largest chord over length; published are 0.05 to 0.08
THICKER = 0.02  # of chord; by which blades may grow thicker outboard
CAMBER = -0.005  # of chord; airfoils of the outer half that bend the other way by more
CHORDWISE = np.linspace(0.1, 0.9, 41)


def doubts(definition: BladeDefinition, *, radians: bool = False) -> tuple[Finding, ...]:
    """Return what looks as if a definition's file had other units or signs.

    Parameters
    ----------
    definition : BladeDefinition
        As it was read.
    radians : bool
        Whether the file's angles are in radians.
    """
    found = [Finding("twist", said) for said in _twist(definition, radians)]
    for where, look in _LOOKS:
        found += [Finding(where, said) for said in look(definition)]
    return tuple(found)


def _at(quantity: Distribution, eta: Array) -> Array:
    """Return a quantity, linear between its points: good enough for doubts, and quick."""
    return np.interp(eta, quantity.grid, quantity.values)


def _rise(quantity: Distribution) -> float:
    return float(quantity.values[-1] - quantity.values[0])


def _twist(definition: BladeDefinition, radians: bool) -> Iterator[str]:
    twist = definition.twist
    largest = float(np.abs(twist.values).max())
    degrees = np.degrees(largest)
    if UNTWISTED < largest < SMALL_TWIST:
        asked = f"degrees expected, are these radians ({np.degrees(degrees):.3g} deg)?"
        if radians:
            asked = f"{largest:.2g} rad in the file, was it converted twice?"
        yield f"reaches {degrees:.2g} deg: {asked}"
    elif largest > LARGE_TWIST:
        yield f"reaches {degrees:.3g} deg, more than any blade's: are these degrees?"
    root = float(twist.values[0])
    inner, outer = float(np.mean(_at(twist, INNER))), float(np.mean(_at(twist, OUTER)))
    turned = root if root < -TURNED else inner if inner < outer - TURNED else None
    if turned is not None:
        yield (
            f"is {np.degrees(turned):.3g} deg {'at the root' if turned == root else 'inboard'} and "
            f"{np.degrees(outer):.3g} deg at the tip; positive turns the leading edge upwind here, "
            "and roots usually are: is the sign the other way?"
        )


def _prebend(definition: BladeDefinition) -> Iterator[str]:
    tip = _rise(definition.axis.x)
    if tip > BENT_DOWNWIND * _rise(definition.axis.z):
        yield (
            f"bends the tip {tip:.3g} m downwind, toward the tower; upwind is negative here: is "
            "the sign the other way?"
        )


def _sweep(definition: BladeDefinition) -> Iterator[str]:
    tip = _rise(definition.axis.y)
    if tip < -SWEPT_FORWARD * _rise(definition.axis.z):
        yield (
            f"sweeps the tip {-tip:.3g} m toward the leading edge; toward the trailing edge is "
            "positive here: is the sign the other way?"
        )


def _axis(definition: BladeDefinition) -> Iterator[str]:
    chord, given = _at(definition.chord, SPANS), definition.section_offset_y
    if given is not None:
        offset = _at(given, SPANS)
    else:
        assert definition.pitch_axis is not None  # a definition has one of both
        offset = _at(definition.pitch_axis, SPANS) * chord
    place = offset / chord
    off = np.maximum(AXIS[0] - place, place - AXIS[1])
    k = int(np.argmax(off))
    if off[k] <= 0:
        return
    asked = ""
    if given is not None and place[k] < AXIS[0] and given.values.min() >= 0.0:
        asked = ": are these fractions of the chord?" if given.values.max() <= 1.0 else ""
    elif given is None and place[k] > AXIS[1]:
        asked = ": are these metres?"
    yield (
        f"{offset[k]:.2g} m on a {chord[k]:.2g} m chord puts the axis at {100 * place[k]:.0f} % "
        f"chord (eta = {SPANS[k]:.2f}){asked}"
    )


def _root(definition: BladeDefinition) -> Iterator[str]:
    foil, start = definition.stations[0].airfoil.coordinates, np.zeros(1)
    if np.ptp(foil[:, 1]) < ROUND * np.ptp(foil[:, 0]):
        return
    chord = float(_at(definition.chord, start)[0])
    given, fraction = definition.section_offset_y, definition.pitch_axis
    place = 0.0 if fraction is None else float(_at(fraction, start)[0])
    if given is not None:
        place = float(_at(given, start)[0]) / chord
    place -= float(_at(definition.axis.y, start)[0]) / chord
    if abs(place - 0.5) > CENTRE:
        yield (
            f"{100.0 * place:.0f} % of the chord at the round root puts its centre "
            f"{abs(place - 0.5) * chord:.2g} m off the pitch axis; a root that turns about its "
            "centre has 50 % there"
        )


def _chord(definition: BladeDefinition) -> Iterator[str]:
    largest = float(definition.chord.values.max())
    length = _rise(definition.axis.z)
    share = largest / length
    if not SLENDER[0] <= share <= SLENDER[1]:
        yield (
            f"reaches {largest:.3g} m on a blade of {length:.3g} m, "
            f"{100 * share:.2g} %: are both in metres?"
        )


def _thickness(definition: BladeDefinition) -> Iterator[str]:
    thickness = definition.relative_thickness
    if thickness is None:
        return
    least = np.minimum.accumulate(thickness.values)
    k = int(np.argmax(thickness.values - least))
    if thickness.values[k] - least[k] > THICKER:
        yield (
            f"grows outboard, from {least[k]:.3g} to {thickness.values[k]:.3g} at eta = "
            f"{thickness.grid[k]:.3g}: does it run from root to tip?"
        )


def _cone(definition: BladeDefinition) -> Iterator[str]:
    cone = definition.rotor.cone
    if cone is not None and cone < 0.0:
        yield f"of {np.degrees(cone):.3g} deg leans the tips downwind, toward the tower"


def _camber(definition: BladeDefinition) -> Iterator[str]:
    outer = {s.airfoil.name: s.airfoil for s in definition.stations if s.eta >= 0.5}
    bent = {name: camber for name, foil in outer.items() if (camber := _mean_line(foil)) < CAMBER}
    if bent:
        name = min(bent, key=lambda each: bent[each])
        yield (
            f"{name} bends to the pressure side, by {-100 * bent[name]:.1f} % chord in the mean: "
            "is y upside down?"
        )


def _mean_line(airfoil: Airfoil) -> float:
    """Return the mean height of an airfoil's mean line above its chord line, in chords."""
    points: Array = airfoil.coordinates
    nose = int(np.argmin(points[:, 0]))
    ends = 0.5 * (points[0] + points[-1])
    x = (points[:, 0] - points[nose, 0]) / max(ends[0] - points[nose, 0], 1e-3)
    y = points[:, 1] - points[nose, 1] - x * (ends[1] - points[nose, 1])
    sides = (slice(nose, None, -1), slice(nose, None))
    heights = [np.interp(CHORDWISE, x[side], y[side]) for side in sides]
    return float(0.5 * np.mean(heights[0] + heights[1]))


_LOOKS: tuple[tuple[str, Callable[[BladeDefinition], Iterator[str]]], ...] = (
    ("prebend", _prebend),
    ("sweep", _sweep),
    ("offset along the chord", _axis),
    ("pitch axis", _root),
    ("chord", _chord),
    ("relative thickness", _thickness),
    ("cone", _cone),
    ("airfoils", _camber),
)
