"""Blades to what the wind makes of them: coefficients, loads and energy, several blades at once.

`evaluate` takes sections in space, root to tip; `evaluated` takes blades and cuts them itself, at
spans that lie close at root and tip.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from bladegen.blade.aero.elements import Elements, elements_of
from bladegen.blade.aero.energy import Conditions, annual_energy
from bladegen.blade.aero.performance import Performance, coefficients, performance
from bladegen.blade.aero.section_polars import SectionPolars, polars_of
from bladegen.blade.blade import Blade
from bladegen.definition.blade_definition import Rotor
from bladegen.definition.estimates import AIR, MODEL
from bladegen.errors import BladegenError
from bladegen.support.arrays import Array

__all__ = [
    "SPANS",
    "Evaluation",
    "conditions_of",
    "evaluate",
    "evaluated",
    "gigawatt_hours",
    "hub_radius_of",
    "of_polars",
    "reynolds_of",
    "sure",
]

SPANS = 0.5 - 0.5 * np.cos(np.pi * np.linspace(0.0, 1.0, 61))  # 121 give 3e-4 of the power more

LIFTING = 0.5  # of the chord: thicker sections are mostly cylinders


@dataclass(frozen=True, eq=False)
class Evaluation:
    """What rotors do with blades (b,).

    Parameters
    ----------
    elements : Elements
        What blades were cut into.
    polars : SectionPolars
        Of the elements, (b, k, m).
    performance : Performance
        Coefficients over tip speed ratio, and the optimum.
    conditions : Conditions
        Under which they work.
    power : (b, w) array
        At the wind speeds of `conditions.winds`, held at the rated power where it is reached [W].
    rated_wind : (b,) array
        Where the rated power is reached [m/s]; without one, where the largest tip speed is reached
        at the optimum; NaN if neither is before cut-out.
    root_moment : (b,) array
        There, out of the plane of rotation, of one blade [N m]: the largest in steady wind.
    energy : (b,) array
        Of a year [J]; NaN without a rated power.
    """

    elements: Elements
    polars: SectionPolars
    performance: Performance
    conditions: Conditions
    power: Array
    rated_wind: Array
    root_moment: Array
    energy: Array


def sure(found: Evaluation) -> Array:
    """Return NeuralFoil's least confidence (b,) in sections that are mostly airfoils."""
    least = found.polars.least_confidence
    return np.asarray(np.where(found.elements.thickness < LIFTING, least, 1.0).min(axis=1))


def gigawatt_hours(energy: Array) -> Array:
    """Return energies given in J in GWh."""
    return energy / 3.6e12


def hub_radius_of(rotor: Rotor, name: str) -> float:
    """Return the hub radius of a rotor, or say how to give one."""
    if rotor.hub_radius is None or rotor.hub_radius <= 0.0:
        raise BladegenError(
            f"{name}: names no hub radius, from which a rotor's radii are measured; give one: "
            "--hub-radius LENGTH, such as 2m"
        )
    return rotor.hub_radius


def evaluated(
    blades: Sequence[Blade],
    conditions: Callable[[Rotor, float], Conditions] = Conditions.of,
    *,
    hub_radius: float | None = None,
    network: str = MODEL,
) -> Evaluation:
    """Return what rotors do with blades of one baseline.

    Parameters
    ----------
    blades : sequence of Blade
        With the same number of landmarks; the rotor is that of the first one's definition.
    conditions : callable
        From what the definition says of the rotor and its tip radius [m], `Conditions.of` or
        another: ``lambda rotor, radius: Conditions.of(rotor, radius, mean_wind=9.0)``.
    hub_radius : float, optional
        [m]; the definition's if not given.
    network : str
        The size of NeuralFoil's.

    Raises
    ------
    MissingLibraryError
        If NeuralFoil is not installed.
    BladegenError
        If no hub radius is known.
    """
    plain = [blade.mirror_image() if blade.mirrored else blade for blade in blades]
    rotor = plain[0].definition.rotor
    hub = hub_radius_of(rotor, plain[0].name) if hub_radius is None else hub_radius
    sections = np.stack([blade.sections(SPANS) for blade in plain])
    elements = elements_of(sections, hub, rotor.cone or 0.0)
    working = conditions_of(elements, rotor, conditions)
    return evaluate(elements, rotor.blades, working, network=network)


def conditions_of(
    elements: Elements,
    rotor: Rotor,
    conditions: Callable[[Rotor, float], Conditions] = Conditions.of,
) -> Conditions:
    """Return the conditions of the first rotor of elements: the same on all machines."""
    return conditions(rotor, round(float(elements.tip_radius[0]), 3))


def evaluate(
    elements: Elements, blades: int, conditions: Conditions, *, network: str = MODEL
) -> Evaluation:
    """Return what rotors do that are made of elements (b, k).

    Parameters
    ----------
    elements : Elements
        From `elements.elements_of`.
    blades : int
        Of a rotor.
    conditions : Conditions
        Under which it works.
    network : str
        The size of NeuralFoil's.
    """
    polars = polars_of(
        elements.outlines,
        elements.thickness,
        reynolds_of(elements, conditions.tip_speed),
        size=network,
    )
    return of_polars(elements, polars, blades, conditions)


def of_polars(
    elements: Elements, polars: SectionPolars, blades: int, conditions: Conditions
) -> Evaluation:
    """Return what rotors do whose elements (b, k) have these polars."""
    tables = polars.extended()
    best = performance(elements, tables, blades)
    winds, end = conditions.winds, elements.tip_radius[:, None]
    ratios = np.minimum(best.ratio[:, None], conditions.tip_speed / winds)
    found = coefficients(elements, tables, blades, ratios, best.pitch[:, None])
    force = 0.5 * conditions.air_density * winds**2 * np.pi * end**2
    power = conditions.efficiency * found[..., 0] * force * winds
    reached, energy = conditions.tip_speed / best.ratio, np.full(len(power), np.nan)
    rated = conditions.rated_power
    if rated is not None:
        reached = _first_reached(winds, power, rated)
        power = np.where(winds >= reached[:, None], rated, np.maximum(power, 0.0))
        mean, shape = conditions.mean_wind, conditions.weibull_shape
        energy = annual_energy(winds, power, mean, shape)
    reached = np.where((reached >= winds[0]) & (reached <= winds[-1]), reached, np.nan)
    moments = found[..., 2] * force * end
    moment = [np.interp(at, winds, row) for at, row in zip(reached, moments, strict=True)]
    return Evaluation(elements, polars, best, conditions, power, reached, np.array(moment), energy)


def _first_reached(winds: Array, power: Array, rated: float) -> Array:
    """Return where power curves (b, m), straight in between, first reach a power; NaN if never."""
    above = power >= rated
    after = np.maximum(np.argmax(above, axis=1)[:, None], 1)
    low, high = (np.take_along_axis(power, after + i, 1) for i in (-1, 0))
    share = (rated - low) / np.where(high > low, high - low, 1.0)
    reached = winds[after - 1] + np.clip(share, 0.0, 1.0) * (winds[1] - winds[0])
    return np.asarray(np.where(above.any(axis=1), reached[:, 0], np.nan))


def reynolds_of(elements: Elements, tip_speed: float) -> Array:
    """Return Reynolds numbers (b, k) of elements whose tip goes at a speed [m/s]."""
    return np.asarray(
        tip_speed * elements.radius / elements.tip_radius[:, None] * elements.chord / AIR
    )
