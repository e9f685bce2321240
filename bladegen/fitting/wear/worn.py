"""A blade whose skin is moved along its normals, at as many spans as it takes to stay that blade.

The new blade has stations, chord, twist, offsets and thickness at spans of its own.  A tip that
narrows within a metre, or a root that turns into an airfoil, needs more of them than the map of a
dent has: spans are added until the blade lies within `CLOSE` of the moved skin halfway, too.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from bladegen.airfoils.section_splines import SectionSplines
from bladegen.blade.blade import Blade
from bladegen.blade.lofting.loft import Loft
from bladegen.blade.shape import Shape
from bladegen.curves.crossing import crossing_sections
from bladegen.definition.blade_definition import Airfoil, BladeDefinition, Distribution, Station
from bladegen.definition.distribution import united
from bladegen.errors import BladegenError
from bladegen.shapes import affine
from bladegen.support.arrays import Array, Mask

__all__ = ["APART", "normals", "worn"]

APART = 1e-5  # of the span: stations lie no closer
CLOSE = 2e-4  # m, halfway between stations: closer than solids and meshes are by default
ROUNDS = 12  # of adding spans; the bundled blades take four to seven
DIGITS = 9  # of airfoil coordinates

Depths = Callable[[Array], Array]  # at span fractions (k,), at the blade's landmarks (k, n) [m]


def worn(blade: Blade, eta: Array, depths: Depths) -> Blade:
    """Return the blade with each landmark moved along its section's normal.

    Parameters
    ----------
    blade : Blade
        Not mirrored.
    eta : (k,) array
        Span fractions that `depths` needs.
    depths : callable
        How far points move outward [m].

    Raises
    ------
    BladegenError
        If a section would cross itself.
    """
    grids = blade.shape.loft.eta, *_grids(blade.definition)
    eta = united(_carrying(eta, depths(eta)), *grids, apart=APART)
    made = _through(blade, eta, depths(eta))
    for _ in range(ROUNDS):
        halfway = 0.5 * (eta[1:] + eta[:-1])[np.diff(eta) > 2.0 * APART]
        twice = np.union1d(eta, halfway)
        skin = _through(blade, twice, depths(twice)).sections(halfway)
        far = np.linalg.norm(made.sections(halfway) - skin, axis=-1).max(axis=-1) > CLOSE
        if not far.any():
            break
        eta = np.union1d(eta, halfway[far])
        made = _through(blade, eta, depths(eta))
    return made


def normals(profiles: Array) -> Array:
    """Return outward unit normals (k, n, 2) of sections that run from suction to pressure."""
    along = np.gradient(profiles, axis=1)
    normal = along[..., ::-1] * [1.0, -1.0]
    return np.asarray(normal / np.linalg.norm(normal, axis=-1, keepdims=True))


def _carrying(eta: Array, depths: Array) -> Array:
    """Return root, tip and the spans of a map at which, or beside which, it is not zero."""
    some: Mask = np.asarray(depths.any(axis=-1))
    some[1:-1] |= some[2:] | some[:-2]
    some[[0, -1]] = True
    return eta[some]


def _grids(definition: BladeDefinition) -> list[Array]:
    """Return the spans at which the definition's distributions may bend."""
    made = (getattr(definition, name) for name in vars(definition))
    return [one.grid for one in made if isinstance(one, Distribution)]


def _through(blade: Blade, eta: Array, depths: Array) -> Blade:
    """Return the blade through moved sections at spans."""
    definition, chord = blade.definition, blade.chord(eta)
    start = np.stack([-definition.offset_y(eta), definition.offset_x(eta)], axis=-1)
    profiles = blade.profiles(eta)
    points = chord[:, None, None] * profiles + start[:, None]
    points = points + depths[..., None] * normals(profiles)
    folded = list(crossing_sections(points))
    if folded:
        raise BladegenError(
            f"deviation: {-1e3 * depths[folded[0]].min():.3g} mm inward is more than the section "
            f"at eta = {eta[folded[0]]:.3f} can take: it crosses itself; end it farther inboard, "
            "or make it less deep"
        )
    curves = SectionSplines(blade.u).fit(points)
    lead, away = curves.leading_edge, curves.trailing_edge - curves.leading_edge
    turn = np.arctan2(away[:, 1], away[:, 0])
    c, s = np.cos(turn), np.sin(turn)
    back = np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)
    airfoils = (points - lead[:, None]) @ back / curves.chord[:, None, None]
    place = (lead[:, None] @ back)[:, 0]
    thickness = curves.relative_thickness
    stations = tuple(
        Station(float(e), Airfoil(f"{blade.name} {100 * e:.2f} %", np.round(xy, DIGITS), float(t)))
        for e, xy, t in zip(eta, airfoils, thickness, strict=True)
    )
    made = replace(
        definition,
        stations=stations,
        chord=Distribution(eta, curves.chord),
        twist=Distribution(eta, blade.twist(eta) + turn),
        section_offset_y=Distribution(eta, -place[:, 0]),
        section_offset_x=Distribution(eta, place[:, 1]),
        pitch_axis=None,
        relative_thickness=Distribution(eta, thickness),
    )
    X, M, b = affine.standardise(airfoils)
    loft = Loft(blade.u, eta, X, M, b, made.relative_thickness, blade.path)
    planform = replace(blade.planform, definition=made)
    told = {"outward_mm": float(1e3 * depths.max()), "inward_mm": float(-1e3 * depths.min())}
    changes = (*blade.changes, {"deviation": told})
    return Blade(Shape(loft), planform, blade.trailing_edge, blade.findings, changes)
