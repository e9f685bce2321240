"""Pictures of blades by pyvista: off-screen to a PNG, in a window, or as VTK data.

Lengths are metres, blade frame.  pyvista is imported when first needed.
"""

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.arrays import Array
from bladegen.blade import Blade
from bladegen.errors import RenderError
from bladegen.mesh import TriangleMesh, from_blade

__all__ = ["picture", "require_renderer", "show", "write_vtp"]

SIZE = (1920, 1080)
SECTIONS = 240
BACKGROUND = "white"
SURFACE = "#c9d3dc"
INK = "#22303c"
STATION = "#d55e00"  # vermillion of the Okabe-Ito palette, told apart by everyone
AXIS = "#0072b2"
EDGE_ANGLE = 40.0  # degrees between facets that are shaded as an edge
BLANK = 2.0  # grey levels of standard deviation below which a picture is empty
NO_RENDERER = (
    "no picture: this machine has no OpenGL to render with; on Debian: apt-get install "
    "libgl1 libegl1 libegl-mesa0 libx11-6 libexpat1 (or libosmesa6)"
)


def require_renderer() -> None:
    """Raise `RenderError` if there is nothing to render with.

    VTK falls back from a display to EGL and OSMesa, and gives blank pictures and warnings,
    or ends the process, where it finds none of them.
    """
    if sys.platform != "linux":
        return
    found = any(
        _loads(name) for name in ("libEGL.so.1", "libOSMesa.so.8", "libOSMesa.so.6")
    ) or bool(os.environ.get("DISPLAY"))
    if not (found and _loads("libGL.so.1")):
        raise RenderError(NO_RENDERER)


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def picture(blade: Blade, path: Path, *, size: tuple[int, int] = SIZE) -> None:
    """Render a blade to a PNG: perspective above, planform and side view below, to scale.

    Raises
    ------
    RenderError
        If this machine cannot render, or the picture came out blank.
    """
    require_renderer()
    with _quietly():
        plotter = _figure(blade, size)
        image = plotter.screenshot(None, return_img=True)
        plotter.close()
    if image is None or float(np.std(image)) < BLANK:
        raise RenderError(f"{path}: the picture came out blank; " + NO_RENDERER)
    from PIL import Image

    Image.fromarray(image).save(path, format="PNG", optimize=True)


def show(blade: Blade) -> None:
    """Open an interactive window and wait until it is closed."""
    require_renderer()
    if sys.platform == "linux" and not any(
        os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY")
    ):
        raise RenderError("no window: there is no display here; use --screenshot FILE.png")
    plotter = _scene(blade, off_screen=False)
    plotter.show(title=f"bladegen - {blade.name}")


def write_vtp(mesh: TriangleMesh, path: Path, *, scale: float = 1.0) -> None:
    """Write a mesh as VTK poly data, its lengths times `scale`."""
    _poly(mesh, scale).save(str(path))


def _poly(mesh: TriangleMesh, scale: float = 1.0) -> Any:
    import pyvista as pv

    return pv.PolyData.from_regular_faces(np.array(mesh.vertices) * scale, mesh.faces)


def _scene(blade: Blade, *, off_screen: bool) -> Any:
    """A plotter with the blade alone."""
    import pyvista as pv

    plotter = pv.Plotter(off_screen=off_screen, window_size=list(SIZE))
    _dress(plotter)
    _add_blade(plotter, blade)
    _add_axes(plotter)
    plotter.camera_position = _perspective(blade)
    return plotter


def _figure(blade: Blade, size: tuple[int, int]) -> Any:
    """The plotter of `picture`: a large view over two strips that share one scale."""
    import pyvista as pv

    plotter = pv.Plotter(
        off_screen=True,
        window_size=list(size),
        shape=(3, 1),
        row_weights=[0.54, 0.23, 0.23],
        border=False,
    )
    plotter.subplot(0, 0)
    _dress(plotter)
    _add_blade(plotter, blade)
    plotter.camera_position = _perspective(blade)
    plotter.camera.zoom(1.0)
    plotter.add_text(
        _caption(blade),
        position=(24, int(0.54 * size[1]) - 84),
        font_size=13,
        color=INK,
        viewport=False,
    )

    for row, (title, view) in enumerate(
        (("suction side: chord over span", "planform"), ("from the trailing edge", "side")), start=1
    ):
        plotter.subplot(row, 0)
        _dress(plotter)
        _add_blade(plotter, blade)
        _strip_view(plotter, blade, view, size)
        _add_ruler(plotter, blade, view)
        plotter.add_text(title, position=(24, int(0.23 * size[1]) - 40), font_size=10, color=INK)
    return plotter


def _dress(plotter: Any) -> None:
    """Set background, anti-aliasing and lights."""
    import pyvista as pv

    plotter.set_background(BACKGROUND)
    plotter.enable_anti_aliasing("ssaa")
    plotter.remove_all_lights()
    for position, strength in (((-0.4, 0.5, 1.0), 0.65), ((1.0, 0.2, 0.3), 0.4)):
        light = pv.Light(light_type="camera light", intensity=strength)
        light.position = position
        plotter.add_light(light)
    plotter.add_light(pv.Light(light_type="headlight", intensity=0.25))


