"""Pictures of blades as PNG: one with three views to scale, many side by side, and one view."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.support.arrays import Array, Indices
from bladegen.support.files import require_suffix
from bladegen.surface.mesh import TriangleMesh, topology
from bladegen.surface.regions import REGIONS
from bladegen.surface.vtk_files import save
from bladegen.views.plots.style import INK
from bladegen.views.rendering.blade_scene import scene_of, thinning
from bladegen.views.rendering.cameras import VIEWS, View, perspective
from bladegen.views.rendering.drawing import (
    add_colour_bar,
    add_lines,
    add_surface,
    add_words,
    dress,
    look,
    poly,
    shaded,
)
from bladegen.views.rendering.renderer import image_of, quietly, require_renderer
from bladegen.views.rendering.scene import Field, Scene
from bladegen.views.rendering.shadow import add_shadow

__all__ = ["gallery", "picture", "save_image", "write_vtp"]

SIZE = (1920, 1080)
VIEW, STRIP = 0.54, 0.23  # shares of a figure's height
FAR = 1000.0  # half heights of a small picture: what shines then does so alike in all
SMALL = 101  # landmarks of small pictures, about
SECTIONS = 240  # of the shadow and the trailing edge
EDGE = "#5f6b78"  # of the trailing edge, whose base is narrower than a pixel
EDGE_WIDTH = 1.5  # pixels
NARROW = 0.002  # of the length, a base of three pixels
ROUND = 0.95  # relative thickness of sections without an edge
OBLIQUE = VIEWS["oblique"]
LYING = View((0.72, 0.42, -0.62), (0.35, -1.0, 0.0), parallel=False)  # fills a picture of 16 : 5


def picture(
    blade: Blade,
    path: Path,
    *,
    baseline: Blade | None = None,
    colour: str = "plain",
    size: tuple[int, int] = SIZE,
) -> None:
    """Render a blade to a PNG: perspective above, planform and side view below, to scale.

    Parameters
    ----------
    blade : Blade
        What is shown.
    path : Path
        The PNG.
    baseline : Blade, optional
        What `blade` was perturbed from; needed for distances.
    colour : str
        "plain", "curvature" or "distance".
    size : (int, int)
        Pixels.

    Raises
    ------
    RenderError
        If this machine cannot render, there is no such colour, or the picture came out blank.
    """
    require_renderer()
    scene = scene_of(blade, baseline, colours=(colour,))
    field = None if colour == "plain" else scene.field(colour)
    with quietly():
        image = image_of(_figure(blade, scene, field, size), f"{path}: the picture")
    save_image(image, path)


def save_image(image: Indices, path: Path) -> None:
    """Write an image (height, width, 3) as a PNG.

    Raises
    ------
    ExportError
        If the file's name does not end in .png.
    """
    require_suffix(path, (".png",))
    from PIL import Image

    Image.fromarray(image).save(path, format="PNG", optimize=True)


def gallery(
    sections: Array, *, columns: int, size: tuple[int, int], field: Field | None = None
) -> Indices:
    """Render blades given by their sections (b, k, n, 3) side by side, all seen alike.

    They are one mesh in one view: each blade is brought to perspective first, then seen in
    parallel, moved to its own cell, row by row from the upper left.

    Parameters
    ----------
    sections : (b, k, n, 3) array
        Of blades [m].
    columns : int
        Blades side by side.
    size : (int, int)
        Pixels.
    field : Field, optional
        What colours them: its values are (b, k, n).

    Returns
    -------
    (height, width, 3) array
        Red, green and blue, 0 to 255.

    Raises
    ------
    RenderError
        If this machine cannot render, or the picture came out blank.
    """
    import pyvista as pv

    require_renderer()
    rows = -(-len(sections) // columns)
    aspect = size[0] * rows / (size[1] * columns)
    seen = perspective(sections[:, :, ::10].reshape(-1, 3), OBLIQUE, aspect)
    with quietly():
        shown = []
        thin = thinning(sections.shape[2], SMALL)
        for place, loops in enumerate(sections[:, :, ::thin]):
            points, used, faces, regions = topology(loops)
            own: tuple[Field, ...] = ()
            if field is not None:
                own = (replace(field, values=field.values[place, :, ::thin].reshape(-1)[used]),)
            one = shaded(TriangleMesh(points[used], faces, None, regions), own)
            row, column = divmod(place, columns)
            cell = np.array([2.0 * column * aspect, -2.0 * row, 0.0])
            points, normals = seen(np.asarray(one.points), np.asarray(one.point_normals))
            one.points, one.point_data.active_normals = points + cell, normals
            shown.append(one)
        plotter = pv.Plotter(off_screen=True, window_size=list(size), border=False)
        dress(plotter)
        add_surface(plotter, pv.PolyData().append_polydata(*shown), field)
        middle = np.array([(columns - 1) * aspect, 1.0 - rows, 0.0])
        eye = middle + np.array([0.0, 0.0, FAR])
        plotter.camera_position = [eye, middle, [0.0, 1.0, 0.0]]
        plotter.enable_parallel_projection()
        plotter.camera.parallel_scale = float(rows)
        plotter.camera.clipping_range = FAR - 2.0, FAR + 2.0
        return image_of(plotter, "the gallery")


def write_vtp(mesh: TriangleMesh, path: Path, *, scale: float = 1.0) -> None:
    """Write a mesh as VTK poly data, lengths times `scale`.

    With eta and u of points, regions of cells and these regions' names, where it has them.
    """
    made = poly(mesh, scale)
    if mesh.places is not None:
        made["eta"], made["u"] = (np.array(column) for column in mesh.places.T)
    if mesh.regions is not None:
        made.cell_data["region"] = np.array(mesh.regions, dtype=np.int32)
        made.field_data["regions"] = list(REGIONS)
    save(made, path)


def _figure(blade: Blade, scene: Scene, field: Field | None, size: tuple[int, int]) -> Any:
    """The plotter of `picture`: a large view over two strips that share one scale."""
    import pyvista as pv

    plotter = pv.Plotter(
        off_screen=True,
        window_size=list(size),
        shape=(3, 1),
        row_weights=[VIEW, STRIP, STRIP],
        border=False,
    )
    shown = shaded(scene.surface, scene.fields)
    sections = blade.sections(np.linspace(0.0, 1.0, SECTIONS))
    edge = _thin_edge(blade, sections)
    plotter.subplot(0, 0)
    actor = _add_blade(plotter, scene, shown, field, edge)
    look(plotter, scene.surface.vertices, LYING, size[0] / (VIEW * size[1]))
    add_shadow(plotter, sections)
    marked = "; stations of the definition marked"
    place = 24, int(VIEW * size[1]) - 88
    add_words(plotter, f"{scene.title}\n{scene.caption}{marked}", place, 13)
    if field is not None:
        add_colour_bar(plotter, actor, field.label)

    for row, (title, view) in enumerate(
        (("planform, suction side", "planform"), ("edgewise, trailing edge", "side")), start=1
    ):
        plotter.subplot(row, 0)
        _add_blade(plotter, scene, shown, field, edge)
        _strip_view(plotter, blade, view, size)
        plotter.add_text(
            title, position=(int(0.8 * size[0]), int(STRIP * size[1]) - 48), font_size=10, color=INK
        )
    return plotter


def _thin_edge(blade: Blade, sections: Array) -> Array:
    """Return lines (3, m, 3) over the trailing edge, from where its base is narrow to the tip."""
    ends = sections[:, [0, -1]]
    wide = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=-1) > NARROW * blade.length
    wide |= blade.relative_thickness(np.linspace(0.0, 1.0, len(sections))) > ROUND
    first = min(int(np.flatnonzero(wide).max(initial=-1)) + 1, len(sections) - 2)
    lines = np.stack([ends[:, 0], ends.mean(axis=1), ends[:, 1]])
    return lines[:, first:]


def _add_blade(
    plotter: Any, scene: Scene, shown: Any, field: Field | None, trailing_edge: Array
) -> Any:
    """Add the surface; on it its trailing edge and the definition's stations as lines."""
    dress(plotter)
    actor = add_surface(plotter, shown, field)
    add_lines(plotter, (trailing_edge,), EDGE, EDGE_WIDTH)
    for layer in scene.layers:
        if layer.name == "stations":
            add_lines(plotter, layer.lines, layer.colour if field is None else INK, layer.width)
    return actor


