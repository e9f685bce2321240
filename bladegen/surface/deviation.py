"""How far a surface lies from the blade that it was fitted to, face by face.

The truth is the blade itself, at spans and landmarks that the surface does not use.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from bladegen.blade.remembered import Sectioned
from bladegen.curves.vectors import cross, dots, lengths
from bladegen.support.arrays import Array
from bladegen.surface.net import CLOSED_EDGE, ENDS, SurfaceNet, along_sections
from bladegen.surface.splines import Fit, Knots, basis

__all__ = ["Deviation", "Measured", "Offsets", "deviation", "measured", "watched"]

PLACES = 800  # along the chord at least, and
BETWEEN = 4  # from knot to knot
SPANS = np.array([[0.2, 0.4, 0.62], [0.38, 0.6, 0.8]])  # and along the span, in turn
STRIP = np.arange(8) / 8.0  # of the way between sections, where the strip between them is measured
CHUNK = 100_000  # points at once


@dataclass(frozen=True, eq=False)
class Offsets:
    """Distances of points of the blade to one face of its solid.

    Parameters
    ----------
    face : str
        The face's name.
    distances, eta, u : (m,) arrays
        Distances [m], and where the points are.
    """

    face: str
    distances: Array
    eta: Array
    u: Array


@dataclass(frozen=True)
class Deviation:
    """How far a surface lies from the blade, at points that it was not made from.

    Lengths in metres; `face`, `eta` and `u` say where the largest is, `samples` how many were
    taken; `parts` holds them.
    """

    maximum: float
    rms: float
    percentile99: float
    face: str
    eta: float
    u: float
    samples: int
    parts: tuple[Offsets, ...] = field(default=(), repr=False, compare=False)

    @classmethod
    def of(cls, parts: Sequence[Offsets]) -> "Deviation":
        """Return the deviation over some faces, not all of them without points."""
        distances, eta, u = (
            np.concatenate([getattr(part, name) for part in parts])
            for name in ("distances", "eta", "u")
        )
        worst = int(np.argmax(distances))
        counts = np.cumsum([len(part.distances) for part in parts])
        return cls(
            maximum=float(distances[worst]),
            rms=float(np.sqrt(np.mean(distances**2))),
            percentile99=float(np.percentile(distances, 99)),
            face=parts[int(np.searchsorted(counts, worst, side="right"))].face,
            eta=float(eta[worst]),
            u=float(u[worst]),
            samples=len(distances),
            parts=tuple(parts),
        )

    @property
    def faces(self) -> dict[str, "Deviation"]:
        """The deviation of each face by itself."""
        return {part.face: Deviation.of((part,)) for part in self.parts if len(part.distances)}


@dataclass(frozen=True, eq=False)
class Measured:
    """How far a blade's sections lie from a net between its knots.

    Parameters
    ----------
    v, u : (kv,), (ku,) arrays
        Spans and landmark parameters.
    offsets : (kv, ku) array
        Distances along the surface's normal [m], signed.
    across : (kv, ku) array
        What would be left of them if the net passed through each of these sections as well as
        its knots along the chord allow.
    parts : tuple of Offsets
        The same face by face, with the strip between the trailing edges.
    volume : float
        What lies between net and blade, over the blade's volume, signed: about.
    """

    v: Array
    u: Array
    offsets: Array
    across: Array
    parts: tuple[Offsets, ...]
    volume: float


def deviation(net: SurfaceNet, blade: Sectioned) -> Deviation:
    """Return the deviation of a net's sides, and of the strip between them, from its blade."""
    return Deviation.of(measured(net, blade).parts)


def measured(net: SurfaceNet, blade: Sectioned) -> Measured:
    """Measure a net against its blade.

    That is between its sections and at creases and ends, at other places along the chord than
    those that it was fitted to, the blade's landmarks among them; and the strip between the
    trailing edges.
    """
    starts, widths = net.v[:-1, None], np.diff(net.v)[:, None]
    within = starts + widths * SPANS[np.arange(len(widths)) % len(SPANS)]
    v = np.unique(np.concatenate([within.ravel(), net.creases, net.v[[0, -1]]]))
    knots = Knots.simple(net.u)
    u = watched(knots, blade)
    fit, bend, offsets, across = Fit(knots, u), basis(net.u_knots, u, 1), [], []
    weights, volumes = np.gradient(v), []
    for some in np.array_split(v, -(-len(v) * len(u) // CHUNK)):
        points, along = blade.sections(some, u), basis(net.v_knots, some)
        flux = cross(
            net.combined(bend, along), net.combined(fit.matrix, basis(net.v_knots, some, 1))
        )
        area = lengths(flux)
        normal = flux / area[..., None]
        offsets.append(dots(points - net.combined(fit.matrix, along), normal))
        cones = dots(points, flux) / 3.0
        volumes.append(np.trapezoid(np.stack([area * offsets[-1], cones]), u))
        left = points - along_sections(fit.matrix, fit(points))
        across.append(dots(left, normal))
    found = np.concatenate(offsets)
    eta, places = np.broadcast_arrays(v[:, None], u)
    sides = [
        Offsets(face, np.abs(found[:, some]).ravel(), eta[:, some].ravel(), places[:, some].ravel())
        for face, some in zip(blade.sides, (u <= 0.5, u >= 0.5), strict=True)
    ]
    dense = Knots.simple(net.v).inside(STRIP)
    parts = *sides, _strip(net, blade.sections(dense)[:, [0, -1]], dense)
    between, whole = np.concatenate(volumes, axis=1) @ weights
    return Measured(v, u, found, np.concatenate(across), parts, float(between / whole))


def watched(knots: Knots, blade: Sectioned) -> Array:
    """Return places along the chord at which splines with some knots are measured.

    The blade's landmarks are among them.
    """
    cells = len(knots.at) - 1
    pieces = max(BETWEEN, -(-PLACES // cells))
    return np.union1d(knots.inside(np.arange(pieces) / pieces), blade.u)


def _strip(net: SurfaceNet, ends: Array, v: Array) -> Offsets:
    """Measure the strip between the trailing edges (k, 2, 3) at spans v (k,), where it is open."""
    ours, along = net.evaluate(ENDS, v), net.evaluate(ENDS, v, nv=1)
    share = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
    across = np.stack([1.0 - share, share], axis=-1)  # of the suction side's end, the pressure's
    normal = cross(across @ along, (ours[:, 1] - ours[:, 0])[:, None])
    length = lengths(normal)
    missed = np.abs(dots(across @ (ends - ours), normal))
    wide = lengths(ours[:, 1] - ours[:, 0]) > CLOSED_EDGE
    distances = missed[wide] / length[wide]
    eta = np.broadcast_to(v[wide, None], distances.shape)
    u = np.broadcast_to(np.round(share), distances.shape)
    return Offsets("trailing edge", distances.ravel(), eta.ravel(), u.ravel())
