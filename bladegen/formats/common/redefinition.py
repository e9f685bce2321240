"""A blade as a definition that files can hold: airfoils at stations, PCHIP distributions.

An unperturbed blade is its definition.  A perturbed one gets airfoils of its own, in chords,
at the baseline's stations and at as many more as it takes until the blade that a reader makes
of the definition lies within a tolerance of the perturbed one; distributions are sampled in the
same way where a window faded a change in.  What is left over is measured, never assumed.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from bladegen.airfoils.landmarks import contour
from bladegen.airfoils.polars import BORROWED, Polar
from bladegen.definition.blade_definition import (
    Airfoil,
    BladeDefinition,
    Distribution,
    ReferenceAxis,
    Station,
    pchip,
    united,
)
from bladegen.definition.blending import between
from bladegen.errors import Finding
from bladegen.support.arrays import Array, Mask

if TYPE_CHECKING:
    from bladegen.blade.blade import Blade

__all__ = ["TOLERANCE", "missed", "redefined", "sampled"]

TOLERANCE = 5e-4  # m: between stations, from the sections of the blade to those of the definition
MARGIN = 0.8  # of the tolerance, at the places that are looked at; others are a little farther
LEAST_STEP = 5e-4  # of the span, between stations: nearer airfoils are one airfoil twice, all but
SHARE = 0.1  # of the tolerance, for each distribution
MOST_STATIONS = 400
MOST_POINTS = 2_000  # of a distribution's grid
UNCHANGED = 1e-9  # of a deformation's size or a thickening; less leaves an airfoil as it is
BETWEEN = np.array([0.3, 0.5, 0.7])  # of an interval: where it is tested
CLOSEST = 1e-5  # of the span, between points of a grid
DECIMALS = 9  # of coordinates in chords: nanometres


def redefined(blade: "Blade", *, tolerance: float = TOLERANCE) -> BladeDefinition:
    """Return the definition of a blade, perturbed or not.

    Parameters
    ----------
    blade : Blade
        Its shape and planform; trailing-edge finish, section planes and path are ways of
        building and no part of a definition.
    tolerance : float
        How far sections between stations may be off [m].

    Returns
    -------
    BladeDefinition
        The blade's own, where nothing was perturbed, sampled if its planform was made fair;
        otherwise one whose airfoils bear the
        name of the blade and their place.  A finding says how many stations were added, and
        which distance is left if the tolerance cannot be kept with `MOST_STATIONS`.
    """
    if not blade.changes and blade.fair_planform is None:
        return blade.definition
    draft = _sampled_planform(blade, tolerance)
    if not blade.changes:
        return draft
    shapes = _Shapes(blade)
    eta = blade.eta
    while True:
        definition = replace(draft, stations=shapes.stations(eta))
        off = shapes.missed(definition, eta)
        wide = (off > MARGIN * tolerance) & (np.diff(eta) > 2.0 * LEAST_STEP)
        if not wide.any() or len(eta) + np.count_nonzero(wide) > MOST_STATIONS:
            break
        eta = united(eta, (0.5 * (eta[:-1] + eta[1:]))[wide])
    definition = shapes.moved(definition, eta, SHARE * tolerance)
    said = (
        f"{len(eta)} stations, {len(eta) - len(blade.eta)} of them between those of the "
        f"baseline; {_left(off, eta, tolerance)}"
    )
    return replace(definition, findings=(*definition.findings, Finding("perturbed airfoils", said)))


def _left(off: Array, eta: Array, tolerance: float) -> str:
    """Say how far sections between stations are off, and where by more than the tolerance."""
    over = off > tolerance
    if not over.any():
        return f"sections between stations within {1e3 * off.max():.2g} mm"
    width, k = np.diff(eta), int(np.argmax(off))
    kept = f"within {1e3 * tolerance:.2g} mm" + (
        f" (at most {1e3 * off[~over].max():.2g})" if not over.all() else ""
    )
    return (
        f"sections between stations {kept} but over {100 * width[over].sum():.2g} % of the span, "
        f"where they are up to {1e3 * off[k]:.2g} mm off (eta = {eta[k]:.4f} to {eta[k + 1]:.4f})"
    )


def sampled(quantity: Callable[[Array], Array], grid: Array, tolerance: float) -> Distribution:
    """Return the PCHIP distribution through a function of span, within a tolerance of it.

    Points are put between those of `grid` where they are needed, `MOST_POINTS` at most.
    """
    while True:
        result = Distribution(grid, quantity(grid))
        off = _off(result, quantity)
        wide = (off > tolerance) & (np.diff(grid) > CLOSEST)
        if not wide.any() or len(grid) + np.count_nonzero(wide) > MOST_POINTS:
            return result
        grid = united(grid, (0.5 * (grid[:-1] + grid[1:]))[wide])


def missed(made: Distribution, quantity: Callable[[Array], Array]) -> float:
    """Return how far a sampled distribution is off a function of span, between its points."""
    return float(_off(made, quantity).max())


def _off(made: Distribution, quantity: Callable[[Array], Array]) -> Array:
    """Return the largest difference in each interval of a distribution's grid."""
    grid = made.grid
    inner = grid[:-1, None] + np.diff(grid)[:, None] * BETWEEN
    largest: Array = np.max(np.abs(made(inner) - quantity(inner)), axis=1)
    return largest


