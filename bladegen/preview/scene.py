"""What is looked at: a surface, quantities on it, and lines beside it, as plain arrays.

A `Scene` is made of a blade, or of a perturbed blade with its baseline, and handed to the window,
the picture, the animation and the page, which only draw.  Lengths are metres, blade frame.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bladegen import style
from bladegen.arrays import Array
from bladegen.blade import Blade
from bladegen.errors import RenderError, visible
from bladegen.mesh import TriangleMesh, surface
from bladegen.preview.drawing import signed_distances

__all__ = [
    "DISTANCE",
    "MILLIMETRES",
    "Field",
    "Label",
    "Layer",
    "Scene",
    "caption",
    "mean_curvature",
    "reach_of",
    "scene_of",
]

SECTIONS = 240
FINEST = 401  # landmarks of a section that are shown, at most
LINES = 41  # sections and lines along the span of the wireframe and the section layer
RESOLVED = 0.98  # of the surface; the colours are saturated on the rest
FLAT = 0.8  # the same for curvature, which is large at the edges alone
MILLIMETRES = 1000.0
DISTANCE = "distance from the baseline, mm"
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


def scene_of(
    blade: Blade,
    baseline: Blade | None = None,
    *,
    colours: Sequence[str] = ("curvature", "distance"),
    sections: int = SECTIONS,
    landmarks: int = FINEST,
) -> Scene:
    """Return what there is to see of a blade.

    Parameters
    ----------
    blade : Blade
        Whose surface is shown.
    baseline : Blade, optional
        What it was perturbed from: adds its lines, and distances from it.
    colours : sequence of str
        The fields that are wanted.
    sections : int
        Of the surface.
    landmarks : int
        Of a section, at most; of more every second, fourth, ... is taken.
    """
    eta = blade.stations(max(sections, len(blade.eta) + 2))
    step = _step(len(blade.u), landmarks)
    grid = blade.sections(eta)[:, ::step]
    shown = surface(grid)
    fields = []
    if "curvature" in colours:
        curvature = _at(shown, grid, mean_curvature(grid, eta, blade.u[::step]))
        fields.append(Field.signed("curvature", "mean curvature, 1/m", curvature, shown, FLAT))
    layers = [*_grid_layers(blade), *_frame(blade)]
    if baseline is not None:
        if "distance" in colours:
            reference = surface(baseline.sections(eta)[:, ::step])
            distance = MILLIMETRES * signed_distances(shown, reference)
            fields.append(Field.signed("distance", DISTANCE, distance, shown))
        lines = _closed(baseline.sections(np.linspace(0.0, 1.0, LINES)))
        layers.append(Layer("baseline", (lines,), style.INK, 1.0))
    return Scene(
        title=_title(blade),
        caption=caption(blade),
        surface=shown,
        fields=tuple(fields),
        layers=tuple(layers),
        labels=_frame_labels(blade),
    )


def mean_curvature(points: Array, eta: Array, u: Array) -> Array:
    """Return the mean curvature of a surface.

    Parameters
    ----------
    points : (k, n, 3) array
        A grid of sections, landmarks from the trailing edge over the suction side [m].
    eta, u : (k,), (n,) arrays
        Its parameters.

    Returns
    -------
    (k, n) array
        Half the sum of the principal curvatures [1/m], positive where the surface is convex
        seen from outside, by differences of second order.
    """
    along, around = np.gradient(points, eta, axis=0), np.gradient(points, u, axis=1)
    E, F, G = (np.sum(a * b, -1) for a, b in ((along, along), (along, around), (around, around)))
    normal = np.cross(along, around)
    length = np.linalg.norm(normal, axis=-1)
    second = (
        _second(points, eta),
        np.gradient(around, eta, axis=0),
        np.moveaxis(_second(np.moveaxis(points, 1, 0), u), 0, 1),
    )
    e, f, g = (np.sum(part * normal, -1) for part in second)
    over = 2.0 * length**3
    curved: Array = np.divide(
        2.0 * f * F - e * G - g * E, over, out=np.zeros_like(over), where=over > 0
    )
    return curved


def _second(values: Array, grid: Array) -> Array:
    """Return second derivatives along the first axis; those at the ends are their neighbours'."""
    step = np.diff(grid)[:, None, None]
    slope = np.diff(values, axis=0) / step
    inner = 2.0 * np.diff(slope, axis=0) / (step[1:] + step[:-1])
    return np.concatenate([inner[:1], inner, inner[-1:]])


