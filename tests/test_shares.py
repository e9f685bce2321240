"""Compiled loops in shares, side by side."""

import os
import subprocess
import sys
import threading
from concurrent.futures import Future

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import bladegen as bg
from bladegen.support import threads


@pytest.fixture
def three(monkeypatch):
    monkeypatch.setattr(threads, "cores", lambda: 3)
    monkeypatch.setattr(threads, "LEAST", 1)


def test_each_part_is_called_once_by_all_threads():
    called, names, both = [], set(), threading.Barrier(3)

    def call(first, step):
        if threading.current_thread().name not in names:
            names.add(threading.current_thread().name)
            both.wait(60)
        called.append((first, step))

    threads.side_by_side(call, 3)
    assert sorted(called) == [(i, 12) for i in range(12)]
    assert len(names) == 3
    assert threading.current_thread().name in names


def test_nobody_waits_for_a_thread_that_starts_late(monkeypatch):
    class Late:
        def submit(self, _):
            return Future()

    monkeypatch.setattr(threads, "_pool", Late)
    called = []
    threads.side_by_side(lambda first, step: called.append((first, step)), 2)
    assert called == [(i, 8) for i in range(8)]


def test_an_error_of_a_part_is_raised_when_all_have_ended():
    ended, both = [], threading.Barrier(2)

    def call(first, _):
        if first < 2:
            both.wait(60)
        if first == 1:
            raise ZeroDivisionError
        ended.append(first)

    with pytest.raises(ZeroDivisionError):
        threads.side_by_side(call, 2)
    assert 0 in ended
    assert not threads._pool()._work_queue.qsize()


@pytest.mark.parametrize(("given", "cores"), [("1", 1), ("3", 3), ("4,2", 4), ("99", threads.MOST)])
def test_who_sets_the_number_of_threads_is_heard(given, cores):
    code = "from bladegen.support.threads import cores, shares_of; print(cores(), shares_of(10**9))"
    where = {**os.environ, "OMP_NUM_THREADS": given}
    command = [sys.executable, "-c", code]
    told = subprocess.run(command, check=True, env=where, capture_output=True, text=True)
    assert told.stdout.split() == [str(cores), str(cores)]


def test_small_work_is_not_shared_out(monkeypatch):
    monkeypatch.setattr(threads, "cores", lambda: 8)
    assert [threads.shares_of(n * threads.LEAST) for n in (0, 1, 2, 3, 50)] == [1, 1, 2, 3, 8]


@pytest.mark.parametrize("chord_line", ["kept", "paper"])
def test_a_model_s_values_and_derivatives_are_the_same_to_the_bit(three, monkeypatch, chord_line):
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101)
    names = ("pga", "thickness", "chord", "prebend_scale")
    space, spans = bg.ShapeSpace.bundled(), np.linspace(0.0, 1.0, 8)
    model = bg.ParametricBlade(blade, space, names, spans, chord_line=chord_line)
    rng = np.random.default_rng(1)
    reach = 0.2 * (model.upper - model.lower)
    x = model.baseline + reach * rng.uniform(-1.0, 1.0, (5, len(model.names)))
    g = rng.normal(size=(5, 8, 101, 3))

    def made():
        return model.sections(x), model.jacobian(x), model.jvp(x, x), model.vjp(x, g)

    shared = made()
    monkeypatch.setattr(threads, "cores", lambda: 1)
    for one, alone in zip(shared, made(), strict=True):
        assert_array_equal(one, alone)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no forks here")
def test_a_forked_process_has_threads_of_its_own():
    threads.side_by_side(lambda first, step: None, 3)
    child = os.fork()
    if not child:
        seen = []
        threads.side_by_side(lambda first, step: seen.append(first), 3)
        os._exit(sorted(seen) != list(range(12)))
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
