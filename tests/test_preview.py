import ctypes
import os
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

import bladegen as bg
from bladegen import preview
from bladegen.errors import RenderError


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("iea15mw"), landmarks=101)


def test_a_picture_shows_the_blade(blade, tmp_path):
    path = tmp_path / "blade.png"
    preview.picture(blade, path, size=(1200, 675))
    image = np.asarray(Image.open(path).convert("RGB")).astype(float)
    assert image.shape == (675, 1200, 3)
    background = np.all(image > 250, axis=2)
    assert 0.5 < background.mean() < 0.95
    for top, bottom in ((0, 362), (362, 519), (519, 675)):  # each of the three views
        assert not background[top:bottom].all()
    station = np.array([0xD5, 0x5E, 0x00])
    assert np.count_nonzero(np.abs(image - station).max(axis=2) < 40) > 50


def test_without_libraries_one_line_names_the_packages(blade, tmp_path, monkeypatch):
    def fail(name, *args):
        raise OSError(name)

    monkeypatch.setattr(ctypes, "CDLL", fail)
    with pytest.raises(RenderError, match="apt-get install libgl1 libegl1") as caught:
        preview.picture(blade, tmp_path / "blade.png")
    assert "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


RENDER = (
    "import sys; from pathlib import Path; import bladegen as bg; from bladegen import preview\n"
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


@pytest.mark.skipif(preview._osmesa_loads(), reason="OSMesa renders without EGL")
@pytest.mark.parametrize("display", [{}, {"DISPLAY": ":77"}])
def test_egl_without_a_driver_is_an_error_and_no_crash(display, tmp_path):
    done = rendered(tmp_path / "a.png", __EGL_VENDOR_LIBRARY_FILENAMES=os.devnull, **display)
    assert (done.returncode, done.stderr) == (1, "")
    assert done.stdout == preview.NO_RENDERER + "\n"
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
    assert not preview._egl_starts()


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
    assert preview._display_opens() is (opened is not None)
    monkeypatch.delenv("DISPLAY")
    assert not preview._display_opens()


def test_vtk_logs_again_after_a_picture():
    from vtkmodules.vtkCommonCore import vtkLogger

    before = vtkLogger.GetCurrentVerbosityCutoff()
    with preview.quietly():
        assert vtkLogger.GetCurrentVerbosityCutoff() < before
    assert vtkLogger.GetCurrentVerbosityCutoff() == before


def test_blank_pictures_are_refused(blade, tmp_path, monkeypatch):
    class Blank:
        def screenshot(self, *args, **kwargs):
            return np.full((9, 9, 3), 255, np.uint8)

        def close(self):
            pass

    monkeypatch.setattr(preview, "_figure", lambda *_: Blank())
    with pytest.raises(RenderError, match="came out blank"):
        preview.picture(blade, tmp_path / "blade.png")
    assert list(tmp_path.iterdir()) == []


def test_without_a_display_a_window_is_refused(blade, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(RenderError, match="no display here; use --screenshot"):
        preview.show(blade)


def test_a_window_opens_with_the_blade_in_it(blade, monkeypatch):
    import pyvista

    shown = []
    monkeypatch.setattr(preview, "_display_opens", lambda: True)
    monkeypatch.setattr(pyvista.Plotter, "show", lambda self, **options: shown.append(options))
    original = pyvista.Plotter.__init__

    def off_screen(self, *args, **options):
        original(self, *args, **{**options, "off_screen": True})

    monkeypatch.setattr(pyvista.Plotter, "__init__", off_screen)
    preview.show(blade)
    assert shown == [{"title": "bladegen - iea15mw"}]


@pytest.mark.parametrize(
    ("length", "step"), [(117.0, 10.0), (61.5, 5.0), (20.0, 2.0), (0.9, 0.1), (400.0, 50.0)]
)
def test_rulers_have_round_steps(length, step):
    assert preview._round_step(length) == pytest.approx(step)
