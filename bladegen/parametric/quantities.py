"""Quantities of the variants of a differentiable blade, with their derivatives.

Volume and surface are those of the closed polyhedron through the model's sections; measures of
sections are those of polygons through their points, in axes along the chord.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.curves import polygons
from bladegen.errors import PerturbationError
from bladegen.parametric.linearisation import Linearisation
from bladegen.support.arguments import one_of
from bladegen.support.arrays import Array

__all__ = ["Quantities"]

WHOLE = ("volume", "area")
PLANFORM = ("chord", "twist", "relative_thickness")
SECTION = tuple(f"section_{name}" for name in polygons.MEASURES)


@dataclass(frozen=True, eq=False)
class Quantities(Mapping[str, Array]):
    """Quantities by name, at vectors of parameters (...).

    "volume" [m3] and "area" [m2] of the surface are (...); "chord" [m], "twist" [rad],
    "relative_thickness", "section_area" [m2], "section_centroid_x" and "section_centroid_y" [m],
    from the leading edge along the chord and normal to it, "section_inertia_xx",
    "section_inertia_yy" and "section_inertia_xy" [m4], about the centroid, and
    "section_perimeter" [m] are (..., k), one a section.
    """

    linear: Linearisation
    lead: tuple[int, ...]

    def __repr__(self) -> str:
        return f"<Quantities at {int(np.prod(self.lead))} vectors: {', '.join(self)}>"

    def __iter__(self) -> Iterator[str]:
        return iter((*WHOLE, *PLANFORM, *SECTION))

    def __len__(self) -> int:
        return len(WHOLE) + len(PLANFORM) + len(SECTION)

    def __getitem__(self, name: str) -> Array:
        one_of(name, self, "quantity", PerturbationError)
        if name in WHOLE:
            return self._whole[WHOLE.index(name)].reshape(self.lead)
        if name in SECTION:
            value = self._measures[..., SECTION.index(name)]
        else:
            chain = self.linear.chain
            chord, twist, _ = chain.planform
            value = (chord, twist, chain.target)[PLANFORM.index(name)]
        return value.reshape(*self.lead, -1)

    def jacobian(self, name: str) -> Array:
        """Return the derivatives of a quantity in the parameters, (..., p) or (..., k, p)."""
        one_of(name, self, "quantity", PerturbationError)
        if name in WHOLE:
            slopes = polygons.volume_and_area_slopes(self._sections)[WHOLE.index(name)]
            return self.linear.vjp(slopes).reshape(*self.lead, -1)
        if name in SECTION:
            slopes = self._measure_slopes[..., SECTION.index(name), :]
        else:
            chain = self.linear.chain
            every = chain.chord_slopes, chain.twist_slopes, chain.thickness_slopes
            slopes = every[PLANFORM.index(name)]
        return slopes.reshape(*self.lead, *slopes.shape[1:])

    @cached_property
    def _sections(self) -> Array:
        return self.linear.sections()

    @cached_property
    def _whole(self) -> tuple[Array, Array]:
        return polygons.volume_and_area(self._sections)

    @cached_property
    def _flat(self) -> tuple[Array, Array]:
        return self.linear.flat()

    @cached_property
    def _measures(self) -> Array:
        """The measures (b, k, 7) of sections."""
        return polygons.measure(self._flat[0])

    @cached_property
    def _measure_slopes(self) -> Array:
        """The derivatives (b, k, 7, p) of the measures of sections."""
        points, changes = self._flat
        slopes = polygons.measure_slopes(points)
        return slopes.reshape(*slopes.shape[:3], -1) @ changes.reshape(
            *changes.shape[:2], -1, changes.shape[-1]
        )
