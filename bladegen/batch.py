"""Many perturbations of one blade at once: sections at fixed spans, measured and tested.

What does not change from variant to variant is prepared once: the shapes at the spans, the
modes carried there by parallel transport, and the splines of both.  A variant's section is
then linear in these features (`features`), with coefficients from its 2 x 2 matrices,

    (X cos S + D sin S / S) M A + ...,   D = w sum_j t_j V_j,   S^2 = D^T D,

so that all variants of a section are one matrix product.  The result is what `Blade.perturbed`
gives, to rounding.  Arrays are (k, b, ...), spans first, until sections come out as (b, k, ...).
"""

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from bladegen import affine, grassmann, polygons
from bladegen.arrays import Array, ArrayLike, Indices, Mask, readonly
from bladegen.blade import Blade
from bladegen.crossing import crossing_sections
from bladegen.deformation import AffineChange, Window, faded
from bladegen.features import Features
from bladegen.pga import ShapeSpace
from bladegen.planform import placement
from bladegen.sections import resizing

__all__ = ["FAULTS", "LOST_THICKNESS", "Batch", "SectionBatch"]


CHUNK = 16  # variants handled at once: what is worked on stays in the processor's cache
LOST_THICKNESS = 0.2  # of the thickness before, which a deformation must leave
TURNED_EDGE = -1e-6  # chord; an edge that is open the wrong way by more has turned over
SOUND, CROSSING, THIN, TURNED = range(4)
FAULTS = ("", "crosses itself", "loses its thickness", "turns its trailing edge over")