def _sampled_planform(blade: "Blade", tolerance: float) -> BladeDefinition:
    """Return the blade's definition with PCHIP distributions throughout, thickness included."""
    blade_definition = blade.definition
    longest = float(blade_definition.chord.values.max())
    share = SHARE * tolerance

    def plain(quantity: Distribution | None, scale: float = 1.0) -> Distribution | None:
        if quantity is None or quantity.spline is pchip:
            return quantity
        return sampled(quantity, quantity.grid, share / scale)

    def must(quantity: Distribution, scale: float = 1.0) -> Distribution:
        result = plain(quantity, scale)
        assert result is not None  # it was given
        return result

    axis = blade_definition.axis
    thickness = blade_definition.relative_thickness
    if thickness is not None and blade.thickenings:
        base, grid = thickness, thickness.grid
        for thickening in blade.thickenings:
            grid = thickening.window.with_ramp(grid)

        def thickened(eta: Array) -> Array:
            flat = eta.reshape(-1)
            values = base(flat)
            for thickening in blade.thickenings:
                values = values * thickening(flat)
            return values.reshape(eta.shape)

        thickness = sampled(thickened, grid, share / longest)
    return replace(
        blade_definition,
        chord=must(blade_definition.chord),
        twist=must(blade_definition.twist, longest),
        axis=ReferenceAxis(must(axis.x), must(axis.y), must(axis.z)),
        section_offset_y=plain(blade_definition.section_offset_y),
        section_offset_x=plain(blade_definition.section_offset_x),
        pitch_axis=plain(blade_definition.pitch_axis, longest),
        relative_thickness=plain(thickness, longest),
    )


