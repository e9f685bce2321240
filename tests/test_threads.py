import threading

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import bladegen as bg
from bladegen.shapes import learning
from bladegen.support.threads import one_thread


def counts():
    libraries = threadpool_info()
    return [one["num_threads"] for one in libraries if one["user_api"] == "blas"]


@pytest.fixture(autouse=True)
def two():
    with threadpool_limits(2):
        yield


def test_threads_are_given_back_when_the_last_has_left():
    before = counts()
    with one_thread():
        assert set(counts()) == {1}
        with one_thread():
            assert set(counts()) == {1}
        assert set(counts()) == {1}
    assert counts() == before


def test_another_thread_that_leaves_takes_nothing_from_others():
    before, seen = counts(), []

    def hold():
        with one_thread():
            seen.extend(counts())

    other = threading.Thread(target=hold)
    with one_thread():
        other.start()
        other.join()
        assert set(seen) == set(counts()) == {1}
    assert counts() == before


def test_an_error_gives_them_back():
    before = counts()
    with pytest.raises(ValueError, match="x"), one_thread():
        raise ValueError("x")
    assert counts() == before


def test_spaces_are_learned_and_files_written_in_one(monkeypatch, tmp_path):
    seen, mean, sections = [], learning._karcher_mean, bg.Blade.sections

    def told(what):
        def call(*given, **named):
            seen.append(max(counts()))
            return what(*given, **named)

        return call

    monkeypatch.setattr(learning, "_karcher_mean", told(mean))
    rng = np.random.default_rng(3)
    points = np.linalg.qr(np.eye(21, 2) + 0.1 * rng.normal(size=(9, 21, 2))).Q
    learning.principal(points, 2)
    monkeypatch.setattr(bg.Blade, "sections", told(sections))
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101)
    bg.export(blade, tmp_path / "x.stl", stations=20)
    assert len(seen) > 1
    assert set(seen) == {1}
