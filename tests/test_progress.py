"""What long commands say of themselves where no terminal shows a bar: plain lines on stderr."""

import threading
import time

import pytest

from bladegen.cli import terminal
from bladegen.errors import BladegenError


@pytest.fixture
def often(monkeypatch):
    """Let a step be said so soon, and again so often."""

    def every(seconds):
        monkeypatch.setenv("BLADEGEN_PROGRESS", str(seconds))

    return every


def lines(capsys):
    """What was said, without the seconds."""
    out, err = capsys.readouterr()
    assert out == ""
    return [line.rpartition(" (")[0] for line in err.splitlines()]


def until(said):
    """Wait for what a thread does, however busy the machine is."""
    for _ in range(2000):
        if said():
            return
        time.sleep(0.01)
    raise AssertionError


def test_a_step_is_said_once_it_lasts_and_again_with_its_share(often, capsys):
    often(0.05)
    heard = []

    def hear(count):
        heard.extend(lines(capsys))
        return len(heard) >= count

    def said(line):
        hear(0)
        return f"progress: {line}" in heard

    with terminal.progress_bar() as progress:
        progress("reading")
        until(lambda: hear(2))
        progress("measuring sections, 3 of 9")
        until(lambda: said("measuring sections, 3 of 9"))
        progress("measuring sections, 7 of 9")
        until(lambda: said("measuring sections, 7 of 9"))
    assert heard[:2] == ["progress: reading"] * 2
    assert not [t for t in threading.enumerate() if t.name == "progress"]


def test_the_same_step_is_not_said_anew_for_each_number(often, capsys):
    """A step that is always new would never last; one that goes on is said."""
    often(0.3)
    heard, done = [], iter(range(10**9))
    with terminal.variants_bar(5000) as progress:
        until(lambda: progress(next(done)) or heard.extend(lines(capsys)) or heard)
    assert " of 5000 variants" in heard[0]


def test_quick_steps_are_silent_and_0_is_silence(often, capsys):
    often(1000)
    with terminal.progress_bar() as progress:
        progress("reading")
    often(0)
    with terminal.progress_bar() as progress:
        progress("reading")
        time.sleep(0.1)
    assert lines(capsys) == []
    often("now")
    with (
        pytest.raises(BladegenError, match="BLADEGEN_PROGRESS: got 'now', must be seconds"),
        terminal.progress_bar(),
    ):
        pass


def test_names_of_files_write_nothing_of_their_own(often, capsys):
    often(0.02)
    heard = []
    with terminal.progress_bar() as progress:
        progress("reading a\x1b[2J\nb.stl")
        until(lambda: heard.extend(lines(capsys)) or heard)
    assert "\x1b" not in heard[0]
    assert set(heard) == {heard[0]}


def test_rows_of_tables_stay_lines_where_no_terminal_is(capsys, monkeypatch):
    monkeypatch.delenv("COLUMNS", raising=False)
    terminal.print_table(["a", "b"], [["x" * 70, "y" * 70]])
    assert any(
        "x" * 70 in line and "y" * 70 in line for line in capsys.readouterr().out.split("\n")
    )
