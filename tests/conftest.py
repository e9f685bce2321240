"""What tests share, and how many examples Hypothesis draws.

HYPOTHESIS_PROFILE is `steady`, the same examples on every run; `thorough`, more of them, for
`make test-all`; or `explore`, new ones each time.

Matrix products take one thread, unless OMP_NUM_THREADS says otherwise: tests run side by side
already, and threads that wait for each other spin, for two to four times the processor's time.
Python looks for garbage seldom, and never among what is loaded once all tests are collected.
"""

import gc
import importlib
import os

os.environ["OMP_NUM_THREADS"] = os.environ.get("OMP_NUM_THREADS", "1")
os.environ["BLADEGEN_PROGRESS"] = "0"  # what a slow machine takes long for is no error on stderr

import signal
import sys
from functools import wraps
from pathlib import Path

import pytest
import zygote
from hypothesis import settings
from threadpoolctl import threadpool_limits

from bladegen.measures import foreign, foreign_reader

threadpool_limits(int(os.environ["OMP_NUM_THREADS"]), "blas")  # a plugin has loaded NumPy before
gc.set_threshold(50_000, 10, 10)
settings.register_profile("steady", deadline=None, max_examples=15, derandomize=True)
settings.register_profile("thorough", deadline=None, max_examples=100, derandomize=True)
settings.register_profile("explore", deadline=None, max_examples=200, print_blob=True)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "steady"))


def pytest_collection_finish():
    """Half a million objects of libraries and tests stay to the end."""
    gc.freeze()


def uncounted(call):
    """Let a function of another package run without the trace that counts our lines."""

    @wraps(call)
    def quick(*given, **named):
        trace = sys.gettrace()
        sys.settrace(None)
        try:
            return call(*given, **named)
        finally:
            sys.settrace(trace)

    return quick


if sys.gettrace() is not None:  # before tests load them: what they do then takes seconds
    for name in zygote.SLOW:
        if not name.startswith("bladegen"):
            uncounted(importlib.import_module)(name)


@pytest.fixture(scope="session", autouse=True)
def _lines_of_others_are_not_counted():
    """Half of the time that coverage takes went into libraries, whose lines count for nothing.

    What of ours these call is not counted either: coverage says too little, never too much.
    """
    if sys.gettrace() is None:
        yield
        return
    from matplotlib.figure import Figure
    from openpyxl import Workbook
    from openpyxl.reader.excel import ExcelReader
    from ruamel.yaml import YAML

    with pytest.MonkeyPatch.context() as patch:
        for kind, names in (
            (YAML, ("load", "dump")),
            (ExcelReader, ("read",)),
            (Workbook, ("save",)),
            (Figure, ("savefig",)),
        ):
            for name in names:
                patch.setattr(kind, name, uncounted(getattr(kind, name)))
        yield


@pytest.fixture(scope="session")
def command():
    """Run bladegen's commands, and scripts, in processes that have imported what is slow."""
    with zygote.Commands() as commands:
        yield commands


class Answered:
    """What stands for the child that reads a foreign file, and has answered already."""

    def __init__(self, words):
        question, path, *_ = words
        self.sent = foreign.packed(foreign_reader.answer(question, Path(path)))

    def kill(self):
        pass

    def wait(self):
        return 0


@pytest.fixture
def foreign_here(monkeypatch):
    """Read foreign files in this process: that they have one of their own tells test_foreign."""
    monkeypatch.setattr(foreign, "started", Answered)
    monkeypatch.setattr(foreign, "_sent", lambda child, _: child.sent)


@pytest.fixture(scope="module", autouse=True)
def _broken_pipes_are_errors():
    """No library may set SIGPIPE back: a later write into a closed pipe would end this process."""
    yield
    status = Path("/proc/self/status")
    if status.is_file():
        fields = dict(line.split(":") for line in status.read_text().splitlines())
        assert int(fields["SigIgn"], 16) >> signal.SIGPIPE - 1 & 1, "SIGPIPE is not ignored"
