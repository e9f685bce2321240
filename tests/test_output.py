"""What becomes of a command whose standard output cannot be written."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from bladegen.cli import commands
from bladegen.cli.output import OutputError, guarded

FULL = Path("/dev/full")
COMMANDS = [["list"], ["--help"], ["--version"], ["info", "nrel5mw", "--json"], ["space", "info"]]
CODE = "from bladegen.cli.commands import main; main()"


def command(arguments, **options):
    return subprocess.run(
        [sys.executable, "-c", CODE, *arguments],
        stderr=subprocess.PIPE, text=True, check=False, **options,
    )  # fmt: skip


@pytest.mark.skipif(not FULL.exists(), reason="no device that is always full")
@pytest.mark.parametrize("arguments", COMMANDS, ids=" ".join)
def test_a_full_disk_is_one_line_and_exit_code_1(arguments, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["bladegen", *arguments])
    with FULL.open("w") as full:
        monkeypatch.setattr(sys, "stdout", full)
        with pytest.raises(SystemExit) as end:
            commands.main()
    assert end.value.code == 1
    said = capsys.readouterr().err
    assert said == "bladegen: standard output: cannot be written: No space left on device\n"


@pytest.mark.skipif(not FULL.exists(), reason="no device that is always full")
def test_a_full_disk_leaves_nothing_to_say_when_the_process_ends():
    with FULL.open("w") as full:
        done = command(["--version"], stdout=full)
    assert done.returncode == 1
    assert done.stderr == "bladegen: standard output: cannot be written: No space left on device\n"


def test_a_closed_pipe_ends_a_command_as_other_tools():
    reading, writing = os.pipe()
    os.close(reading)
    done = command(["list"], stdout=writing)
    os.close(writing)
    assert (done.returncode, done.stderr) == (141, "")


def test_a_command_without_standard_output_says_so(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["bladegen", "--version"])
    monkeypatch.setattr(sys, "stdout", None)
    with pytest.raises(SystemExit) as end:
        commands.main()
    assert end.value.code == 1
    assert "Bad file descriptor" in capsys.readouterr().err


def test_what_can_be_written_passes(capsys):
    with guarded():
        sys.stdout.writelines(["one\n", "two\n"])
        sys.stdout.flush()
        assert not sys.stdout.isatty()
    assert capsys.readouterr().out == "one\ntwo\n"


def test_other_failures_stay_what_they_are():
    with pytest.raises(OSError, match="elsewhere") as raised, guarded():
        raise OSError("elsewhere")
    assert not isinstance(raised.value, OutputError)


def test_long_names_in_tables_are_folded_and_not_cut(capsys, monkeypatch):
    """`rotor_power_co...` is no name that --where takes."""
    from bladegen.cli.terminal import print_table

    monkeypatch.setenv("COLUMNS", "60")
    print_table(["figure", *"abcd"], [["rotor_power_coefficient", *["0.123456789"] * 4]])
    shown = capsys.readouterr().out
    assert "\u2026" not in shown
    assert "".join(line[:12].strip() for line in shown.splitlines()[3:]).startswith("rotor_power_")
