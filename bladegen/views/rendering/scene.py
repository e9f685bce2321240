"""What is looked at: a surface, quantities on it, and lines beside it, as plain arrays.

A `Scene` is handed to the window, the picture, the film and the page, which only draw.  Lengths
are metres, blade frame.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.errors import RenderError
from bladegen.support.arrays import Array
from bladegen.surface.mesh import TriangleMesh
from bladegen.views.plots import style

__all__ = ["Field", "Label", "Layer", "Scene", "reach_of"]

RESOLVED = 0.98  # of the surface; the colours are saturated on the rest
UNMOVED = 1e-6  # of a field's unit; the colours' least reach
ROUND = np.array([1.0, 2.0, 4.0, 5.0, 10.0])  # ends of scales, times a power of ten


@dataclass(frozen=True, eq=False)
class Field:
    """A quantity on a surface and its colours.

    Parameters
    ----------
    name : str
        What it is called on the command line.
    label : str
        What a legend calls it, with its unit.
    values : (v,) array
        At the surface's vertices.
    low, high : float
        The values that the ends of the colours stand for.
    colours : str
        A colour map of `style`.
    """

    name: str
    label: str
    values: Array
    low: float
    high: float
    colours: str

    @classmethod
    def signed(
        cls, name: str, label: str, values: Array, shown: TriangleMesh, share: float = RESOLVED
    ) -> "Field":
        """Return a field whose colours reach as far to either side of zero as most values do."""
        return cls.within(name, label, values, reach_of(values, shown, share))

    @classmethod
    def within(cls, name: str, label: str, values: Array, reach: float) -> "Field":
        """Return a field whose colours reach from -`reach` to `reach`."""
        return cls(name, label, values, -reach, reach, style.DIVERGING)


@dataclass(frozen=True, eq=False)
class Layer:
    """Lines that are shown and hidden together with others of the same name.

    Parameters
    ----------
    name : str
        Of the group: "sections", "wireframe", "stations", "frame" or "baseline".
    lines : tuple of (c, m, 3) arrays
        Polylines [m], grouped by their number of points.
    colour : str
        RGB.
    width : float
        Pixels.
    """

    name: str
    lines: tuple[Array, ...]
    colour: str
    width: float


@dataclass(frozen=True)
class Label:
    """A word at a point [m] of a group of layers."""

    name: str
    text: str
    point: tuple[float, float, float]
    colour: str


@dataclass(frozen=True, eq=False)
class Scene:
    """A surface with its fields, layers and labels, a title and a caption."""

    title: str
    caption: str
    surface: TriangleMesh
    fields: tuple[Field, ...] = ()
    layers: tuple[Layer, ...] = ()
    labels: tuple[Label, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """What can be shown or hidden."""
        return tuple(dict.fromkeys(layer.name for layer in self.layers))

    def field(self, name: str) -> Field:
        """Return the field of a name.

        Raises
        ------
        RenderError
            If there is none.
        """
        for field in self.fields:
            if field.name == name:
                return field
        raise RenderError(
            f"colour: got {name!r}, allowed are plain, curvature, and distance for what has a "
            "baseline: a perturbed blade, or one of two that are compared"
        )


def reach_of(values: Array, shown: TriangleMesh, share: float = RESOLVED) -> float:
    """Return the round number that sizes of values stay below on a share of a surface's area."""
    a, b, c = (shown.vertices[shown.faces[:, i]] for i in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    weights = np.bincount(shown.faces.reshape(-1), np.repeat(areas, 3), len(values))
    order = np.argsort(np.abs(values))
    total = np.cumsum(weights[order])
    last = int(np.searchsorted(total, share * total[-1]))
    most = max(float(np.abs(values[order[last]])), UNMOVED)
    power = 10.0 ** np.floor(np.log10(most))
    return float(power * ROUND[np.searchsorted(ROUND, most / power * (1.0 - 1e-9))])
