"""Relative thickness over span where a definition gives none: that of its airfoils, by PCHIP.

windIO 1, tables and OpenFAST may give airfoils at stations alone.  The relative thickness is then
PCHIP over span through the airfoils' own, as WISDEM blends the airfoils of such files, and from
there on it rules as one that is given does: shapes between stations follow it.  It is measured on
the airfoils' splines, so that each station's airfoil keeps its shape exactly, and a definition is
the same blade whether the distribution is left to this rule or written into a file.
"""

from dataclasses import replace

import numpy as np

from bladegen.airfoils.fairing import TOLERANCE
from bladegen.airfoils.landmarks import contour, landmark_parameters
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.definition.blade_definition import BladeDefinition, Distribution
from bladegen.support.arrays import Array

__all__ = ["LANDMARKS", "own_thickness", "ruled"]

LANDMARKS = 401  # those of a blade if nothing else is asked for


def own_thickness(eta: Array, u: Array, airfoils: Array) -> Distribution:
    """Return the relative thickness over span that airfoils at stations imply.

    Parameters
    ----------
    eta : (s,) array
        Span fractions of the stations.
    u : (n,) array
        Landmark parameters.
    airfoils : (s, n, 2) array
        The stations' airfoils.

    Raises
    ------
    GeometryError
        If an airfoil has no thickness.
    """
    return Distribution(eta, SectionSplines(u).fit(airfoils).relative_thickness)


def ruled(definition: BladeDefinition) -> BladeDefinition:
    """Return a definition with a thickness distribution: its own, or else that of its airfoils."""
    if definition.relative_thickness is not None:
        return definition
    u = landmark_parameters(LANDMARKS)
    curves = [contour(one.airfoil.coordinates, fairing=TOLERANCE) for one in definition.stations]
    airfoils = np.stack([curve.landmarks(u) for curve in curves])
    eta = np.array([station.eta for station in definition.stations])
    return replace(definition, relative_thickness=own_thickness(eta, u, airfoils))
