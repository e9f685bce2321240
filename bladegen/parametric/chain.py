"""From vectors of parameters to what sections are made of, and the derivatives on the way.

A vector becomes amounts over span, these a section's own coordinates (t, relative thickness), its
edge's width and its map to space.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.blade.changes.affine_change import WHOLE, AffineChange, faded
from bladegen.blade.edges import AsGiven, MinimumThickness, Sharp, least_width
from bladegen.blade.variants.batch import SectionBatch
from bladegen.errors import PerturbationError
from bladegen.parametric.parameters import AFFINE, Parameters
from bladegen.parametric.planform_slopes import CHORD, OFFSET, PREBEND, TWIST, PlacedSlopes
from bladegen.support.arguments import shown
from bladegen.support.arrays import Array

__all__ = ["Chain", "change_of"]


def change_of(amounts: Array, modes: int) -> AffineChange:
    """Return the affine parameters of amounts (b, k, r + 7), one a section where they may differ.

    Raises
    ------
    PerturbationError
        If one leaves what is allowed.
    """
    named = dict(zip(AFFINE, np.moveaxis(amounts[..., modes:], -1, 0), strict=True))
    return AffineChange(**{key: a[:, 0] if key in WHOLE else a for key, a in named.items()})


@dataclass(frozen=True, eq=False)
class Chain:
    """What the sections of variants x (b, p) are made of.

    Parameters
    ----------
    batch : SectionBatch
        Makes the sections.
    parameters : Parameters
        What varies.
    x : (b, p) array
        Where.
    """

    batch: SectionBatch
    parameters: Parameters
    x: Array

    @cached_property
    def _amounts(self) -> Array:
        return self.parameters.amounts(self.x)

    @property
    def t(self) -> Array:
        """The shape coordinates over span, (b, k, r)."""
        return self._amounts[..., : self.parameters.modes]

    @cached_property
    def change(self) -> AffineChange:
        """The affine parameters, (b, k) or (b,) each."""
        return change_of(self._amounts, self.parameters.modes)

    @cached_property
    def _affine(self) -> dict[str, Array]:
        amounts = np.moveaxis(self._amounts[..., self.parameters.modes :], -1, 0)
        return dict(zip(AFFINE, amounts, strict=True))

    @cached_property
    def target(self) -> Array:
        """The relative thickness that sections get, (b, k)."""
        return self.batch.target(self.change, len(self.x)).T

    @cached_property
    def planform(self) -> tuple[Array, Array, Array]:
        """Chord [m], twist [rad] and offset along the chord [m] of the sections, (b, k) each."""
        return self.batch.placing.planform(self.change, self.batch.weight)

    def _along(self, quantity: str, slope: Array) -> Array:
        """Return derivatives (b, k, p) by way of one quantity, in which they are `slope` (b, k)."""
        result = np.zeros((*slope.shape, len(self.parameters.names)))
        place = self.parameters.quantities.index(quantity)
        for g, (own, weight) in enumerate(
            zip(self.parameters.places, self.parameters.weights, strict=True)
        ):
            if own == place:
                result[..., g] = slope * weight
        return result

    @cached_property
    def thickness_slopes(self) -> Array:
        """Derivatives of the relative thickness, (b, k, p)."""
        a, base = self._affine, self.batch.ruling * self.batch.weight
        own = base * self.change.thickening
        return (
            self._along("thickness", own / a["thickness"])
            + self._along("camber", own * 2.0 / (a["camber"] * (2.0 - a["camber"])))
            - self._along("chord", own / a["chord"])
        )

    def _widened(self, whole: Array) -> Array:
        """Return derivatives (b, k, p) of what goes with the chord, `whole` (k,) unperturbed."""
        a, weight = self._affine, self.batch.weight
        own = a["chord_scale"] * whole * weight
        scaled = np.broadcast_to(faded(whole, weight, self.change.widening), own.shape)
        return (
            self._along("camber", -own * a["chord"])
            + self._along("chord", own * (2.0 - a["camber"]))
            + self._along("chord_scale", scaled)
        )

    @cached_property
    def chord_slopes(self) -> Array:
        """Derivatives of the chord [m], (b, k, p)."""
        return self._widened(self.batch.placing.own.chord)

    @cached_property
    def twist_slopes(self) -> Array:
        """Derivatives of the twist [rad], (b, k, p)."""
        shape = self.target.shape
        own = np.broadcast_to(self.batch.placing.own.twist, shape)
        return self._along("twist", np.broadcast_to(self.batch.weight, shape)) + self._along(
            "twist_scale", own
        )

    @property
    def ways(self) -> tuple[Array, Array, Array]:
        """Derivatives of all that sections are made of.

        Their own t and relative thickness (b, k, r + 1, p), edge widths (b, k, p), and maps to
        space (b, k, 3, 3, p).
        """
        return self.own_slopes, self.edge[2], self.space[1]

    @cached_property
    def own_slopes(self) -> Array:
        """Derivatives (b, k, r + 1, p) of the sections' own t, and of their relative thickness."""
        shape = self.target.shape
        weight = np.broadcast_to(self.batch.weight, shape)
        rows = [self._along(f"pga[{j}]", weight) for j in range(self.parameters.modes)]
        return np.stack([*rows, self.thickness_slopes], axis=2)

    @cached_property
    def edge(self) -> tuple[int, Array, Array]:
        """The kind of edge, its width (b, k) in chords, and that width's derivatives (b, k, p)."""
        from bladegen.parametric.edge_slopes import GIVEN, MINIMUM, SHARP

        rule, chord = self.batch.blade.trailing_edge, self.planform[0]
        kinds = {AsGiven: GIVEN, MinimumThickness: MINIMUM, Sharp: SHARP}
        kind = kinds.get(type(rule))
        if kind is None:
            raise PerturbationError(
                f"trailing_edge: got {shown(rule)}, derivatives are known of MinimumThickness, "
                "AsGiven and Sharp"
            )
        width = least_width(rule, self.target, chord)
        if not isinstance(rule, MinimumThickness) or width is None:
            return kind, np.zeros(chord.shape), np.zeros_like(self.chord_slopes)
        return kind, width, rule.width_slope(chord)[..., None] * self.chord_slopes

    @cached_property
    def space(self) -> tuple[Array, Array]:
        """Maps (b, k, 3, 3) of (x, y, 1) to space, and their derivatives (b, k, 3, 3, p)."""
        names = self.parameters.quantities
        bends = names.index("prebend_scale") in self.parameters.places
        chord, twist, offset = self.planform
        placed = PlacedSlopes(self.batch.placing)
        prebend = self._affine["prebend_scale"][:, 0] if bends else None
        to_space, slopes = placed(chord, twist, offset, prebend)
        shape = chord.shape
        ways = {
            CHORD: self.chord_slopes,
            TWIST: self.twist_slopes,
            OFFSET: self._widened(self.batch.placing.own.offset_y),
            PREBEND: self._along("prebend_scale", np.ones(shape)),
        }
        result = np.zeros((*shape, 3, 3, len(self.parameters.names)))
        for place, way in ways.items():
            result += slopes[:, :, place, :, :, None] * way[:, :, None, None]
        return to_space, result
