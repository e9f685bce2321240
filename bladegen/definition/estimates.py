"""Estimated polars for airfoils that have none of their own, marked as what they are.

Between stalls by NeuralFoil (P. Sharpe, https://github.com/peterdsharpe/NeuralFoil), a network
trained on XFoil, beyond them by `viterna.extended`.  NeuralFoil knows airfoils, not the thick
sections of a root: from 40 % thickness on, the polar of the section thinned to 40 % is mixed with
that of a cylinder in proportion to the thickness, as reference turbines do by hand.
The extra `aero` installs NeuralFoil; it is imported when first needed.
"""

from collections.abc import Callable
from dataclasses import replace
from importlib.metadata import version
from importlib.util import find_spec

import numpy as np

from bladegen.airfoils.landmarks import landmarks
from bladegen.airfoils.polars import ESTIMATED, Polar
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.airfoils.viterna import extended, stalls
from bladegen.definition.blade_definition import Airfoil, BladeDefinition, Station
from bladegen.errors import BladegenError, Finding
from bladegen.support.arrays import Array

__all__ = [
    "POLICIES",
    "available",
    "chord_reynolds",
    "estimated",
    "force_centre",
    "reynolds_at",
    "rounded",
    "with_polars",
]

POLICIES = ("estimate", "estimate-all", "keep", "none")
ESTIMATING = ("estimate", "estimate-all")
MODEL = "xlarge"
ANGLES = np.linspace(-20.0, 20.0, 81)  # deg; its confidence is lost beyond 25
THICK = 0.4  # of the chord: thicker sections are mixed with a cylinder
CYLINDER_DRAG = 0.5  # of a cylinder beyond its drag crisis, as in the NREL 5 MW's root
QUARTER, HALF = 0.25, 0.5  # chords; where forces act on an airfoil and on a cylinder
RENARD = 10  # Reynolds numbers a decade
DIGITS = 6  # of coefficients
LANDMARKS = 201
AIR = 1.46e-5  # m2/s, kinematic viscosity at 15 degrees C
TIP_SPEED = 80.0  # m/s, where no Reynolds number is known


def available() -> bool:
    """Tell whether NeuralFoil is installed."""
    return find_spec("neuralfoil") is not None


