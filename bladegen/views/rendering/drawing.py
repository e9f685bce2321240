"""Putting surfaces and lines into a pyvista plotter, and measuring surfaces by VTK."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from bladegen.support.arrays import Array
from bladegen.surface.mesh import TriangleMesh
from bladegen.views.plots import style
from bladegen.views.rendering.cameras import ANGLE, View, camera
from bladegen.views.rendering.scene import Field

__all__ = [
    "HEADLIGHT",
    "LIGHTS",
    "add_colour_bar",
    "add_lines",
    "add_surface",
    "add_words",
    "cuts",
    "dress",
    "look",
    "poly",
    "polylines",
    "shaded",
    "signed_distances",
]

CUTS = 41  # over a mesh's span
TOWARDS_EYE = -1.0, -4.0  # depth by which lines are drawn nearer than they lie: factor, units
EDGE_ANGLE = 40.0  # degrees between facets that are shaded as an edge
LINE_SPACING = 1.35
LIGHTS = (  # from the camera's place: right, up, towards it; strength
    (-0.4, 0.5, 1.0, 0.5),
    (1.0, 0.2, 0.3, 0.3),
    (-1.0, -0.6, 0.4, 0.25),
    (0.2, -1.0, 0.5, 0.2),
)
HEADLIGHT = 0.2
QUIET = {"reset_camera": False, "render": False}  # nothing is rendered before all is there
PLAIN = {"specular": 0.25, "specular_power": 20, "ambient": 0.2}
COLOURED = {"specular": 0.05, "ambient": 0.5, "diffuse": 0.6}  # shade must not hide the colours


def poly(mesh: TriangleMesh, scale: float = 1.0) -> Any:
    """Return a mesh as pyvista's PolyData, its lengths times `scale`."""
    import pyvista as pv

    return pv.PolyData.from_regular_faces(np.array(mesh.vertices) * scale, mesh.faces)


def shaded(mesh: TriangleMesh, fields: Sequence[Field] = ()) -> Any:
    """Return a mesh with normals and fields at its points, which are doubled along edges."""
    shown = poly(mesh)
    for field in fields:
        shown[field.name] = np.array(field.values)
    return shown.compute_normals(split_vertices=True, feature_angle=EDGE_ANGLE)


def polylines(lines: Sequence[Array]) -> Any:
    """Return polylines, groups of (c, m, 3), as one PolyData."""
    import pyvista as pv

    cells, points, start = [], [], 0
    for group in lines:
        count, m, _ = group.shape
        at = start + np.arange(count * m).reshape(count, m)
        cells.append(np.concatenate([np.full((count, 1), m), at], axis=1).reshape(-1))
        points.append(group.reshape(-1, 3))
        start += count * m
    return pv.PolyData(np.concatenate(points), lines=np.concatenate(cells))


def signed_distances(of: TriangleMesh, to: TriangleMesh) -> Array:
    """Return distances [m] of one mesh's vertices to another's triangles, positive outside it."""
    measured = poly(of).compute_implicit_distance(poly(to))
    return np.asarray(measured["implicit_distance"], dtype=np.float64)


def cuts(mesh: TriangleMesh) -> Array:
    """Return where planes normal to z cut a mesh: segments (c, 2, 3)."""
    z = mesh.vertices[:, 2]
    margin = 1e-3 * float(np.ptp(z))
    planes = np.linspace(z.min() + margin, z.max() - margin, CUTS)
    whole = poly(mesh)
    found = []
    for plane in planes.tolist():
        line = whole.slice(normal="z", origin=(0.0, 0.0, plane))
        ends = np.asarray(line.lines).reshape(-1, 3)[:, 1:]  # VTK cuts triangles to segments
        found.append(np.asarray(line.points, dtype=np.float64)[ends])
    return np.concatenate(found)


def dress(plotter: Any) -> None:
    """Set background, anti-aliasing and lights."""
    import pyvista as pv

    plotter.set_background(style.PAPER)
    plotter.enable_anti_aliasing("ssaa")
    plotter.remove_all_lights()
    for *position, strength in LIGHTS:
        light = pv.Light(light_type="camera light", intensity=strength)
        light.position = position
        plotter.add_light(light)
    plotter.add_light(pv.Light(light_type="headlight", intensity=HEADLIGHT))


def look(plotter: Any, points: Array, view: View, aspect: float) -> None:
    """Turn a plotter's camera so that it sees all points."""
    eye, focus, up = camera(points, view, aspect)
    plotter.camera_position = [eye, focus, up]
    plotter.camera.parallel_projection = view.parallel
    plotter.camera.parallel_scale = float(np.linalg.norm(eye - focus)) * np.tan(
        np.radians(ANGLE / 2.0)
    )
    plotter.camera.view_angle = ANGLE
    towards = (eye - focus) / np.linalg.norm(eye - focus)
    depth = (eye - points) @ towards
    margin = 0.1 * float(np.ptp(points))  # for what stands beside the surface
    nearest = max(float(depth.min()) - margin, 1e-3 * float(depth.max()))
    plotter.camera.clipping_range = nearest, float(depth.max()) + margin


def add_surface(
    plotter: Any, shown: Any, field: "Field | None" = None, *, name: str | None = None
) -> Any:
    """Add what `shaded` returned, plain or coloured by a field; return the actor.

    It takes the place of what was added with the same name before.
    """
    common = {"smooth_shading": False, "show_scalar_bar": False, "name": name, **QUIET}
    if field is None:
        actor = plotter.add_mesh(shown, color=style.SURFACE, scalars=None, **common, **PLAIN)
    else:
        actor = plotter.add_mesh(
            shown,
            scalars=field.name,
            cmap=field.colours,
            clim=(field.low, field.high),
            copy_mesh=True,
            **common,
            **COLOURED,
        )
    actor.prop.interpolation = "Phong"  # by the mesh's own normals; pyvista makes others
    return actor


def add_lines(
    plotter: Any, lines: Sequence[Array], colour: str, width: float, *, name: str | None = None
) -> Any:
    """Add polylines, in place of those with the same name; return the actor."""
    actor = plotter.add_mesh(
        polylines(lines),
        color=colour,
        line_width=width,
        lighting=False,
        name=name,
        **QUIET,
    )
    actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(*TOWARDS_EYE)
    return actor


def add_words(
    plotter: Any, text: str, position: tuple[int, int], size: int, *, name: str | None = None
) -> Any:
    """Add lines of text at pixels from the lower left, in place of those with the same name."""
    actor = plotter.add_text(
        text, position=position, font_size=size, color=style.INK, name=name, render=False
    )
    actor.GetTextProperty().SetLineSpacing(LINE_SPACING)
    return actor


def add_colour_bar(plotter: Any, actor: Any, label: str, *, wide: bool = True) -> Any:
    """Add a legend of an actor's colours; return its actor."""
    return plotter.add_scalar_bar(
        title=f"{label}\n",  # the empty line keeps title and numbers apart
        mapper=actor.mapper,
        color=style.INK,
        fmt="%.5g",
        n_labels=5,
        vertical=False,
        title_font_size=18,
        label_font_size=16,
        width=0.34 if wide else 0.5,
        height=0.09,
        position_x=0.62 if wide else 0.25,
        position_y=0.04,
    )
