"""Webs and layers on some sections: places, sizes and masses as arrays."""

from dataclasses import dataclass

import numpy as np

from bladegen.support.arrays import Array, Mask

__all__ = ["Laid"]


@dataclass(frozen=True, eq=False)
class Laid:
    """Layers and webs of some sections.

    Parameters
    ----------
    eta : (...) array
        Span fractions.
    arcs : (layers, ..., 2) array
        Fractions of the arc where layers start and end, those of its web for a layer on one; NaN
        where there is none.  Layers around the trailing edge start below 0.
    edge : (layers, ..., 2) array of bool
        Whether they cover the halves of the trailing edge, that of the suction side first.
    half_edge : (...) array
        Half the width of the trailing edge over the arc.
    thickness : (layers, ...) array
        [m], 0 where a layer is not.
    width : (layers, ...) array
        Lengths along the outline, halves of the trailing edge among them, or up the web [m].
    angle : (layers, ...) array
        Of the fibres to the span [rad].
    web_arcs : (webs, ..., 2) array
        Fractions of the arc at which webs meet the suction and the pressure side.
    web_height : (webs, ...) array
        [m], 0 where a web is not.
    layer_mass : (layers, ...) array
        Mass per length [kg/m] of each layer.
    layer_centre : (layers, ..., 3) array
        Centres of the layers [m], blade frame; NaN where a layer is not.
    """

    eta: Array
    arcs: Array
    edge: Mask
    half_edge: Array
    thickness: Array
    width: Array
    angle: Array
    web_arcs: Array
    web_height: Array
    layer_mass: Array
    layer_centre: Array

    @property
    def mass_per_length(self) -> Array:
        """Mass per length (...) of the sections [kg/m]."""
        total: Array = self.layer_mass.sum(axis=0)
        return total

    @property
    def centre(self) -> Array:
        """Centres of mass (..., 3) of the sections [m], blade frame."""
        weighed = np.nan_to_num(self.layer_centre) * self.layer_mass[..., None]
        with np.errstate(invalid="ignore", divide="ignore"):
            found: Array = weighed.sum(axis=0) / self.mass_per_length[..., None]
        return found