@dataclass(frozen=True, eq=False)
class _Shapes:
    """The airfoils of a perturbed blade, each made once, and how far a definition misses them."""

    blade: "Blade"
    known: dict[float, Station] = field(default_factory=dict)
    between: dict[float, Array] = field(default_factory=dict)
    noses: dict[float, float] = field(default_factory=dict)

    def stations(self, eta: Array) -> tuple[Station, ...]:
        """Return the blade's airfoils at span fractions: the baseline's where nothing changed."""
        new = np.array([place for place in eta.tolist() if place not in self.known])
        if new.size:
            blade = self.blade
            own = {station.eta: station for station in blade.definition.stations}
            profiles = blade.profiles(new)
            thickness = blade.splines.fit(profiles).relative_thickness
            for i, changed in enumerate(self._changed(new)):
                place = float(new[i])
                nose = float(profiles[i, :, 0].min())
                airfoil = Airfoil(
                    f"{blade.name}-{1e4 * place:05.0f}",
                    (profiles[i] - [nose, 0.0]).round(DECIMALS),
                    round(float(thickness[i]), DECIMALS),
                    *self._polars(place),
                )
                kept = place in own and not changed
                self.known[place] = own[place] if kept else Station(place, airfoil)
                self.noses[place] = 0.0 if kept else nose
        return tuple(self.known[place] for place in eta.tolist())

    def _polars(self, eta: float) -> tuple[tuple[Polar, ...], float | None]:
        """Return the baseline's polars and aerodynamic centre there, marked as the baseline's."""
        found = between(self.blade.definition, eta)
        return found.polars(f"{BORROWED}, not of this shape"), found.centre

    def _changed(self, eta: Array) -> Mask:
        plain, X, _, _ = self.blade.shapes(eta)
        changed: Mask = np.linalg.norm(X - plain, axis=(-2, -1)) > UNCHANGED
        for thickening in self.blade.thickenings:
            changed |= np.abs(thickening(eta) - 1.0) > UNCHANGED
        return changed

    def nose(self, eta: Array) -> Distribution:
        """Return x of the foremost points [chords] over span, by which airfoils were moved.

        Files want x from 0 on; a perturbed shape's nose moves, and its place goes into the
        offset along the chord.
        """
        return Distribution(eta, np.array([self.noses[place] for place in eta.tolist()]))

    def moved(self, definition: BladeDefinition, eta: Array, share: float) -> BladeDefinition:
        """Return a definition with its offset along the chord from the foremost points."""
        nose = self.nose(eta)
        if not np.any(nose.values):
            return definition
        if definition.pitch_axis is not None:
            pitch = definition.pitch_axis
            grid = united(pitch.grid, eta)
            longest = float(definition.chord.values.max())
            made = sampled(lambda at: pitch(at) - nose(at), grid, share / longest)
            return replace(definition, pitch_axis=made)
        offset, chord = definition.offset_y, definition.chord
        grid = united(chord.grid, eta)
        made = sampled(lambda at: offset(at) - chord(at) * nose(at), grid, share)
        return replace(definition, section_offset_y=made)

    def missed(self, definition: BladeDefinition, eta: Array) -> Array:
        """Return the largest distance [m] in each interval between stations, (s - 1,)."""
        from bladegen.blade.blade import Blade

        again = Blade.from_definition(definition)
        inner = eta[:-1, None] + np.diff(eta)[:, None] * BETWEEN
        flat = inner.reshape(-1)
        new = np.array([place for place in flat.tolist() if place not in self.between])
        if new.size:
            for place, xy in zip(new.tolist(), self.blade.profiles(new), strict=True):
                self.between[place] = contour(xy).landmarks(again.u)
        wanted = np.stack([self.between[place] for place in flat.tolist()])
        off = again.profiles(flat) - wanted
        off[..., 0] += self.nose(eta)(flat)[:, None]
        apart = _from_curve(wanted, off)
        apart = definition.chord(flat)[:, None] * apart
        widest: Array = apart.max(axis=1).reshape(inner.shape).max(axis=1)
        return widest


def _from_curve(curve: Array, off: Array) -> Array:
    """Return how far points lie from a curve (..., n, 2), given what they are off its own points.

    To second order: a point that only slid along the curve, round a blunt nose, is on it.
    """
    along = np.gradient(curve, axis=-2)
    step = np.linalg.norm(along, axis=-1, keepdims=True)
    along /= step
    normal = np.stack([-along[..., 1], along[..., 0]], axis=-1)
    bend = np.sum(np.gradient(along, axis=-2) * normal, axis=-1) / step[..., 0]
    slid, apart = np.sum(off * along, axis=-1), np.sum(off * normal, axis=-1)
    distance: Array = np.abs(apart - 0.5 * bend * slid**2)
    return distance
