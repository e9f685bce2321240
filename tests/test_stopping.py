"""Commands that are told to stop, and workers whose parent is gone."""

import signal
import subprocess
import sys
import time

import filelock
import pytest
from processes import gone_within, running

from bladegen.cli import commands
from bladegen.support.files import alone
from bladegen.support.stopping import Stopped, held_back, stopped_by_signals

MAIN = [sys.executable, "-c", "from bladegen.cli.commands import main; main()"]
WORKER = """
import ctypes, os
from multiprocessing import get_context

def holding(parent):
    from bladegen.support.workers import end_with

    end_with(parent)
    print(os.getpid(), flush=True)
    while True:
        ctypes.PyDLL(None).sleep(1)  # Python's lock is held, as by a solid in the making

if __name__ == "__main__":
    process = get_context("spawn").Process(target=holding, args=(os.getpid(),))
    process.start()
    process.join()
"""


@pytest.fixture
def script(tmp_path):
    path = tmp_path / "script.py"
    path.write_text(WORKER)
    return path


def test_a_worker_that_holds_the_lock_ends_with_its_killed_parent(script):
    with subprocess.Popen([sys.executable, script], stdout=subprocess.PIPE) as parent:
        worker = int(parent.stdout.readline())
        assert running(worker)
        parent.kill()
        assert gone_within(60.0, [worker])
        assert parent.stdout.read() == b""  # nobody holds the pipe any more


@pytest.mark.parametrize(
    ("number", "words", "status"),
    [(signal.SIGINT, "interrupted", 130), (signal.SIGTERM, "terminated", 143)],
)
def test_a_signal_is_said_in_a_line_and_handlers_are_put_back(
    monkeypatch, capsys, number, words, status
):
    inherited = signal.signal(number, signal.default_int_handler)  # a shell's & ignores SIGINT
    before = signal.getsignal(number)
    monkeypatch.setattr(commands, "app", lambda: signal.raise_signal(number))
    with pytest.raises(SystemExit, match=str(status)):
        commands.main()
    assert capsys.readouterr().err == f"bladegen: {words}\n"
    assert signal.getsignal(number) is before
    signal.signal(number, inherited)


def test_ignored_signals_stay_ignored_and_a_second_one_is_the_systems():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with stopped_by_signals():
            signal.raise_signal(signal.SIGHUP)
            with pytest.raises(Stopped):
                signal.raise_signal(signal.SIGTERM)
            assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
            assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_signal_that_comes_while_files_are_locked_leaves_no_lock(tmp_path, monkeypatch):
    acquire = filelock.FileLock.acquire

    def late(lock, *args, **how):
        taken = acquire(lock, *args, **how)
        signal.raise_signal(signal.SIGTERM)  # the file is there, and nobody knows yet
        return taken

    monkeypatch.setattr(filelock.FileLock, "acquire", late)
    with stopped_by_signals(), pytest.raises(Stopped, match="terminated"), alone(tmp_path, "blade"):
        pytest.fail("went on")
    assert not list(tmp_path.iterdir())


def test_a_signal_that_is_held_back_comes_at_the_end():
    done = []

    def interrupted():
        with held_back():
            signal.raise_signal(signal.SIGTERM)
            done.append(1)

    with stopped_by_signals(), pytest.raises(Stopped):
        interrupted()
    assert done == [1]


def test_a_build_that_is_stopped_says_so_and_leaves_nothing(tmp_path):
    process = subprocess.Popen(
        [*MAIN, "build", "nrel5mw", "-o", str(tmp_path), "--format", "step"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    deadline = time.monotonic() + 300
    while not list(tmp_path.glob(".*.lock")) and time.monotonic() < deadline:
        time.sleep(0.01)
    process.terminate()
    _, err = process.communicate(timeout=60)
    assert process.returncode == 143
    assert err == "bladegen: terminated\n"
    assert not list(tmp_path.iterdir())
