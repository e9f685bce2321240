from itertools import pairwise

import imageio_ffmpeg as reader
import numpy as np
import pytest
from PIL import Image

import bladegen as bg
from bladegen.errors import BladegenError, DesignError, ExportError, RenderError
from bladegen.views import sweep

SIZE = (640, 360)


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=401)


@pytest.fixture(scope="module")
def space():
    return bg.ShapeSpace.bundled()


@pytest.fixture(scope="module")
def images(blade, space):
    told = []
    motion = sweep.Motion(blade, space, {"t2": (-0.06, 0.06), "twist": (-0.02, 0.02)}, 6)
    found = list(sweep.frames(motion, size=SIZE, progress=told.append))
    assert told == [1, 2, 3, 4, 5, 6]
    return found


@pytest.mark.parametrize("count", [4, 7, 40])
def test_the_way_there_is_the_way_back_and_starts_slowly(blade, space, count):
    shares = sweep.Motion(blade, space, {}, count).shares
    assert shares[0] == 0.0
    np.testing.assert_allclose(shares[1:], shares[1:][::-1], atol=1e-12)
    steps = np.abs(np.diff(np.append(shares, shares[0])))
    assert steps[0] == pytest.approx(steps[-1])
    assert steps.max() <= np.pi / count  # no jump where the loop closes


def test_the_ends_are_the_bounds(blade, space):
    motion = sweep.Motion(blade, space, {"t2": (-0.05, 0.06), "twist": (-0.1, 0.1)})
    low, words = motion.at(0.0)
    assert words == "t2 = -0.0500 rad, twist -5.73 deg"
    np.testing.assert_allclose(low.changes[-1]["pga"], [[0.0, -0.05, 0.0, 0.0]])
    assert low.twist(1.0) == pytest.approx(blade.twist(1.0) - 0.1)
    high, _ = motion.at(1.0)
    np.testing.assert_allclose(high.changes[-1]["pga"], [[0.0, 0.06, 0.0, 0.0]])


def test_without_bounds_the_first_mode_moves_through_half_of_the_data(blade, space):
    bounds = sweep.Motion(blade, space, {}).bounds
    assert bounds == {"t1": (0.5 * space.lower[0], 0.5 * space.upper[0])}


def test_what_cannot_be_swept_is_said_at_once(blade, space):
    with pytest.raises(DesignError, match="'t9': allowed are t1, t2"):
        sweep.Motion(blade, space, {"t9": (0.0, 0.1)})
    with pytest.raises(RenderError, match="frames: got 2, allowed is 4 to 400"):
        sweep.Motion(blade, space, {}, 2)


def test_frames_move_there_and_back(images):
    assert [image.shape for image in images] == [(360, 640, 3)] * 6
    moved = [np.abs(a.astype(int) - b).mean() for a, b in pairwise(images)]
    assert min(moved) > 0.05
    assert np.array_equal(images[1], images[5])
    assert np.array_equal(images[2], images[4])


def test_a_gif_loops_for_ever_and_keeps_the_pictures(images, tmp_path):
    sweep.write_gif(images, tmp_path / "a.gif")
    read = Image.open(tmp_path / "a.gif")
    assert (read.n_frames, read.info["loop"], read.info["duration"]) == (6, 0, 50)
    for place, image in enumerate(images):
        read.seek(place)
        off = np.abs(np.asarray(read.convert("RGB")).astype(int) - image)
        assert off.mean() < 2.5
    assert (tmp_path / "a.gif").stat().st_size < 300_000


def test_a_film_has_the_frames(images, tmp_path):
    sweep.write_mp4(images, tmp_path / "a.mp4")
    frames, seconds = reader.count_frames_and_secs(str(tmp_path / "a.mp4"))
    assert frames == 6
    assert seconds == pytest.approx(6 / 20, abs=0.1)
    read = reader.read_frames(str(tmp_path / "a.mp4"))
    assert next(read)["size"] == SIZE
    first = np.frombuffer(next(read), np.uint8).reshape(360, 640, 3)
    assert np.abs(first.astype(int) - images[0]).mean() < 4
    read.close()


def test_without_an_encoder_the_extra_is_named(images, tmp_path, monkeypatch):
    monkeypatch.setattr(sweep, "find_spec", lambda name: None)
    with pytest.raises(ExportError, match=r"pip install 'bladegen\[video\]'") as caught:
        sweep.write_mp4(images, tmp_path / "a.mp4")
    assert isinstance(caught.value, BladegenError)
    assert list(tmp_path.iterdir()) == []
