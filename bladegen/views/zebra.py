"""Zebra stripes: isophotes of a surface, drawn black and white, as CAD engineers judge fairness.

An isophote is a line on which the surface's normal makes one angle with a direction of light.
Where the surface is creased stripes break, where its curvature jumps they have a corner.  Normals
are those of the exact surface at the points of a fine grid: of the blade itself, or of the faces of
a CAD file; between grid points the angle is interpolated, so that no shading comes in.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.errors import RenderError
from bladegen.measures import fairness
from bladegen.measures.patches import Patch
from bladegen.support.arrays import Array, ArrayLike
from bladegen.views.comparison import surface_of
from bladegen.views.plots import style
from bladegen.views.rendering.drawing import add_lines
from bladegen.views.rendering.picture import save_image
from bladegen.views.rendering.renderer import image_of, quietly, require_renderer

__all__ = ["Sheet", "draw", "sheets_of"]

HALF = float(np.sqrt(0.5))
LIGHTS = (  # where from, and what a stripe is wide: degrees of the normal's turning
    ("light from trailing edge and tip, stripes of 2 deg", (0.0, HALF, HALF), 2.0),
    ("light along the span, stripes of 0.15 deg", (0.0, 0.0, 1.0), 0.15),
)
DARK, BRIGHT = "#14181c", "#f4f6f8"
SPANS, AROUND = 3001, 161
COARSE = 9  # points each way, to measure a patch
LONG = 4.0  # patches that are so much longer than wide have many rows along
BANDS = 4
EDGE, EDGE_WIDTH = "#8a929b", 2.5  # of trailing edges; pixels
NEARER = 1.0  # m towards the eye, which changes no place in a view of parallel lines of sight
SIZE = (2000, 2000)  # pixels
ACROSS = 1.35  # of a band's largest width: the height of its view
SIDES = (("suction side", 1.0), ("pressure side", -1.0))


@dataclass(frozen=True, eq=False)
class Sheet:
    """A grid of points (a, b, 3) [m] on a surface and its outward normals there.

    `edged` says whether its first and last columns are an edge of what is seen: they are drawn as
    lines, since stripes there may be narrower than a pixel.
    """

    points: Array
    normals: Array
    edged: bool = False

    def angles(self, light: ArrayLike) -> Array:
        """Return the angles (a, b) [deg] between the normals and the light's direction (3,)."""
        cosine = self.normals @ np.asarray(light)
        found: Array = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
        return found


def sheets_of(source: Blade | Path) -> list[Sheet]:
    """Return the sides of a blade, or the faces of a CAD file, with their normals.

    Raises
    ------
    RenderError
        If a file is a mesh, whose triangles have no normals of a surface.
    """
    if isinstance(source, Blade):
        # stations stand twice: a crease there must not be smoothed over
        eta = np.union1d(np.linspace(0.0, 1.0, SPANS), _beside(source.eta))
        places = np.linspace(0.0, 0.5, AROUND)
        u = np.concatenate([places, 0.5 + places[1:]])
        points, normals = source.sections(eta, u), fairness.normals(source, eta, u)
        return [Sheet(points, normals, edged=True)]
    patches = surface_of(source).surface.patches
    if not patches:
        raise RenderError(
            f"zebra: {source} holds triangles, which have no normals but their own; a STEP file "
            "or a blade has"
        )
    return [_sheet(patch) for patch in patches if not patch.rims]


def _beside(stations: Array) -> Array:
    inner = stations[(stations > 0.0) & (stations < 1.0)]
    return np.concatenate([inner - 2.0 * fairness.STEP, inner + 2.0 * fairness.STEP])


def _sheet(patch: Patch) -> Sheet:
    """Return a patch as a sheet, finer along its longer direction."""
    box = list(zip(patch.low.tolist(), patch.high.tolist(), strict=True))
    coarse = patch.grid(*(np.linspace(*ends, COARSE) for ends in box))
    sizes = [np.linalg.norm(np.diff(coarse, axis=k), axis=-1).sum(axis=k).max() for k in (0, 1)]
    counts = [SPANS if sizes[k] > LONG * sizes[1 - k] else 2 * AROUND for k in (0, 1)]
    u, v = (np.linspace(*ends, count) for ends, count in zip(box, counts, strict=True))
    uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
    points, du, dv = patch.at(uv)
    normals = patch.sign * np.cross(du, dv)
    length = np.linalg.norm(normals, axis=-1, keepdims=True)
    normals = np.divide(normals, length, out=np.zeros_like(normals), where=length > 0.0)
    shape = (len(u), len(v), 3)
    return Sheet(points.reshape(shape), normals.reshape(shape))