def _strip_view(plotter: Any, blade: Blade, view: str, size: tuple[int, int]) -> None:
    """Look at the blade at right angles, root at the left, over a ruler in metres."""
    length = blade.length
    across, away = (1, 0) if view == "planform" else (0, 1)
    # y points down in one view; in the other x points up, or down where one looks from -y
    down = 1.0 if view == "planform" or blade.mirrored else -1.0
    behind = -1.0 if blade.mirrored and view == "side" else 1.0  # where the trailing edge lies
    seen = down * blade.sections(np.linspace(0.0, 1.0, 50))[..., across]
    base = float(seen.max()) + 0.012 * length
    middle = np.zeros(3)
    middle[across] = down * 0.5 * (float(seen.min()) - 0.012 * length + base + 0.03 * length)
    middle[2] = 0.5 * length
    eye, up = middle.copy(), np.zeros(3)
    eye[away] += behind * length
    up[across] = -down
    plotter.camera_position = [eye, middle, up]
    plotter.enable_parallel_projection()
    width_over_height = size[0] / (STRIP * size[1])
    plotter.camera.parallel_scale = 0.5 * 1.08 * length / width_over_height
    _add_ruler(plotter, length, across, down * base, down)


def _add_ruler(plotter: Any, length: float, across: int, base: float, down: float) -> None:
    """Add a scale along z with ticks at round lengths, at `base` on the axis `across`."""
    import pyvista as pv

    marks = np.arange(0.0, length + 1e-9, _round_step(length))
    ticks = np.zeros((len(marks) + 1, 2, 3))
    ticks[:-1, :, 2] = marks[:, None]
    ticks[:-1, :, across] = base, base + down * 0.006 * length
    ticks[-1, :, 2], ticks[-1, :, across] = (0.0, length), base
    segments = pv.line_segments_from_points(ticks.reshape(-1, 3))
    plotter.add_mesh(segments, color=INK, line_width=2)
    labels = ticks[:-1, 1].copy()
    labels[:, across] += down * 0.011 * length
    plotter.add_point_labels(
        labels,
        [f"{mark:g} m" for mark in marks],
        font_size=15,
        text_color=INK,
        shape=None,
        show_points=False,
        always_visible=True,
        justification_horizontal="center",
        justification_vertical="center",
    )


def _round_step(length: float) -> float:
    """Return 1, 2 or 5 times a power of ten that divides a length in about ten."""
    power = 10.0 ** np.floor(np.log10(length / 10.0))
    return float(min((1.0, 2.0, 5.0, 10.0), key=lambda f: abs(f * power - length / 10.0)) * power)
