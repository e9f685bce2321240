import ctypes

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
    monkeypatch.setenv("DISPLAY", ":0")
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
