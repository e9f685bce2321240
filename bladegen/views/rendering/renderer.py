"""Whether this machine can render, and how to render without noise.

VTK takes the display, else EGL, else OSMesa, and where none of them works it ends the process;
so each is tried before VTK is asked for a picture.
"""

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from bladegen.errors import RenderError
from bladegen.support.arrays import Indices

__all__ = ["image_of", "quietly", "require_renderer", "require_window", "shot"]

EGL_PLATFORM_DEVICE = 0x313F  # EGL_EXT_platform_device
EGL_DEVICES = 32  # more than any machine has
BLANK = 2.0  # grey levels of standard deviation below which a picture is empty
NO_RENDERER = (
    "no picture: this machine has no OpenGL to render with; on Debian: apt-get install "
    "libgl1 libegl1 libegl-mesa0 libx11-6 libexpat1 (or libosmesa6)"
)


def require_renderer() -> None:
    """Raise `RenderError` if there is nothing to render with.

    Each way is tried: libraries that load may still have no driver behind them.
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


def require_window() -> None:
    """Raise `RenderError` if no window can be opened."""
    require_renderer()
    if sys.platform == "linux" and not (_display_opens() or os.environ.get("WAYLAND_DISPLAY")):
        raise RenderError(
            "no window: there is no display here; use --screenshot FILE.png or --html FILE.html"
        )


def image_of(plotter: Any, what: str) -> Indices:
    """Render a plotter as `shot` does, and close it."""
    image = shot(plotter, what)
    plotter.close()
    return image


def shot(plotter: Any, what: str) -> Indices:
    """Render a plotter (height, width, 3), red, green and blue, 0 to 255.

    Raises
    ------
    RenderError
        If the picture came out blank; the message begins with `what`.
    """
    plotter.render()  # a screenshot alone shows what was rendered last
    image: Indices | None = plotter.screenshot(None, return_img=True)
    if image is None or float(np.std(image)) < BLANK:
        raise RenderError(f"{what} came out blank; " + NO_RENDERER)
    return image


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