def with_polars(
    definition: BladeDefinition,
    policy: str,
    *,
    reynolds: float | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> tuple[BladeDefinition, tuple[Finding, ...]]:
    """Return a definition whose airfoils have polars after a policy, and what is to be said.

    Parameters
    ----------
    definition : BladeDefinition
        The blade.
    policy : str
        "estimate" those of airfoils without polars of their own, "estimate-all" so that a
        variant and its baseline can be compared, "keep" what there is, "none".
    reynolds : float, optional
        For the estimates; by default that of the polars there are, else that of the chord at
        `TIP_SPEED`.
    progress : callable
        Told what is being done.

    Raises
    ------
    BladegenError
        If the policy is none of `POLICIES`, or estimates are asked for without NeuralFoil.
    """
    if policy not in POLICIES:
        raise BladegenError(f"polars: got {policy!r}, allowed are {', '.join(POLICIES)}")
    if policy in ESTIMATING and not available():
        raise BladegenError(
            "polars: estimates need NeuralFoil, which the extra aero installs: "
            "pip install 'bladegen[aero]'"
        )
    if reynolds is not None and not 1e4 <= reynolds <= 1e9:
        raise BladegenError(f"reynolds: got {reynolds:g}, allowed is 1e4 to 1e9")
    made: dict[int, Airfoil] = {}
    borrowed = 0
    for station in definition.stations:
        airfoil = station.airfoil
        if id(airfoil) in made:
            continue
        foreign = not airfoil.polars or airfoil.polars[0].is_borrowed
        if policy == "none":
            airfoil = replace(airfoil, polars=())
        elif policy == "estimate-all" or (policy == "estimate" and foreign):
            progress(f"estimating the polar of {airfoil.name}")
            at = reynolds or reynolds_at(definition, station)
            points, thickness = _flat(airfoil)
            airfoil = replace(
                airfoil,
                polars=(_estimated(points, thickness, at),),
                aerodynamic_center=round(float(force_centre(thickness)), DIGITS),
            )
        elif airfoil.polars and foreign:
            borrowed += 1
        made[id(station.airfoil)] = airfoil
    stations = tuple(Station(s.eta, made[id(s.airfoil)]) for s in definition.stations)
    return replace(definition, stations=stations), _said(stations, policy, borrowed)


def _said(stations: tuple[Station, ...], policy: str, borrowed: int) -> tuple[Finding, ...]:
    airfoils = {id(station.airfoil): station.airfoil for station in stations}.values()
    guessed = [a for a in airfoils if a.polars and a.polars[0].is_estimate]
    bare = sum(not airfoil.polars for airfoil in airfoils)
    said = []
    if guessed and policy in ESTIMATING:
        said.append(f"{len(guessed)} airfoils with an {guessed[0].polars[0].source.split(';')[0]}")
    if borrowed:
        said.append(f"{borrowed} airfoils with polars of the baseline, not of their own shape")
    if bare and policy != "none":
        said.append(f"{bare} airfoils have none; --polars estimate makes some")
    return tuple(Finding("polars", text) for text in said)


def reynolds_at(definition: BladeDefinition, station: Station) -> float:
    """Return the Reynolds number of a station: its polars', else its chord's."""
    known = [polar.reynolds for polar in station.airfoil.polars if polar.reynolds]
    return float(known[0]) if known else chord_reynolds(definition, station.eta)


def chord_reynolds(definition: BladeDefinition, eta: float) -> float:
    """Return the Reynolds number of the chord at a span fraction, the tip at `TIP_SPEED`.

    It is rounded to `RENARD` a decade, so that a blade has few: see `polars.blended`.
    """
    hub = definition.rotor.hub_radius or 0.0
    ratio = (hub + eta * definition.length) / (hub + definition.length)
    rough = float(definition.chord(eta)) * max(ratio, 0.05) * TIP_SPEED / AIR
    return float(f"{10.0 ** (round(RENARD * np.log10(rough)) / RENARD):.3g}")


def estimated(airfoil: Airfoil, reynolds: float) -> Polar:
    """Return the estimated polar of an airfoil at a Reynolds number."""
    return _estimated(*_flat(airfoil), reynolds)


def force_centre(thickness: float | Array) -> Array:
    """Return where forces act on sections of a relative thickness, of the chord.

    At the quarter chord, towards the round root at the half chord, about which a cylinder has no
    moment, as public polar sets have it.
    """
    centre: Array = np.asarray(np.interp(thickness, [THICK, 1.0], [QUARTER, HALF]))
    return centre


def _estimated(points: Array, thickness: float, reynolds: float) -> Polar:
    """Return the estimated polar of landmarks as `_flat` returns them."""
    mixed = float(rounded(thickness))
    thinned = points * [1.0, min(1.0, THICK / thickness)]
    alpha, cl, cd, cm, confidence = _neuralfoil(thinned, reynolds)
    alpha, cl, cd, cm = extended(alpha, cl, cd, cm)
    source = (
        f"{ESTIMATED}: NeuralFoil {version('neuralfoil')} ({MODEL}), Viterna beyond stall; "
        f"Re = {reynolds:.3g}, least confidence {confidence:.2f}"
    )
    if mixed > 0.0:
        cl, cm = (1.0 - mixed) * cl, (1.0 - mixed) * cm
        cd = (1.0 - mixed) * cd + mixed * CYLINDER_DRAG
        source += (
            f"; {100 * thickness:.0f} % thick: of the section thinned to {100 * THICK:.0f} %, "
            f"mixed with {100 * mixed:.0f} % of a cylinder of drag {CYLINDER_DRAG:g}"
        )
    cl, cd, cm = (part.round(DIGITS) for part in (cl, cd, cm))
    return Polar(alpha, cl, cd, cm, reynolds, source=source)


def rounded(thickness: float | Array) -> Array:
    """Return how much of a cylinder sections of a relative thickness are taken for, 0 to 1."""
    share: Array = np.clip((np.asarray(thickness) - THICK) / (1.0 - THICK), 0.0, 1.0)
    return share


def _flat(airfoil: Airfoil) -> tuple[Array, float]:
    """Return landmarks of an airfoil, unit chord along x, and their relative thickness."""
    from bladegen.airfoils.landmarks import landmark_parameters
    from bladegen.shapes import affine

    points = landmarks(airfoil.coordinates, LANDMARKS)
    splines = SectionSplines(landmark_parameters(len(points)))
    A, c = splines.normalising(points[None], None)
    flat = affine.restore(points[None], A, c)
    return flat[0], float(splines.fit(flat).relative_thickness[0])


def _neuralfoil(points: Array, reynolds: float) -> tuple[Array, Array, Array, Array, float]:
    """Return the polar from stall to stall, and the network's least confidence there."""
    import neuralfoil

    found = neuralfoil.get_aero_from_coordinates(points, ANGLES, reynolds, model_size=MODEL)
    alpha = np.radians(ANGLES)
    cl = np.asarray(found["CL"], dtype=np.float64)
    low, high = stalls(alpha, cl)
    kept = slice(int(low[0]), int(high[0]) + 1)
    cd, cm = (np.asarray(found[key], dtype=np.float64) for key in ("CD", "CM"))
    confidence = float(np.min(found["analysis_confidence"][kept]))
    return alpha[kept], cl[kept], cd[kept], cm[kept], confidence
