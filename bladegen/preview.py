"""Pictures of blades by pyvista: off-screen to a PNG, in a window, or as VTK data.

Lengths are metres, blade frame.  pyvista is imported when first needed.
"""

import ctypes
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.arrays import Array, Indices
from bladegen.blade import Blade
from bladegen.errors import RenderError
from bladegen.mesh import TriangleMesh, from_blade, surface

__all__ = ["INK", "gallery", "picture", "quietly", "require_renderer", "show", "write_vtp"]

SIZE = (1920, 1080)
SECTIONS = 240
BACKGROUND = "white"
SURFACE = "#b9c6d2"
INK = "#22303c"
STATION = "#d55e00"  # vermillion of the Okabe-Ito palette, told apart by everyone
AXIS = "#0072b2"
VIEW, STRIP = 0.54, 0.23  # shares of a figure's height
VIEW_ANGLE = 30.0  # degrees, VTK's own
FILLED = 0.92  # of a view's width or height
EDGE_ANGLE = 40.0  # degrees between facets that are shaded as an edge
EGL_PLATFORM_DEVICE = 0x313F  # EGL_EXT_platform_device
EGL_DEVICES = 32  # more than any machine has
BLANK = 2.0  # grey levels of standard deviation below which a picture is empty
NO_RENDERER = (
    "no picture: this machine has no OpenGL to render with; on Debian: apt-get install "
    "libgl1 libegl1 libegl-mesa0 libx11-6 libexpat1 (or libosmesa6)"
)


def require_renderer() -> None:
    """Raise `RenderError` if there is nothing to render with.

    VTK takes the display, else EGL, else OSMesa, and where none of them works it ends the
    process.  So each is tried: libraries that load may still have no driver behind them.
    """
    if sys.platform != "linux":
        return
    if not (_load("libGL.so.1") and (_egl_starts() or _display_opens() or _osmesa_loads())):
        raise RenderError(NO_RENDERER)


def _load(library: str) -> ctypes.CDLL | None:
    try:
        return ctypes.CDLL(library)
    except OSError:
        return None


def _egl_starts() -> bool:
    """Tell whether any EGL device can be initialised."""
    egl = _load("libEGL.so.1")
    if egl is None:
        return False
    pointer, many = ctypes.c_void_p, EGL_DEVICES
    address = egl.eglGetProcAddress
    address.argtypes, address.restype = [ctypes.c_char_p], pointer
    query, display_of = address(b"eglQueryDevicesEXT"), address(b"eglGetPlatformDisplayEXT")
    if not (query and display_of):
        return False
    devices, count = (pointer * many)(), ctypes.c_int(0)
    prototype = ctypes.CFUNCTYPE(ctypes.c_uint, ctypes.c_int, pointer, pointer)
    if not prototype(query)(many, devices, ctypes.addressof(count)):
        return False
    open_display = ctypes.CFUNCTYPE(pointer, ctypes.c_uint, pointer, pointer)(display_of)
    egl.eglInitialize.argtypes = [pointer] * 3
    displays = [open_display(EGL_PLATFORM_DEVICE, devices[i], None) for i in range(count.value)]
    return any(display and egl.eglInitialize(display, None, None) for display in displays)


def _display_opens() -> bool:
    """Tell whether an X server answers; DISPLAY alone may be left over from another session."""
    x11 = _load("libX11.so.6") if os.environ.get("DISPLAY") else None
    if x11 is None:
        return False
    x11.XOpenDisplay.argtypes, x11.XOpenDisplay.restype = [ctypes.c_char_p], ctypes.c_void_p
    x11.XCloseDisplay.argtypes = [ctypes.c_void_p]
    display = x11.XOpenDisplay(None)
    if display:
        x11.XCloseDisplay(display)
    return bool(display)


def _osmesa_loads() -> bool:
    return any(_load(name) for name in ("libOSMesa.so.8", "libOSMesa.so.6"))


