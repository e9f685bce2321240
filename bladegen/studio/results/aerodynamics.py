"""Lift and drag of a section, and what a rotor of such blades makes of the wind.

Polars are NeuralFoil's, the rotor is solved by blade-element momentum theory, both as
`bladegen evaluate` does it.  The baseline's `Working` point holds for all its variants: its tip
speed ratio and pitch, and the angle of attack that its sections have there.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.blade.aero.elements import Elements, elements_of
from bladegen.blade.aero.evaluation import SPANS, conditions_of, hub_radius_of, reynolds_of
from bladegen.blade.aero.performance import angles_of_attack, coefficients, performance
from bladegen.blade.aero.section_polars import polars_of
from bladegen.blade.blade import Blade
from bladegen.definition.estimates import ANGLES
from bladegen.errors import BladegenError
from bladegen.support.arrays import Array

__all__ = ["USUAL", "Lift", "Rotor", "Working"]

USUAL = 6.0  # deg, of attack, where no rotor says it


@dataclass(frozen=True, eq=False)
class Rotor:
    """What a rotor does: coefficients of power, thrust and the root's bending moment."""

    power: float
    thrust: float
    moment: float


@dataclass(frozen=True, eq=False)
class Lift:
    """Coefficients of a section.

    Parameters
    ----------
    alpha, cl, cd : (m,) arrays
        Angles of attack from the chord line [deg], lift and drag there.
    at : float
        The angle at which its figures are [deg].
    reynolds : float
        The Reynolds number.
    confidence : float
        NeuralFoil's at that angle, 0 to 1.
    """

    alpha: Array
    cl: Array
    cd: Array
    at: float
    reynolds: float
    confidence: float

    @property
    def lift(self) -> float:
        """The lift coefficient at the angle."""
        return float(np.interp(self.at, self.alpha, self.cl))

    @property
    def drag(self) -> float:
        """The drag coefficient at the angle."""
        return float(np.interp(self.at, self.alpha, self.cd))


@dataclass(frozen=True, eq=False)
class Working:
    """At what a baseline's rotor works, and its variants.

    Parameters
    ----------
    ratio, pitch : float
        The tip speed ratio that the file names, else the best; the best pitch [rad].
    hub_radius, cone, tip_speed : float
        Of the rotor [m], [rad], [m/s].
    blades : int
        How many it has.
    eta, alpha : (k,) arrays
        Span fractions of the baseline's sections, and their angles of attack [deg].
    trouble : str
        Why there is no such rotor; "" if there is one.
    """

    ratio: float
    pitch: float
    hub_radius: float
    cone: float
    tip_speed: float
    blades: int
    eta: Array
    alpha: Array
    trouble: str = ""

    @classmethod
    def of(cls, blade: Blade) -> "Working":
        """Return that of a baseline.

        Raises
        ------
        MissingLibraryError
            If NeuralFoil is not installed.
        """
        rotor = blade.definition.rotor
        cone, hub, trouble = rotor.cone or 0.0, 0.0, ""
        try:
            hub = hub_radius_of(rotor, blade.name)
        except BladegenError as error:
            trouble = str(error)
        elements = elements_of(blade.sections(SPANS)[None], hub, cone)
        speed = conditions_of(elements, rotor).tip_speed
        if trouble:
            nowhere = np.array([0.0, 1.0]), np.full(2, USUAL)
            return cls(0.0, 0.0, hub, cone, speed, rotor.blades, *nowhere, trouble)
        tables = _tables(elements, speed)
        best = performance(elements, tables, rotor.blades)
        ratio = rotor.design_ratio or float(best.ratio[0])
        point = np.full((1, 1), ratio), best.pitch[:, None]
        alpha = np.degrees(angles_of_attack(elements, tables, rotor.blades, *point))[0, 0, 1:-1]
        return cls(ratio, float(best.pitch[0]), hub, cone, speed, rotor.blades, SPANS[1:-1], alpha)

    def rotor(self, blade: Blade) -> Rotor:
        """Return what a rotor of such blades does here.

        Raises
        ------
        BladegenError
            If there is no rotor, or NeuralFoil is not installed.
        """
        if self.trouble:
            raise BladegenError(self.trouble)
        elements = elements_of(blade.sections(SPANS)[None], self.hub_radius, self.cone)
        point = np.full((1, 1), self.ratio), np.full((1, 1), self.pitch)
        tables = _tables(elements, self.tip_speed)
        return Rotor(*coefficients(elements, tables, self.blades, *point)[0, 0].tolist())

    def lift(self, blade: Blade, eta: float) -> Lift:
        """Return lift and drag of the section at a span fraction.

        Raises
        ------
        MissingLibraryError
            If NeuralFoil is not installed.
        """
        pair = blade.sections(np.array([eta, 1.0]))[None]
        elements = elements_of(pair, self.hub_radius, self.cone)
        reynolds = reynolds_of(elements, self.tip_speed)[:, :1]
        found = polars_of(elements.outlines[:, :1], elements.thickness[:, :1], reynolds)
        at = float(np.interp(eta, self.eta, self.alpha))
        sure = float(np.interp(at, ANGLES, found.confidence[0, 0]))
        return Lift(ANGLES, found.cl[0, 0], found.cd[0, 0], at, float(reynolds[0, 0]), sure)


def _tables(elements: Elements, tip_speed: float) -> tuple[Array, Array]:
    """Return lift and drag of elements at all angles."""
    reynolds = reynolds_of(elements, tip_speed)
    return polars_of(elements.outlines, elements.thickness, reynolds).extended()
