"""Many perturbations of one blade at once: sections at fixed spans, measured and tested.

What does not change from variant to variant is prepared once (`features`, `placing`), and a
compiled loop (`kernels`) takes it from there.  The result is what `Blade.perturbed` gives,
to rounding.  Arrays are (k, b, ...), spans first, until sections come out as (b, k, ...).
"""

from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from bladegen.airfoils.chord_lines import KEPT
from bladegen.airfoils.section_curves import SectionCurves
from bladegen.blade.blade import Blade
from bladegen.blade.changes.deformation import AffineChange, Window, faded
from bladegen.blade.edges import least_width
from bladegen.blade.sanity import CHARACTERISTICS, Oddities, characteristics, oddities
from bladegen.blade.variants.features import Features
from bladegen.blade.variants.members import CROSSING, FAULTS, SOUND, THIN, TURNED, Batch
from bladegen.blade.variants.placing import Placing, column
from bladegen.blade.variants.standing import Standing
from bladegen.curves import polygons
from bladegen.curves.crossing import crossing_sections
from bladegen.shapes import affine
from bladegen.shapes.domain import Domain
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arrays import Array, Indices, laid_out, readonly
from bladegen.support.threads import side_by_side

__all__ = ["FAULTS", "LOST_THICKNESS", "Batch", "SectionBatch"]


LOST_THICKNESS = 0.2  # of the thickness before, which a deformation must leave
TURNED_EDGE = -1e-6  # chord; an edge that is open the wrong way by more has turned over
SINGLE: type = np.float32  # of no sections: as families have them, so that loops are compiled once