def picture(blade: Blade, path: Path, *, size: tuple[int, int] = SIZE) -> None:
    """Render a blade to a PNG: perspective above, planform and side view below, to scale.

    Raises
    ------
    RenderError
        If this machine cannot render, or the picture came out blank.
    """
    require_renderer()
    with quietly():
        plotter = _figure(blade, size)
        image = plotter.screenshot(None, return_img=True)
        plotter.close()
    if image is None or float(np.std(image)) < BLANK:
        raise RenderError(f"{path}: the picture came out blank; " + NO_RENDERER)
    from PIL import Image

    Image.fromarray(image).save(path, format="PNG", optimize=True)


def gallery(
    sections: Array, names: Sequence[str], *, columns: int, size: tuple[int, int]
) -> Indices:
    """Render blades given by their sections (b, k, n, 3) side by side, all seen alike.

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
    with quietly():
        plotter = pv.Plotter(
            off_screen=True, window_size=list(size), shape=(rows, columns), border=False
        )
        aspect = size[0] * rows / (size[1] * columns)
        points = sections[:, :, ::10].reshape(-1, 3)
        for place, (loops, name) in enumerate(zip(sections, names, strict=True)):
            plotter.subplot(*divmod(place, columns))
            _dress(plotter)
            _add_surface(plotter, surface(loops))
            plotter.camera_position = _seen_from(points, aspect)
            plotter.add_text(name, position=(10, 6), font_size=8, color=INK)
        image = plotter.screenshot(None, return_img=True)
        plotter.close()
    if image is None or float(np.std(image)) < BLANK:
        raise RenderError("the gallery came out blank; " + NO_RENDERER)
    shown: Indices = image
    return shown


def show(blade: Blade) -> None:
    """Open an interactive window and wait until it is closed."""
    require_renderer()
    if sys.platform == "linux" and not (_display_opens() or os.environ.get("WAYLAND_DISPLAY")):
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
    plotter.camera_position = _perspective(blade, SIZE[0] / SIZE[1])
    return plotter


def _figure(blade: Blade, size: tuple[int, int]) -> Any:
    """The plotter of `picture`: a large view over two strips that share one scale."""
    import pyvista as pv

    plotter = pv.Plotter(
        off_screen=True,
        window_size=list(size),
        shape=(3, 1),
        row_weights=[VIEW, STRIP, STRIP],
        border=False,
    )
    plotter.subplot(0, 0)
    _dress(plotter)
    _add_blade(plotter, blade)
    plotter.camera_position = _perspective(blade, size[0] / (VIEW * size[1]))
    plotter.add_text(
        _caption(blade),
        position=(24, int(VIEW * size[1]) - 84),
        font_size=13,
        color=INK,
        viewport=False,
    )

    for row, (title, view) in enumerate(
        (("planform, suction side", "planform"), ("edgewise, trailing edge", "side")), start=1
    ):
        plotter.subplot(row, 0)
        _dress(plotter)
        _add_blade(plotter, blade)
        _strip_view(plotter, blade, view, size)
        plotter.add_text(
            title, position=(int(0.8 * size[0]), int(STRIP * size[1]) - 48), font_size=10, color=INK
        )
    return plotter


def _dress(plotter: Any) -> None:
    """Set background, anti-aliasing and lights."""
    import pyvista as pv

    plotter.set_background(BACKGROUND)
    plotter.enable_anti_aliasing("ssaa")
    plotter.remove_all_lights()
    for position, strength in (((-0.4, 0.5, 1.0), 0.55), ((1.0, 0.2, 0.3), 0.35)):
        light = pv.Light(light_type="camera light", intensity=strength)
        light.position = position
        plotter.add_light(light)
    plotter.add_light(pv.Light(light_type="headlight", intensity=0.22))


def _add_blade(plotter: Any, blade: Blade) -> None:
    """Add the surface, and the definition's stations as lines on it."""
    _add_surface(plotter, from_blade(blade, stations=SECTIONS))
    plotter.add_mesh(_rings(blade), color=STATION, line_width=2.5, render_lines_as_tubes=False)