def draw(sheets: Sequence[Sheet], title: str, path: Path) -> None:
    """Render both sides of a blade in `BANDS` bands of its span, root first, in two lights.

    Raises
    ------
    RenderError
        If this machine cannot render.
    """
    import pyvista as pv

    require_renderer()
    points = np.concatenate([sheet.points.reshape(-1, 3) for sheet in sheets])
    edges = np.linspace(points[:, 2].min(), points[:, 2].max(), BANDS + 1)
    with quietly():
        shape = len(SIDES) * BANDS, len(LIGHTS)
        plotter = pv.Plotter(off_screen=True, window_size=list(SIZE), shape=shape, border=False)
        for column, (words, light, stripe) in enumerate(LIGHTS):
            shown = [_grid(sheet, light, stripe) for sheet in sheets]
            for row in range(len(SIDES) * BANDS):
                side, way = SIDES[row // BANDS]
                low, high = edges[row % BANDS : row % BANDS + 2]
                plotter.subplot(row, column)
                plotter.set_background(style.PAPER)
                plotter.enable_anti_aliasing("ssaa")
                for grid, sheet in zip(shown, sheets, strict=True):
                    _add(plotter, grid)
                    if sheet.edged:
                        ends = np.moveaxis(sheet.points[:, [0, -1]], 1, 0)
                        nearer = np.array([way * NEARER, 0.0, 0.0])
                        add_lines(plotter, (ends + nearer,), EDGE, EDGE_WIDTH)
                within = points[(points[:, 2] >= low) & (points[:, 2] <= high)]
                _look(plotter, within, (low, high), way)
                text = f"{side}, z = {low:.4g} to {high:.4g} m"
                text = text if row else f"{title}, {text}; {words}"
                plotter.add_text(text, position="upper_left", font_size=8, color=style.INK)
        image = image_of(plotter, f"{path}: the picture")
    save_image(image, path)


def _grid(sheet: Sheet, light: ArrayLike, stripe: float) -> Any:
    """Return a sheet as VTK draws it, with its place between a bright and a dark stripe."""
    import pyvista as pv

    grid = pv.StructuredGrid(*(np.ascontiguousarray(sheet.points[..., k]) for k in range(3)))
    grid["stripes"] = (sheet.angles(light) / stripe).ravel(order="F")
    along, around = (np.diff(sheet.points, axis=k) for k in (0, 1))
    faces = np.cross(along[:, :-1], around[:-1])
    outward = np.sum(faces * sheet.normals[:-1, :-1]) > 0.0
    grid.field_data["inside"] = ["back" if outward else "front"]
    return grid


def _add(plotter: Any, grid: Any) -> None:
    """Add a sheet in black and white, without light; the place is interpolated, not the colour."""
    low, high = (float(end) for end in grid.get_data_range("stripes"))
    first, last = 2 * int(np.floor(low / 2.0)), 2 * int(np.floor(high / 2.0)) + 2
    plotter.add_mesh(
        grid,
        scalars="stripes",
        cmap=[DARK, BRIGHT] * ((last - first) // 2),
        n_colors=last - first,
        clim=(first, last),
        lighting=False,
        interpolate_before_map=True,
        show_scalar_bar=False,
        reset_camera=False,
        render=False,
        culling=grid.field_data["inside"][0],  # else it peeps out behind the trailing edge
    )


def _look(plotter: Any, within: Array, span: tuple[float, float], way: float) -> None:
    """Look at a band of the span along x, from the suction side (1) or from the pressure side."""
    y, (low, high) = within[:, 1], span
    focus = np.array([within[:, 0].mean(), 0.5 * (y.min() + y.max()), 0.5 * (low + high)])
    away = float(np.ptp(within)) + 1.0
    plotter.camera_position = [focus + way * away * np.eye(3)[0], focus, [0.0, -way, 0.0]]
    plotter.enable_parallel_projection()
    aspect = SIZE[0] / len(LIGHTS) * len(SIDES) * BANDS / SIZE[1]
    plotter.camera.parallel_scale = 0.5 * max((high - low) / aspect, ACROSS * float(np.ptp(y)))
    plotter.camera.clipping_range = 0.01 * away, 3.0 * away
