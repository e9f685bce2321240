"""What a family takes is known before it is made, and is refused where it does not fit."""

import numpy as np
import pytest

import bladegen as bg
from bladegen.errors import FamilyError
from bladegen.exports.options import Options
from bladegen.families import forecasts
from bladegen.families.forecasts import Forecast, duration, free_bytes, require_room, size
from bladegen.families.order import Order
from bladegen.families.run import run

BLADE = bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=51)
BYTES = 16 * 51 * 3 * 4  # of a variant's sections


def order(folder, count, *formats):
    bounds = {"thickness": (0.95, 1.05)}
    family = bg.family(BLADE, None, count=count, bounds=bounds, spans=16)
    return Order(family, folder, formats, options=Options(stations=30))


def with_free(monkeypatch, count):
    usage = type("Usage", (), {"free": count})
    monkeypatch.setattr(forecasts.shutil, "disk_usage", lambda _: usage)


def test_what_cannot_fit_is_refused_before_a_folder_is_made(tmp_path, monkeypatch):
    with_free(monkeypatch, 10 * BYTES)
    target = tmp_path / "family"
    with pytest.raises(FamilyError, match=r"family: 11 variants take at least .* has .* free; ask"):
        run(order(target, 11), resume=False)
    assert not target.exists()


def test_millions_are_planned_and_refused_at_once(tmp_path):
    with pytest.raises(FamilyError, match=r"5000000 variants take at least .*--count"):
        run(order(tmp_path / "family", 5_000_000, "step"), jobs=2) if free_bytes(
            tmp_path
        ) < 5_000_000 * BYTES else require_room(tmp_path, 5_000_000, 10**18, at_least=True)


def test_the_first_block_says_what_the_others_take(tmp_path):
    told = []
    run(order(tmp_path / "family", 24, "stl"), foretold=told.append)
    (forecast,) = told
    assert forecast.variants == 22
    made = sum(file.stat().st_size for file in (tmp_path / "family" / "blades").glob("*.stl"))
    assert made * 22 / 24 < forecast.needed < made * 22 / 24 + 22 * (BYTES + 20_000)
    assert forecast.seconds > 0
    assert str(forecast).startswith("22 variants: about ")


def test_files_that_do_not_fit_leave_nothing_behind(tmp_path, monkeypatch):
    with_free(monkeypatch, 30 * BYTES)  # room for the sections, not for the files
    target = tmp_path / "family"
    with pytest.raises(FamilyError, match=r"22 variants take about .*--count"):
        run(order(target, 24, "stl"))
    assert list(target.iterdir()) == []
    monkeypatch.undo()
    assert run(order(target, 2)) == 2  # the folder is as new


def test_words_for_sizes_and_times():
    assert [size(n) for n in (0, 999, 1e3, 999_600, 2.5e12, 4e18)] == [
        "0 bytes", "999 bytes", "1 kB", "1 MB", "2.5 TB", "4e+03 PB"
    ]  # fmt: skip
    assert [duration(s) for s in (0.1, 89, 91, 7200, 1e6)] == [
        "1 s", "89 s", "2 min", "2 h 0 min", "12 days"
    ]  # fmt: skip
    assert str(Forecast(10, 5000, 10**9, 60.0)) == (
        "10 variants: about 5 kB on the disk, which has 1 GB free, and about 60 s"
    )


def test_the_disk_of_a_folder_to_be_made_is_that_of_its_parents(tmp_path):
    assert free_bytes(tmp_path / "a" / "b") == pytest.approx(free_bytes(tmp_path), rel=0.5)
    require_room(tmp_path / "a", 1, 1)
    assert np.isfinite(free_bytes(tmp_path))
