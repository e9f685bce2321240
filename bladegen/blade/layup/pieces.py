"""Layers and webs on one section as areas in its plane, to scale or thicker, for drawings.

The plane is that of the section's own shape: metres from the nose along the chord, suction side
up.  Layers lie inside one another in the order of the structure, those of a web beside each other.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.layup.laid import Laid
from bladegen.blade.layup.outlines import Outlines
from bladegen.errors import ExportError
from bladegen.support.arrays import Array

__all__ = ["Piece", "Section", "section"]

POINTS = 1201  # along the outline
SHARP = 1e-6  # of the arc, up to which half a trailing edge has no width


@dataclass(frozen=True, eq=False)
class Piece:
    """What a layer takes of a section: its name, its material, and its border (m, 2) [m]."""

    layer: str
    material: str
    border: Array


@dataclass(frozen=True, eq=False)
class Section:
    """A section with what lies inside its skin.

    Parameters
    ----------
    outline : (n, 2) array
        [m]
    pieces : tuple of Piece
        From the outside to the inside.
    """

    outline: Array
    pieces: tuple[Piece, ...]


@dataclass(frozen=True, eq=False)
class _Skin:
    """An outline (n, 2) [m] from the nose, inward normals, and fractions of the arc.

    It begins and ends in the middle of the trailing edge, below 0 and above 1.
    """

    points: Array
    inward: Array
    fraction: Array

    @classmethod
    def of(cls, blade: Blade, eta: float, count: int) -> "_Skin":
        outlines = Outlines.of(blade, np.array([eta]))
        at = np.linspace(0.0, 1.0, count)
        own = float(blade.chord(eta)) * blade.profiles(np.array([eta]))[0]
        along = outlines.fractions[0]
        points = np.stack([np.interp(at, along, own[:, i]) for i in (0, 1)], axis=-1)
        middle, half = 0.5 * (own[:1] + own[-1:]), outlines.half_edge / outlines.length
        if half[0] > SHARP:
            points = np.concatenate([middle, points, middle])
            at = np.concatenate([-half, at, 1.0 + half])
        step = np.gradient(points, axis=0)
        normal = step[:, ::-1] * (-1.0, 1.0)
        return cls(points, normal / np.linalg.norm(normal, axis=-1, keepdims=True), at)

    def at(self, fraction: float) -> Array:
        """Return the point at a fraction of the arc."""
        own = (np.interp(fraction, self.fraction, self.points[:, i]) for i in (0, 1))
        return np.array([*own])


def section(
    blade: Blade,
    eta: float,
    *,
    times: float = 1.0,
    laid: Laid | None = None,
    points: int = POINTS,
) -> Section:
    """Return the section at a span fraction with its layers and webs.

    Parameters
    ----------
    blade : Blade
        No mirror image.
    eta : float
        Span fraction.
    times : float
        By how much layers are thicker than they are.
    laid : Laid, optional
        What the blade's layup is there, one section, if it is known.
    points : int
        Along the outline.

    Raises
    ------
    ExportError
        If the blade's definition has no webs and layers.
    """
    inside = blade.layup
    if inside is None:
        raise ExportError(f"{blade.name}: its definition has no webs and layers to be drawn")
    here = inside.at(np.array([eta])) if laid is None else laid
    skin = _Skin.of(blade, eta, points)
    depth = np.zeros(len(skin.fraction))
    walls = {web.name: 0.0 for web in inside.structure.webs}
    found = []
    for layer, thick, arc, edge in zip(
        inside.structure.layers,
        here.thickness[:, 0],
        here.arcs[:, 0],
        here.edge[:, 0],
        strict=True,
    ):
        thickness, (start, end) = times * float(thick), arc
        if not thickness > 0.0:
            continue
        if layer.web:
            walls[layer.web] += thickness
            off = walls[layer.web] - 0.5 * thickness
            border = _wall(skin.at(start), skin.at(end), off, thickness)
            found.append(Piece(layer.name, layer.material, border))
            continue
        first, last = -1.0 if edge[0] else start, 2.0 if edge[1] else end
        for low, high in [(-1.0, end), (1.0 + start, 2.0)] if layer.around else [(first, last)]:
            on = np.flatnonzero((skin.fraction >= low) & (skin.fraction <= high))
            outer, normal = skin.points[on], skin.inward[on]
            near, far = (outer + normal * d[:, None] for d in (depth[on], depth[on] + thickness))
            found.append(Piece(layer.name, layer.material, np.concatenate([near, far[::-1]])))
            depth[on] += thickness
    return Section(skin.points, tuple(found))


def _wall(first: Array, last: Array, off: float, thickness: float) -> Array:
    """Return the border (4, 2) of a web's layer between two places, beside those before it."""
    along = (last - first) / np.linalg.norm(last - first)
    beside = np.array([-along[1], along[0]])
    near, far = (d * beside for d in (off - 0.5 * thickness, off + 0.5 * thickness))
    return np.array([first + near, last + near, last + far, first + far])