def _step(count: int, most: int) -> int:
    """Return 1, 2, 4, ...: every so-many-th of `count` landmarks, both ends and the middle kept."""
    step = 1
    while (count - 1) // step >= most and (count - 1) // step % 4 == 0:
        step *= 2
    return step


def _at(shown: TriangleMesh, grid: Array, values: Array) -> Array:
    """Return values on a grid at the vertices of its mesh, which are points of the grid."""
    from scipy.spatial import KDTree

    _, place = KDTree(grid.reshape(-1, 3)).query(shown.vertices)
    found: Array = values.reshape(-1)[place]
    return found


def _closed(loops: Array) -> Array:
    """Return sections (k, n, 3) as closed lines."""
    return np.concatenate([loops, loops[:, :1]], axis=1)


def _grid_layers(blade: Blade) -> list[Layer]:
    """Return the sections, the wireframe and the stations of the definition."""
    grid = _closed(blade.sections(np.linspace(0.0, 1.0, 2 * LINES)))
    spanwise = np.moveaxis(_closed(blade.sections(np.linspace(0.0, 1.0, 4 * LINES))), 1, 0)
    every = max(1, (spanwise.shape[0] - 1) // LINES)
    return [
        Layer("wireframe", (grid, spanwise[::every]), style.INK, 0.8),
        Layer("sections", (_closed(blade.sections(np.linspace(0.0, 1.0, LINES))),), style.INK, 1.2),
        Layer("stations", (_closed(blade.sections(blade.eta)),), style.STATION, 2.5),
    ]


def _frame(blade: Blade) -> list[Layer]:
    """Return the blade frame: x, y and z at the root, and the reference axis."""
    reach = _reach(blade)
    arms = [
        Layer("frame", (np.stack([np.zeros(3), reach[i] * np.eye(3)[i]])[None],), colour, 3.0)
        for i, colour in enumerate(style.AXES)
    ]
    axis = blade.axis(np.linspace(0.0, 1.0, 4 * LINES))[None]
    return [*arms, Layer("frame", (axis,), style.INK, 2.0)]


def _frame_labels(blade: Blade) -> tuple[Label, ...]:
    margin = 0.01 * blade.length
    return tuple(
        Label("frame", word, (*((reach + margin) * np.eye(3)[i]).tolist(),), colour)
        for i, (word, reach, colour) in enumerate(
            zip("xyz", _reach(blade), style.AXES, strict=True)
        )
    )


def _reach(blade: Blade) -> tuple[float, float, float]:
    """Return the lengths of the frame's arms [m]."""
    arm = 0.06 * blade.length
    return arm, arm, 1.02 * blade.length


def _title(blade: Blade) -> str:
    definition = blade.definition
    title = visible(definition.description or definition.name)
    title += ", mirrored" if blade.mirrored else ""
    return f"{title}, perturbed: {definition.name}" if blade.changes else title


def caption(blade: Blade) -> str:
    """Return a blade's main figures in a line."""
    chord = blade.chord(np.linspace(0.0, 1.0, 501))
    twist = np.degrees(blade.twist(np.array([0.0, 1.0])))
    tip = blade.axis(1.0)
    bend = f", prebend {tip[0]:.2f} m" if abs(tip[0]) > 0.005 else ""
    sweep = f", sweep {tip[1]:.2f} m" if abs(tip[1]) > 0.005 else ""
    return (
        f"{blade.length:.4g} m long, chord to {chord.max():.3g} m, twist "
        f"{twist[0]:.1f} to {twist[1]:.1f} deg{bend}{sweep}"
    )
