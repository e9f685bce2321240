"""The scene of a blade, or of a perturbed blade with its baseline."""

from collections.abc import Sequence

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.support.arrays import Array
from bladegen.surface.mesh import TriangleMesh, surface
from bladegen.views.plots import style
from bladegen.views.plots.figures import heading
from bladegen.views.rendering.drawing import signed_distances
from bladegen.views.rendering.scene import Field, Label, Layer, Scene

__all__ = [
    "DISTANCE",
    "MILLIMETRES",
    "caption",
    "mean_curvature",
    "scene_of",
    "thinning",
]

SECTIONS = 240
FINEST = 401  # landmarks of a section that are shown, at most
LINES = 41  # sections and lines along the span of the wireframe and the section layer
FLAT = 0.8  # the same for curvature, which is large at the edges alone
MILLIMETRES = 1000.0
DISTANCE = "distance from the baseline, mm"


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
    step = thinning(len(blade.u), landmarks)
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
        title=heading(blade),
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


def thinning(count: int, most: int) -> int:
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