def _add_surface(plotter: Any, mesh: TriangleMesh) -> None:
    plotter.add_mesh(
        _poly(mesh),
        color=SURFACE,
        smooth_shading=True,
        split_sharp_edges=True,
        feature_angle=EDGE_ANGLE,
        specular=0.25,
        specular_power=20,
        ambient=0.18,
    )


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


def _perspective(blade: Blade, aspect: float) -> list[Array]:
    """Look at the suction side from the root's end, as near as the whole blade can be seen."""
    return _seen_from(blade.sections(np.linspace(0.0, 1.0, 60))[:, ::10].reshape(-1, 3), aspect)


def _seen_from(points: Array, aspect: float) -> list[Array]:
    """Return a camera that sees all points from the suction side and the root's end."""
    towards, up = np.array([0.8, 0.34, -0.5]), np.array([0.35, -1.0, 0.0])
    towards = towards / np.linalg.norm(towards)
    right = np.cross(up, towards)
    right = right / np.linalg.norm(right)
    axes = np.stack([right, np.cross(towards, right), towards], axis=1)
    reach = np.tan(np.radians(VIEW_ANGLE / 2.0)) * FILLED * np.array([aspect, 1.0])
    focus, distance = points.mean(axis=0), 0.0
    for _ in range(12):  # centring changes the distance, and the other way round
        seen = (points - focus) @ axes
        distance = float(np.max(seen[:, 2:] + np.abs(seen[:, :2]) / reach))
        angles = seen[:, :2] / (distance - seen[:, 2:])
        focus = focus + axes[:, :2] @ (0.5 * distance * (angles.max(axis=0) + angles.min(axis=0)))
    return [focus + distance * towards, focus, up]


def _strip_view(plotter: Any, blade: Blade, view: str, size: tuple[int, int]) -> None:
    """Look at the blade at right angles, root at the left, over a ruler in metres."""
    length = blade.length
    across, away = (1, 0) if view == "planform" else (0, 1)
    down = 1.0 if view == "planform" else -1.0  # y points down in one view, x up in the other
    seen = down * blade.sections(np.linspace(0.0, 1.0, 50))[..., across]
    base = float(seen.max()) + 0.012 * length
    middle = np.zeros(3)
    middle[across] = down * 0.5 * (float(seen.min()) - 0.012 * length + base + 0.03 * length)
    middle[2] = 0.5 * length
    eye, up = middle.copy(), np.zeros(3)
    eye[away] += length
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


def _caption(blade: Blade) -> str:
    definition = blade.definition
    eta = np.linspace(0.0, 1.0, 501)
    chord = blade.chord(eta)
    twist = np.degrees(blade.twist(np.array([0.0, 1.0])))
    tip = blade.axis(1.0)
    bend = f", prebend {tip[0]:.2f} m" if abs(tip[0]) > 0.005 else ""
    sweep = f", sweep {tip[1]:.2f} m" if abs(tip[1]) > 0.005 else ""
    title = definition.description or definition.name
    if blade.changes:
        title += f", perturbed: {definition.name}"
    return (
        f"{title}\n{blade.length:.1f} m long, chord to {chord.max():.2f} m, twist "
        f"{twist[0]:.1f} to {twist[1]:.1f} deg{bend}{sweep}; stations of the definition marked"
    )


@contextmanager
def quietly() -> Iterator[None]:
    """Keep VTK's warnings off the terminal; what matters is checked."""
    from vtkmodules.vtkCommonCore import vtkLogger, vtkObject

    before, level = vtkObject.GetGlobalWarningDisplay(), vtkLogger.GetCurrentVerbosityCutoff()
    vtkObject.GlobalWarningDisplayOff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        yield
    finally:
        vtkLogger.SetStderrVerbosity(vtkLogger.ConvertToVerbosity(level))
        vtkObject.SetGlobalWarningDisplay(before)
