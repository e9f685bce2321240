import ctypes
import os
import subprocess
import sys

import numpy as np
import pytest

from bladegen.errors import RenderError
from bladegen.views.rendering import renderer

RENDER = (
    "import sys; from pathlib import Path; import bladegen as bg\n"
    "from bladegen.views import preview\n"
    "blade = bg.Blade.from_definition(bg.read('nrel5mw'), landmarks=51)\n"
    "try:\n    preview.picture(blade, Path(sys.argv[1]), size=(640, 360))\n"
    "except bg.BladegenError as error:\n    print(error); sys.exit(1)"
)


def rendered(path, **environment):
    """A picture made in a process of its own, since VTK may end it."""
    inherited = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    command = [sys.executable, "-c", RENDER, str(path)]
    return subprocess.run(
        command, env=inherited | environment, capture_output=True, text=True, check=False
    )


@pytest.mark.skipif(renderer._osmesa_loads(), reason="OSMesa renders without EGL")
@pytest.mark.parametrize("display", [{}, {"DISPLAY": ":77"}])
def test_egl_without_a_driver_is_an_error_and_no_crash(display, tmp_path):
    done = rendered(tmp_path / "a.png", __EGL_VENDOR_LIBRARY_FILENAMES=os.devnull, **display)
    assert (done.returncode, done.stderr) == (1, "")
    assert done.stdout == renderer.NO_RENDERER + "\n"
    assert list(tmp_path.iterdir()) == []


def test_a_picture_does_not_need_the_display_it_is_told_of(tmp_path):
    done = rendered(tmp_path / "a.png", DISPLAY=":77")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert (tmp_path / "a.png").exists()


@pytest.mark.parametrize("missing", ["eglQueryDevicesEXT", "eglGetPlatformDisplayEXT"])
def test_old_egl_is_no_renderer(missing, monkeypatch):
    class Function:
        def __call__(self, name):
            return None if name.decode() == missing else 1

    class Library:
        eglGetProcAddress = Function()  # noqa: N815

    monkeypatch.setattr(ctypes, "CDLL", lambda name: Library())
    assert not renderer._egl_starts()


@pytest.mark.parametrize("opened", [None, 1])
def test_a_display_counts_when_it_opens(opened, monkeypatch):
    class Function:
        def __init__(self, result):
            self.result = result

        def __call__(self, *args):
            return self.result

    class Library:
        XOpenDisplay, XCloseDisplay = Function(opened), Function(0)

    monkeypatch.setattr(ctypes, "CDLL", lambda name: Library())
    monkeypatch.setenv("DISPLAY", ":0")
    assert renderer._display_opens() is (opened is not None)
    monkeypatch.delenv("DISPLAY")
    assert not renderer._display_opens()


def test_vtk_logs_again_after_a_picture():
    from vtkmodules.vtkCommonCore import vtkLogger

    before = vtkLogger.GetCurrentVerbosityCutoff()
    with renderer.quietly():
        assert vtkLogger.GetCurrentVerbosityCutoff() < before
    assert vtkLogger.GetCurrentVerbosityCutoff() == before


def test_blank_pictures_are_refused():
    class Blank:
        closed = False

        def render(self):
            pass

        def screenshot(self, *args, **kwargs):
            return np.full((9, 9, 3), 255, np.uint8)

        def close(self):
            self.closed = True

    with pytest.raises(RenderError, match=r"^a\.png: the picture came out blank"):
        renderer.image_of(Blank(), "a.png: the picture")
