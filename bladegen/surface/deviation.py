"""How far a surface lies from the blade that it was fitted to, face by face.

The truth is the blade itself, at spans and landmarks that the surface does not use.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.support.arrays import Array
from bladegen.surface.net import CLOSED_EDGE, ENDS, SurfaceNet

__all__ = ["BETWEEN", "Deviation", "Offsets", "deviation"]

BETWEEN = np.array([0.25, 0.5, 0.75])  # of the way between landmarks, where a net is measured


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


def deviation(net: SurfaceNet, blade: Blade) -> Deviation:
    """Measure a net against its blade, at three places between landmarks and off its sections.

    The end sections' rims are measured too, and the strip between the trailing edges.
    """
    starts, widths = net.v[:-1], np.diff(net.v)
    v = np.sort(np.concatenate([starts + widths / 3.0, starts + 0.75 * widths, net.v[[0, -1]]]))
    u = np.concatenate([[0.0], *(net.u[:-1] + share * np.diff(net.u) for share in BETWEEN), [1.0]])
    u = np.sort(u)
    points = blade.sections(v, u)
    offsets = np.abs(net.offsets(points, u, v))
    eta, places = np.broadcast_arrays(v[:, None], u)
    front, back = u <= 0.5, u >= 0.5
    sides = [
        Offsets(face, offsets[:, some].ravel(), eta[:, some].ravel(), places[:, some].ravel())
        for face, some in zip(blade.sides, (front, back), strict=True)
    ]
    return Deviation.of([*sides, _strip(net, points[:, [0, -1]], v)])


def _strip(net: SurfaceNet, ends: Array, v: Array) -> Offsets:
    """Measure the strip between the trailing edges (k, 2, 3) at spans v (k,), where it is open."""
    ours, along = net.evaluate(ENDS, v), net.evaluate(ENDS, v, nv=1)
    share = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
    across = np.stack([1.0 - share, share], axis=-1)  # of the suction side's end, the pressure's
    normal = np.cross(across @ along, (ours[:, 1] - ours[:, 0])[:, None])
    length = np.linalg.norm(normal, axis=-1)
    missed = np.abs(np.sum(across @ (ends - ours) * normal, axis=-1))
    wide = np.linalg.norm(ours[:, 1] - ours[:, 0], axis=-1) > CLOSED_EDGE
    distances = missed[wide] / length[wide]
    eta = np.broadcast_to(v[wide, None], distances.shape)
    u = np.broadcast_to(np.round(share), distances.shape)
    return Offsets("trailing edge", distances.ravel(), eta.ravel(), u.ravel())