@dataclass(frozen=True, eq=False)
class SectionBatch:
    """A blade's sections at fixed spans, ready to be perturbed many times.

    Parameters
    ----------
    blade : Blade
        The baseline.
    space : ShapeSpace, optional
        Modes of deformation; without it only affine changes are made.
    window : Window
        Where along the span they act.
    eta : (k,) array
        Span fractions of the sections.
    chord_line : str
        What a change of shape does with the chord line, as for `Blade.perturbed`.
    """

    blade: Blade
    space: ShapeSpace | None
    window: Window
    eta: Array
    chord_line: str = KEPT

    def __post_init__(self) -> None:
        object.__setattr__(self, "eta", readonly(self.eta))

    def within(self, window: Window) -> "SectionBatch":
        """Return the same sections under another window; what it does not touch is shared."""
        other = replace(self, window=window)
        own = {*vars(other), "weight"}
        vars(other).update({name: value for name, value in vars(self).items() if name not in own})
        return other

    @cached_property
    def weight(self) -> Array:
        """How fully perturbations act at the spans, (k,)."""
        return self.window(self.eta)

    @cached_property
    def parts(self) -> Features:
        """What the sections are linear in."""
        return Features(self.blade, self.space, self.eta)

    @cached_property
    def placing(self) -> Placing:
        """Where the sections stand."""
        return Placing(self.blade, self.eta)

    @property
    def features(self) -> Array:
        """The features that sections are linear in, (k, F, n)."""
        return self.parts.values

    def coefficients(self, t: Array) -> Array:
        """Return the coefficients (k, b, F, 2) of shapes with coordinates t (b, r) or (b, k, r)."""
        return self.parts.coefficients(t, self.weight)

    @property
    def modes(self) -> int:
        """The number of shape coordinates."""
        return self.space.dimension if self.space is not None else 0

    @cached_property
    def ruling(self) -> Array:
        """The relative thickness that the baseline has or shall have, (k,)."""
        wanted = self.blade.wanted_thickness(self.eta)
        return self.before if wanted is None else wanted

    @cached_property
    def before(self) -> Array:
        """The relative thickness of the baseline's shapes before they are brought to it, (k,)."""
        return self._curves_before.relative_thickness

    @cached_property
    def _curves_before(self) -> SectionCurves:
        plain, _, M, b = self.parts.shapes
        return self.blade.splines.fit(affine.restore(plain, M, b))

    @property
    def _plain_ruling(self) -> Array:
        """The relative thickness of the blade's sections before anything was perturbed, (k,)."""
        ruling = self.blade.definition.relative_thickness
        return self.before if ruling is None else ruling(self.eta)

    @cached_property
    def _looks_before(self) -> Array:
        """The looks of the blade's sections before anything was perturbed, (k, 6)."""
        return characteristics(self._curves_before, self._plain_ruling / self.before)

    @cached_property
    def standing(self) -> Standing:
        """Where a change of shape leaves the sections' chord lines."""
        return Standing(self.parts, self.ruling, self.chord_line)

    def evaluate(
        self,
        t: Array,
        change: AffineChange,
        *,
        dtype: type = np.float64,
        measured: bool = False,
        tested: bool = True,
        shares: int = 1,
    ) -> Batch:
        """Make the sections of variants.

        Parameters
        ----------
        t : (b, r) or (b, k, r) array
            Coordinates along the modes [rad].
        change : AffineChange
            With arrays (b,) where variants differ, (b, k) where these do along the span.
        dtype : type
            Of the sections: float64 or float32.
        measured : bool
            Measure areas, centroids and so on.
        tested : bool
            Look for faults and fill looks; without it both are of no length.
        shares : int
            Threads at work.
        """
        shape = len(t), len(self.eta)
        raw, target = self.coefficients(t), self.target(change, len(t))
        to_space, chord, twist = self.placing(change, self.weight, len(t))
        sections: Array = np.empty((*shape, len(self.blade.u), 3), dtype=dtype)
        measures = np.empty((*shape, len(polygons.MEASURES)) if measured else (0, 0, 0))
        looks = np.empty((*shape, len(CHARACTERISTICS)) if tested else (0, 0, 0))
        width = least_width(self.blade.trailing_edge, target.T, chord)
        if width is not None:
            given = raw, target, chord, width, to_space, sections, measures, looks
            faults = self._made(*given, shares)
        else:
            plain = np.broadcast_to(np.eye(3), to_space.shape)
            profiles = np.empty(sections.shape)
            faults = self._made(
                raw, target, chord, np.zeros(shape), plain, profiles, measures[:0], looks
            )
            for i in range(len(t)):
                profiles[i, ..., :2] = self.blade.trailing_edge(profiles[i, ..., :2], chord[i])
                np.matmul(profiles[i], to_space[i], out=sections[i], casting="same_kind")
                if measured:
                    scale = chord[i, :, None, None]
                    measures[i] = polygons.measure(profiles[i, ..., :2] * scale)
        if measured:
            twist = twist + self.parts.turned(sections, to_space)
        return Batch(
            sections,
            chord,
            twist,
            target.T.copy(),
            faults.T,
            looks,
            measures if measured else None,
        )

    def faults(self, t: Array, change: AffineChange) -> tuple[Indices, Array]:
        """Return what is wrong with the sections of variants, and their relative thickness.

        Both (b, k), as `evaluate` gives them, without the sections.
        """
        return self.tested(t, change)[:2]

    def tested(self, t: Array, change: AffineChange) -> tuple[Indices, Array, Array]:
        """Return faults and relative thickness of variants, (b, k), and their looks (b, k, 6)."""
        raw, target = self.coefficients(t), self.target(change, len(t))
        chord, to_space, measures = np.empty((0, 0)), np.empty((0, 0, 0, 0)), np.empty((0, 0, 0))
        looks = np.empty((len(t), len(self.eta), len(CHARACTERISTICS)))
        none: Array = np.empty((0, 0, 0, 0), dtype=SINGLE)
        faults = self._made(raw, target, chord, chord, to_space, none, measures, looks)
        return faults.T, target.T, looks

    def oddities(self, looks: Array) -> Oddities:
        """Return what is odd about sections with looks (b, k, 6)."""
        return oddities(looks, self._looks_before, self._plain_ruling)

    @cached_property
    def domain(self) -> Domain | None:
        """Where the space's data allow the sections to go; None without a space."""
        if self.space is None:
            return None
        return Domain.of(self.space, self.eta, self.parts.shapes[1], self.ruling)

    def step(self, t: Array) -> Array:
        """Return by how much coordinates t change those of the sections, (b, k, r)."""
        return self.parts.weighted(t, self.weight).swapaxes(0, 1)

    def target(self, change: AffineChange, count: int) -> Array:
        """Return the relative thickness to reach, (k, b)."""
        thickening = faded(np.ones(1), self.weight[:, None], column(change.thickening).T)
        target: Array = self.ruling[:, None] * thickening
        return np.broadcast_to(target, (len(self.eta), count))

    def _made(
        self,
        raw: Array,
        target: Array,
        chord: Array,
        edge: Array,
        to_space: Array,
        sections: Array,
        measures: Array,
        looks: Array,
        shares: int = 1,
    ) -> Indices:
        """Fill looks, sections and measures that have a length; return what is wrong, (k, b)."""
        from bladegen.blade.variants import kernels

        own, known = np.empty(target.shape), np.empty(target.shape, dtype=np.int64)
        known = known if looks.size else known[:0]
        standing = self.standing(target) if sections.size else target[..., None]
        given: list[Array | Indices] = [
            self.blade.u,
            self.features,
            self.parts.slopes,
            raw,
            target,
            standing,
        ]
        flat = self._plain_ruling[:, None] / target
        given += [own, known, chord, to_space, sections, measures, edge, flat, looks]
        kept = self.chord_line == KEPT
        side_by_side(partial(kernels.made, *laid_out(*given), kept), shares)
        return self._faults(raw, own, known) if known.size else known

    def _faults(self, raw: Array, own: Array, known: Indices) -> Indices:
        """Return what is wrong with sections (k, b): a place in `FAULTS`."""
        from bladegen.blade.variants import kernels

        faults: Indices = np.full(own.shape, SOUND)
        ends = self.features[..., 0] - self.features[..., -1]
        gap = (ends[:, None, None] @ raw)[:, :, 0, 1]
        faults[gap < TURNED_EDGE] = TURNED
        faults[~(own > LOST_THICKNESS * self.before[:, None])] = THIN
        faults[known == kernels.CROSSING] = CROSSING
        k, b = np.nonzero(known == kernels.OPEN)
        crossing = crossing_sections(self.features[k].mT @ raw[k, b])
        faults[k[crossing], b[crossing]] = CROSSING
        return faults