def _add_blade(plotter: Any, blade: Blade) -> None:
    """Add the surface, and the definition's stations as lines on it."""
    surface = _poly(from_blade(blade, stations=SECTIONS))
    plotter.add_mesh(
        surface,
        color=SURFACE,
        smooth_shading=True,
        split_sharp_edges=True,
        feature_angle=EDGE_ANGLE,
        specular=0.25,
        specular_power=20,
        ambient=0.18,
    )
    plotter.add_mesh(_rings(blade), color=STATION, line_width=2.5, render_lines_as_tubes=False)


def _rings(blade: Blade) -> Any:
    """The definition's stations as closed lines, a trifle outside the surface."""
    import pyvista as pv

    loops = blade.sections(blade.eta)
    centres = loops.mean(axis=1, keepdims=True)
    loops = centres + 1.004 * (loops - centres)
    closed = np.concatenate([loops, loops[:, :1]], axis=1)
    count = closed.shape[1]
    lines = np.concatenate(
        [
            np.full((len(closed), 1), count),
            np.arange(closed.shape[0] * count).reshape(len(closed), count),
        ],
        axis=1,
    )
    return pv.PolyData(closed.reshape(-1, 3), lines=lines.reshape(-1))


def _add_axes(plotter: Any) -> None:
    plotter.add_axes(
        xlabel="x suction", ylabel="y trailing edge", zlabel="z tip", color=INK, line_width=3
    )


def _perspective(blade: Blade) -> list[Array]:
    """Look from the root along the blade, at its suction side."""
    length = blade.length
    focus = np.array([0.0, 0.02 * length, 0.43 * length])
    eye = np.array([0.38 * length, 0.22 * length, 0.02 * length])
    return [eye, focus, np.array([0.5, -1.0, 0.0])]


def _strip_view(plotter: Any, blade: Blade, view: str, size: tuple[int, int]) -> None:
    """Look at the blade at right angles, root at the left, the whole length in the strip."""
    length = blade.length
    middle = np.array([0.0, 0.0, 0.5 * length])
    if view == "planform":
        position, up = np.array([length, 0.0, middle[2]]), (0.0, -1.0, 0.0)
    else:
        position, up = np.array([0.0, length, middle[2]]), (1.0, 0.0, 0.0)
    plotter.camera_position = [position, middle, up]
    plotter.enable_parallel_projection()
    width_over_height = size[0] / (0.23 * size[1])
    plotter.camera.parallel_scale = 0.5 * 1.08 * length / width_over_height


def _add_ruler(plotter: Any, blade: Blade, view: str) -> None:
    """Add a scale in metres below the blade, ticks at round lengths."""
    import pyvista as pv

    length = blade.length
    step = _round_step(length)
    marks = np.arange(0.0, length + 0.02 * step, step)
    sections = blade.sections(np.linspace(0.0, 1.0, 50))
    across = 1 if view == "planform" else 0
    low = sections[..., across].max() if view == "planform" else sections[..., across].min()
    sign = 1.0 if view == "planform" else -1.0
    base = low + sign * 0.012 * length
    ends = np.zeros((2, 3))
    ends[:, across], ends[1, 2] = base, length
    plotter.add_mesh(pv.Line(ends[0], ends[1]), color=INK, line_width=2)
    labels = np.zeros((len(marks), 3))
    labels[:, 2], labels[:, across] = marks, base + sign * 0.016 * length
    for mark in marks:
        tick = np.zeros((2, 3))
        tick[:, 2] = mark
        tick[:, across] = base, base + sign * 0.006 * length
        plotter.add_mesh(pv.Line(tick[0], tick[1]), color=INK, line_width=2)
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


def _caption(blade: Blade) -> str:
    definition = blade.definition
    eta = np.linspace(0.0, 1.0, 501)
    chord = blade.chord(eta)
    twist = np.degrees(blade.twist(np.array([0.0, 1.0])))
    tip = blade.axis(1.0)
    bend = f", prebend {tip[0]:.2f} m" if abs(tip[0]) > 0.005 else ""
    sweep = f", sweep {tip[1]:.2f} m" if abs(tip[1]) > 0.005 else ""
    title = definition.description or definition.name
    return (
        f"{title}\n{blade.length:.1f} m long, chord to {chord.max():.2f} m, twist "
        f"{twist[0]:.1f} to {twist[1]:.1f} deg{bend}{sweep}; stations of the definition marked"
    )


@contextmanager
def _quietly() -> Iterator[None]:
    """Keep VTK's warnings off the terminal; what matters is checked."""
    from vtkmodules.vtkCommonCore import vtkObject

    before = vtkObject.GetGlobalWarningDisplay()
    vtkObject.GlobalWarningDisplayOff()
    try:
        yield
    finally:
        vtkObject.SetGlobalWarningDisplay(before)
