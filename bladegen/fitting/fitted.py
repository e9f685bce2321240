"""What a fit gives: a definition, where it lies in the source, and how far it is from it.

Residuals are signed distances [m] of the source's points to the surface of the fitted blade,
positive outside, each with the span fraction where it was measured.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from bladegen.airfoils.landmarks import landmarks
from bladegen.blade.blade import Blade
from bladegen.blade.edges import AsGiven
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import BladegenError, Finding
from bladegen.fitting.like import Parameters
from bladegen.fitting.measuring import LANDMARKS, Sections
from bladegen.fitting.placing.pose import Pose
from bladegen.measures.surfaces import Surface
from bladegen.shapes import affine, grassmann
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arrays import Array

__all__ = ["NORMAL", "Fitted", "Place"]

BANDS = 20  # of the span, in the table of residuals
HELD = 99.0  # per cent of the points that are within the tolerance
NORMAL = 2.576  # standard deviations, within which 99 % of normal noise are
MILLIMETRES = 1e3


@dataclass(frozen=True)
class Place:
    """Where an airfoil lies in a shape space.

    Parameters
    ----------
    eta : float
        Its span fraction.
    coordinates : tuple of float
        Normal coordinates t [rad]; none where it lies too far away.
    distance : float
        From the airfoil to the nearest shape of the space [rad].
    spread : float
        Root mean square of t over the standard deviations of the space's data: 1 is usual.
    nearest : str
        The airfoil of the bundled blades that is nearest.
    away : float
        Its distance on the Grassmannian [rad].
    """

    eta: float
    coordinates: tuple[float, ...]
    distance: float
    spread: float
    nearest: str
    away: float


@dataclass(frozen=True, eq=False)
class Fitted:
    """A blade fitted to a surface.

    Parameters
    ----------
    definition : BladeDefinition
        What every other command reads.
    pose : Pose
        From the source's axes and unit to the blade frame.
    sections : Sections
        All sections that were measured.
    surface : Surface
        The source in the blade frame [m].
    points, residuals, spans : (m, 3), (m,), (m,) arrays
        Points of the source in the blade frame [m], their signed distances to the fitted blade
        [m], and their span fractions.
    tolerance : float
        What was asked for [m].
    noise : float
        Standard deviation of the source's points about a smooth surface [m]; 0 of surfaces.
    findings : tuple of Finding
        How it was read, and what looks odd.
    parameters : Parameters, optional
        Those of the blade that it was held to be like.
    """

    definition: BladeDefinition
    pose: Pose
    sections: Sections
    surface: Surface
    points: Array
    residuals: Array
    spans: Array
    tolerance: float
    noise: float = 0.0
    findings: tuple[Finding, ...] = ()
    parameters: Parameters | None = None

    def __repr__(self) -> str:
        figures = self.figures
        return (
            f"<Fitted {self.definition!r}: 99 % within {figures['percentile_99_mm']:.3g} mm, all "
            f"within {figures['maximum_mm']:.3g} mm>"
        )

    @cached_property
    def blade(self) -> Blade:
        """The fitted blade, its trailing edges as they were found."""
        return Blade.from_definition(self.definition, trailing_edge=AsGiven())

    @property
    def figures(self) -> dict[str, Any]:
        """What was found, in one level of names."""
        off = MILLIMETRES * np.abs(self.residuals)
        chord = self.sections.chord
        return {
            "length_m": self.definition.length,
            "largest_chord_m": float(chord.max()),
            "twist_deg": [float(f(np.degrees(self.sections.twist))) for f in (np.min, np.max)],
            "tip_prebend_m": float(self.sections.prebend[-1]),
            "stations": len(self.definition.stations),
            "sections_measured": len(self.sections.eta),
            "points_compared": len(off),
            "maximum_mm": float(off.max()),
            "percentile_99_mm": float(np.percentile(off, HELD)),
            "rms_mm": float(np.sqrt(np.mean(off**2))),
            "tolerance_mm": MILLIMETRES * self.tolerance,
            "noise_mm": MILLIMETRES * self.noise,
        }

    @property
    def held(self) -> bool:
        """Whether 99 % of the points are within the tolerance, and their own noise."""
        allowed = MILLIMETRES * (self.tolerance + NORMAL * self.noise)
        return bool(self.figures["percentile_99_mm"] <= allowed)

    def require_held(self) -> None:
        """Raise a `BladegenError` that says where, unless the tolerance is held."""
        if not self.held:
            worst = max(self.bands(), key=lambda band: band["percentile_99_mm"])
            raise BladegenError(
                f"{self.definition.name}: tolerance: 99 % of the points are within "
                f"{self.figures['percentile_99_mm']:.3g} mm, allowed is "
                f"{MILLIMETRES * self.tolerance:g} mm; it is worst at "
                f"{100 * worst['from_eta']:.0f} to {100 * worst['to_eta']:.0f} % of the span"
            )

    def bands(self) -> list[dict[str, float]]:
        """Return residuals for equal bands of the span."""
        edges = np.linspace(0.0, 1.0, BANDS + 1)
        band = np.clip(np.searchsorted(edges, self.spans, side="right") - 1, 0, BANDS - 1)
        rows = []
        for k in range(BANDS):
            own = MILLIMETRES * self.residuals[band == k]
            if own.size:
                rows.append(
                    {
                        "from_eta": float(edges[k]),
                        "to_eta": float(edges[k + 1]),
                        "maximum_mm": float(np.abs(own).max()),
                        "percentile_99_mm": float(np.percentile(np.abs(own), HELD)),
                        "rms_mm": float(np.sqrt(np.mean(own**2))),
                        "mean_mm": float(own.mean()),
                    }
                )
        return rows

    def places(self, space: ShapeSpace | None = None) -> list[Place]:
        """Return where the stations' airfoils lie in a space, by default the bundled one."""
        from bladegen.formats.bundled import bundled
        from bladegen.formats.reading import read

        space = ShapeSpace.bundled() if space is None else space
        own = [station.airfoil.coordinates for station in self.definition.stations]
        known = {
            f"{station.airfoil.name} ({name})": station.airfoil.coordinates
            for name in bundled()
            for station in read(name).stations
        }
        n = LANDMARKS
        X = affine.standardise(np.stack([landmarks(points, n) for points in own]))[0]
        others = affine.standardise(np.stack([landmarks(p, n) for p in known.values()]))[0]
        away = grassmann.distance(X[:, None], others[None])
        nearest = np.argmin(away, axis=1)
        names = list(known)
        t, missed = _encoded(space, X)
        deviation = np.sqrt(space.variances[: space.dimension])
        spread = np.sqrt(np.mean((t / deviation) ** 2, axis=-1))
        return [
            Place(
                station.eta,
                tuple(t[k].tolist()),
                float(missed[k]),
                float(spread[k]),
                names[nearest[k]],
                float(away[k, nearest[k]]),
            )
            for k, station in enumerate(self.definition.stations)
        ]

    def report(self) -> dict[str, Any]:
        """Return all that was found, as JSON holds it."""
        like = self.parameters
        known = {} if like is None else {"like": like.model.blade.name, "parameters": like.rows()}
        return {
            "blade": self.definition.name,
            "source": self.definition.source,
            **self.figures,
            "held": self.held,
            "scale": self.pose.scale,
            "axes": self.pose.axes.tolist(),
            "origin_m": self.pose.origin.tolist(),
            "mirrored": self.pose.mirrored,
            "findings": [str(finding) for finding in self.findings],
            **known,
            "bands": self.bands(),
            "airfoils": [vars(place) for place in self.places()],
        }


def _encoded(space: ShapeSpace, X: Array) -> tuple[Array, Array]:
    """Return coordinates of shapes (k, n, 2), and their distances from the space."""
    t = space.encode(X)
    return t, grassmann.distance(X, space.decode(t))