@dataclass(frozen=True, eq=False)
class Batch:
    """Sections of b variants at k spans.

    Parameters
    ----------
    sections : (b, k, n, 3) array
        Points [m], blade frame, trailing edges finished.
    chord, twist, relative_thickness : (b, k) arrays
        [m], [rad], of the chord.
    faults : (b, k) array of int
        What is wrong with each section, a place in `FAULTS`.
    measures : (b, k, 7) array, optional
        `polygons.MEASURES` of the sections [m], in axes along the chord from the leading edge
        and normal to it.
    """

    sections: Array
    chord: Array
    twist: Array
    relative_thickness: Array
    faults: Indices
    measures: Array | None = None

    def take(self, rows: Indices, other: "Batch") -> None:
        """Put the variants of another batch in the place of some."""
        for entry in fields(self):
            values = getattr(self, entry.name)
            if values is not None:
                values[rows] = getattr(other, entry.name)


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
    """

    blade: Blade
    space: ShapeSpace | None
    window: Window
    eta: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "eta", readonly(self.eta))

    @cached_property
    def _weight(self) -> Array:
        return self.window(self.eta)

    @cached_property
    def _shapes(self) -> tuple[Array, Array, Array, Array]:
        return self.blade.shapes(self.eta)

    @property
    def modes(self) -> int:
        """The number of shape coordinates."""
        return self.space.dimension if self.space is not None else 0

    @cached_property
    def _carried(self) -> Array:
        """The modes at the spans' shapes, (k, r, n, 2)."""
        X = self._shapes[1]
        if self.space is None:
            return np.zeros((len(X), 0, *X.shape[1:]))
        return grassmann.transport(self.space.modes, self.space.mean, X[:, None])

    @cached_property
    def features(self) -> Features:
        """The shapes, the carried modes, and a constant."""
        X, V = self._shapes[1], self._carried
        k, n, _ = X.shape
        rows = [np.moveaxis(X, -1, 1), np.moveaxis(V, -1, 2).reshape(k, -1, n), np.ones((k, 1, n))]
        return Features(self.blade.u, np.concatenate(rows, axis=1))

    @cached_property
    def _gram(self) -> Array:
        """V_i^T V_j, (k, r * r, 4)."""
        V = self._carried
        k, r = V.shape[:2]
        return (V.mT[:, :, None] @ V[:, None]).reshape(k, r * r, 4)

    @cached_property
    def _ruling(self) -> Array:
        """The relative thickness that the baseline has or shall have, (k,)."""
        plain, _, M, b = self._shapes
        wanted = self.blade.wanted_thickness(self.eta)
        if wanted is not None:
            return wanted
        return self.blade.splines.fit(affine.restore(plain, M, b)).relative_thickness

    @cached_property
    def before(self) -> Array:
        """The relative thickness of the baseline's shapes before they are brought to it, (k,)."""
        plain, _, M, b = self._shapes
        return self.blade.splines.fit(affine.restore(plain, M, b)).relative_thickness

    def coefficients(self, t: Array) -> Array:
        """Return the coefficients (k, b, F, 2) of shapes with coordinates t (b, r)."""
        _, _, M, b = self._shapes
        k, r = self._carried.shape[:2]
        count = len(t)
        weighted = t * self._weight[:, None, None]
        pairs = (weighted[..., :, None] * weighted[..., None, :]).reshape(k, count, r * r)
        cosine, sinc = grassmann.exp_factors((pairs @ self._gram).reshape(k, count, 2, 2))
        result = np.empty((k, count, 2 * r + 3, 2))
        result[:, :, :2] = cosine @ M[:, None]
        result[:, :, 2:-1] = (weighted[..., None, None] * (sinc @ M[:, None])[:, :, None]).reshape(
            k, count, 2 * r, 2
        )
        result[:, :, -1] = b[:, None]
        return result

    def evaluate(
        self,
        t: Array,
        change: AffineChange,
        *,
        dtype: type = np.float64,
        measured: bool = False,
    ) -> Batch:
        """Make the sections of variants.

        Parameters
        ----------
        t : (b, r) array
            Coordinates along the modes [rad].
        change : AffineChange
            With arrays (b,) where variants differ.
        dtype : type
            Of the sections: float64 or float32.
        measured : bool
            Measure areas, centroids and so on.
        """
        count = len(t)
        chunks = [slice(first, first + CHUNK) for first in range(0, count, CHUNK)]
        target = self._target(change, count)
        parts = [self._sized(t[chunk], target[:, chunk]) for chunk in chunks]
        raw, A, c, own, unsure, unproved = (
            np.concatenate(part, axis=1) for part in zip(*parts, strict=True)
        )
        self._settle(raw, target, A, c, own, unsure)
        faults = self._faults(raw, own, unproved)

        to_space, chord, twist = self._placement(change, count)
        unit = raw @ A
        unit[:, :, -1] += c
        sections: Array = np.empty((count, len(self.eta), len(self.blade.u), 3), dtype=dtype)
        measures = np.empty((count, len(self.eta), len(polygons.MEASURES)))
        homogeneous = np.ones((min(CHUNK, count), *sections.shape[1:]))
        for chunk in chunks:
            profiles = self.features.points(unit[:, chunk])
            flat = profiles.reshape(-1, *profiles.shape[2:])
            finished = self.blade.trailing_edge(flat, chord[chunk].reshape(-1))
            points = homogeneous[: len(profiles)]
            points[..., :2] = finished.reshape(profiles.shape)
            if measured:
                measures[chunk] = polygons.measure(points[..., :2] * chord[chunk][..., None, None])
            np.matmul(points, to_space[chunk], out=sections[chunk], casting="same_kind")
        return Batch(
            sections,
            chord,
            twist,
            np.array(target.T),
            np.array(faults.T),
            measures if measured else None,
        )

    def faults(self, t: Array, change: AffineChange) -> tuple[Indices, Array]:
        """Return what is wrong with the sections of variants, and their relative thickness.

        Both (b, k), as `evaluate` gives them, without the sections.
        """
        raw = self.coefficients(t)
        measures = self.features.measure(raw)
        own = measures.thickness / measures.chord
        faults = self._faults(raw, own, ~self.features.proved_sound(raw))
        return faults.T, self._target(change, len(t)).T

    def _target(self, change: AffineChange, count: int) -> Array:
        """Return the relative thickness to reach, (k, b)."""
        thickening = faded(np.ones(1), self._weight[:, None], _column(change.thickening).T)
        return np.broadcast_to(self._ruling[:, None] * thickening, (len(self.eta), count))

    def _sized(self, t: Array, target: Array) -> tuple[Array, Array, Array, Array, Mask, Mask]:
        """Return coefficients, the maps to size, own thicknesses, and what is still open."""
        raw = self.coefficients(t)
        measures = self.features.measure(raw)
        A, c, passed = resizing(
            measures.noses,
            measures.noses[0],
            measures.trailing_edge,
            measures.thickness,
            target,
        )
        own = measures.thickness / measures.chord
        return raw, A, c, own, measures.unsure | passed, ~self.features.proved_sound(raw)

    def _settle(
        self, raw: Array, target: Array, A: Array, c: Array, own: Array, unsure: Mask
    ) -> None:
        """Bring the sections to size that the quick measures are unsure of."""
        k, b = np.nonzero(unsure)
        if k.size:
            points = self.features.values[k].mT @ raw[k, b]
            A[k, b], c[k, b] = self.blade.splines.normalising(points, target[k, b])
            own[k, b] = self.blade.splines.fit(points).relative_thickness

    def _faults(self, raw: Array, own: Array, unproved: Mask) -> Indices:
        """Return what is wrong with sections (k, b): a place in `FAULTS`."""
        faults: Indices = np.full(own.shape, SOUND)
        ends = self.features.values[..., 0] - self.features.values[..., -1]
        gap = (ends[:, None, None] @ raw)[:, :, 0, 1]
        faults[gap < TURNED_EDGE] = TURNED
        faults[~(own > LOST_THICKNESS * self.before[:, None])] = THIN
        k, b = np.nonzero(unproved)
        points = self.features.values[k].mT @ raw[k, b]
        crossing = crossing_sections(points)
        faults[k[crossing], b[crossing]] = CROSSING
        return faults

    def _placement(self, change: AffineChange, count: int) -> tuple[Array, Array, Array]:
        """Return the maps (b, k, 3, 3) of (x, y, 1) to space, and chord and twist (b, k)."""
        eta, weight, definition = self.eta, self._weight, self.blade.definition
        widening, whole = _column(change.widening), _column(change.chord_scale)
        chord = whole * faded(self.blade.chord(eta), weight, widening)
        twist = faded(
            _column(change.twist_scale) * self.blade.twist(eta), weight, 1.0, _column(change.twist)
        )
        offset_y = whole * faded(definition.offset_y(eta), weight, widening)
        offset = np.stack(np.broadcast_arrays(-offset_y, definition.offset_x(eta)), axis=-1)
        axis, frames = self._axis(np.asarray(change.prebend_scale, dtype=np.float64))
        axes, start = placement(chord, twist, offset, axis, frames)
        shape = count, len(eta)
        to_space = np.concatenate([axes, start[..., None, :]], axis=-2)
        return (
            np.broadcast_to(to_space, (*shape, 3, 3)),
            np.array(np.broadcast_to(chord, shape)),
            np.array(np.broadcast_to(twist, shape)),
        )

    def _axis(self, prebend_scale: Array) -> tuple[Array, Array]:
        """Return reference axes (b or 1, k, 3) and section frames (b or 1, k, 3, 3)."""
        values, inverse = np.unique(prebend_scale, return_inverse=True)
        axes, frames = [], []
        for value in values.tolist():  # frames are carried along each axis by itself
            definition = AffineChange(prebend_scale=value).applied(
                self.blade.definition, self.window
            )
            axes.append(definition.axis(self.eta))
            frames.append(self.blade.planes(definition.axis)(self.eta))
        index = np.atleast_1d(inverse)
        return np.stack(axes)[index], np.stack(frames)[index]


def _column(value: ArrayLike) -> Array:
    """Return a number, or one a variant (b,), as (1, 1) or (b, 1)."""
    return np.atleast_1d(np.asarray(value, dtype=np.float64))[:, None]
