import ctypes

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image

import bladegen as bg
from bladegen.errors import ExportError, RenderError
from bladegen.exports import marks
from bladegen.exports.provenance import made_from
from bladegen.views import preview
from bladegen.views.rendering.offsets import offsets
from bladegen.views.rendering.picture import _round_step
from bladegen.views.rendering.scene import Field
from bladegen.views.rendering.shadow import LIGHT, outline


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


def test_a_gallery_shows_each_blade_in_a_cell_of_its_own_as_the_camera_sees_it(blade):
    eta = np.linspace(0.0, 1.0, 40)
    small = blade.perturbed(chord=0.7).sections(eta)
    shown = preview.gallery(
        np.stack([blade.sections(eta), small, blade.sections(eta)]), columns=2, size=(800, 240)
    )
    inked = np.any(shown < 250, axis=2)
    one, two = inked[:120, :400], inked[:120, 400:]
    assert 0.1 < one.mean() < 0.6
    assert 0.05 < two.mean() < 0.9 * one.mean()
    assert np.abs(shown[120:, :400].astype(float) - shown[:120, :400]).mean() < 0.5
    assert not inked[120:, 400:].any()
    across = np.flatnonzero(one.any(axis=0))
    assert across[-1] - across[0] > 300  # filled, from root to tip


def test_a_gallery_colours_blades_by_how_far_they_lie_from_another(blade):
    eta = np.linspace(0.0, 1.0, 40)
    reference = blade.sections(eta)
    shown = np.stack([reference, blade.perturbed(thickness=1.1).sections(eta)])
    apart = offsets(shown, reference)
    assert np.abs(apart[0]).max() == 0.0
    assert apart[1].max() > 0.05
    made = preview.gallery(
        shown, columns=2, size=(800, 120), field=Field.within("apart", "m", apart, 0.1)
    )
    plain, coloured = np.ptp(made.astype(float), axis=2).reshape(120, 2, 400).max(axis=(0, 2))
    assert plain < 8  # white to grey where nothing moved
    assert coloured > 60


@pytest.mark.parametrize("mirrored", [False, True])
def test_offsets_of_a_wider_tube_are_what_its_radius_grew_by(mirrored):
    turn = np.pi * np.linspace(0.0, 2.0, 201) * (1.0 if mirrored else -1.0)
    circle = np.stack([np.sin(turn), np.cos(turn)], axis=-1)
    tube = np.stack([np.column_stack([circle, np.full(201, z)]) for z in (0.0, 1.0, 2.0)])
    wider = tube * [1.25, 1.25, 1.0] + [0.0, 0.0, 0.3]  # what moves along the skin does not count
    assert_allclose(offsets(wider[None], tube)[0, 1, 1:-1], 0.25, rtol=1e-3)


def test_a_blade_plots_itself_to_a_file_or_a_window(blade, tmp_path, monkeypatch):
    assert blade.plot(screenshot=tmp_path / "a.png") is None
    preview.picture(blade, tmp_path / "b.png")
    with Image.open(tmp_path / "a.png") as one, Image.open(tmp_path / "b.png") as two:
        assert one.tobytes() == two.tobytes()
    assert marks.read(tmp_path / "a.png") == made_from(blade, {})
    with pytest.raises(ExportError, match=r"screenshot: .*allowed are \.png"):
        blade.plot(screenshot=tmp_path / "a.jpg")
    asked = []
    monkeypatch.setattr(
        "bladegen.views.preview.show", lambda scene, colour: asked.append((scene.title, colour))
    )
    blade.plot(colour="curvature")
    assert len(asked) == 1
    assert asked[0][1] == "curvature"


def test_without_libraries_one_line_names_the_packages(blade, tmp_path, monkeypatch):
    def fail(name, *args):
        raise OSError(name)

    monkeypatch.setattr(ctypes, "CDLL", fail)
    with pytest.raises(RenderError, match="apt-get install libgl1 libegl1") as caught:
        preview.picture(blade, tmp_path / "blade.png")
    assert "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_colours_show_what_moved(blade, tmp_path):
    turned = blade.perturbed(twist=0.05, name="turned")
    for colour in ("plain", "distance"):
        preview.picture(
            turned, tmp_path / f"{colour}.png", baseline=blade, colour=colour, size=(800, 450)
        )
    plain, moved = (
        np.asarray(Image.open(tmp_path / f"{name}.png").convert("RGB")).astype(float)
        for name in ("plain", "distance")
    )
    purple = (moved[..., 2] > moved[..., 1] + 60) & (moved[..., 0] > moved[..., 1] + 10)
    assert np.count_nonzero(purple) > 200
    assert np.abs(plain - moved).max() > 100
    with pytest.raises(RenderError, match="colour: got 'distance', allowed are plain"):
        preview.picture(blade, tmp_path / "none.png", colour="distance")
    assert not (tmp_path / "none.png").exists()


@pytest.mark.parametrize(
    ("length", "step"), [(117.0, 10.0), (61.5, 5.0), (20.0, 2.0), (0.9, 0.1), (400.0, 50.0)]
)
def test_rulers_have_round_steps(length, step):
    assert _round_step(length) == pytest.approx(step)


def test_the_trailing_edge_is_one_unbroken_line_in_planform(blade, tmp_path):
    path = tmp_path / "blade.png"
    preview.picture(blade, path, size=(1200, 675))
    grey = np.asarray(Image.open(path).convert("L")).astype(float)
    strip = grey[365:464, 200:1100]  # the planform, above its ruler
    last = len(strip) - 1 - np.argmax(strip[::-1] < 245, axis=0)
    ends = [strip[row - 3 : row + 1, column].min() for column, row in enumerate(last)]
    assert max(ends) < 200  # the surface beside it, seen between dashes, has 209


def test_a_shadow_is_the_outline_moved_along_the_light():
    turn = np.linspace(0.0, 2.0 * np.pi, 201)
    loops = [np.column_stack([np.sin(turn), np.cos(turn), np.full(201, z)]) for z in (0.0, 5.0)]
    edge = outline(np.stack(loops), -3.0)
    assert_allclose(edge[:, 1].min(), -np.hypot(1.0, LIGHT[1]) + 3.0 * LIGHT[1], atol=1e-3)
    assert_allclose(edge[:, 1].max(), np.hypot(1.0, LIGHT[1]) + 3.0 * LIGHT[1], atol=1e-3)
    assert np.ptp(edge[:, 0]) == pytest.approx(5.0, abs=0.2)
