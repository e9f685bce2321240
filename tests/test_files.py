import contextlib
import os
import signal
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bladegen.errors import ExportError, FileError
from bladegen.support.files import (
    alone,
    beginning_of,
    content_of,
    folder,
    replacing,
    safe_stem,
)


def test_a_whole_file_replaces_the_old_one(tmp_path):
    target = tmp_path / "a.txt"
    target.write_text("old")
    with replacing(target) as temporary:
        assert temporary.parent == tmp_path
        assert temporary.suffix == ".txt"
        temporary.write_text("new")
        assert target.read_text() == "old"
    assert target.read_text() == "new"
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]


def test_a_failure_leaves_the_old_file_and_nothing_else(tmp_path):
    target = tmp_path / "a.txt"
    target.write_text("old")
    with contextlib.suppress(RuntimeError), replacing(target) as temporary:
        temporary.write_text("half")
        raise RuntimeError
    assert target.read_text() == "old"
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]


def test_a_killed_writer_leaves_no_file_under_the_final_name(tmp_path):
    target = tmp_path / "a.txt"
    code = (
        "import sys, time; from pathlib import Path; from bladegen.support.files import replacing\n"
        "with replacing(Path(sys.argv[1])) as t:\n"
        "    t.write_text('half'); print('ready', flush=True); time.sleep(60)"
    )
    with subprocess.Popen(
        [sys.executable, "-c", code, str(target)], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout.readline() == "ready\n"
        process.send_signal(signal.SIGKILL)
        process.wait()
    assert not target.exists()


def test_new_files_have_ordinary_permissions(tmp_path):
    plain, ours = tmp_path / "plain", tmp_path / "ours"
    plain.write_text("")
    with replacing(ours) as temporary:
        temporary.write_text("")
    assert ours.stat().st_mode == plain.stat().st_mode


def test_a_missing_folder_is_said_in_one_line(tmp_path):
    nowhere = replacing(tmp_path / "nowhere" / "a.stl")
    with pytest.raises(
        ExportError, match=r"cannot be written: there is no folder .*nowhere; mkdir -p .*nowhere$"
    ):
        nowhere.__enter__()


def test_a_full_disk_is_said_in_one_line(tmp_path):
    target = tmp_path / "a.stl"

    def write():
        with replacing(target):
            raise OSError(28, os.strerror(28))

    with pytest.raises(ExportError, match="No space left"):
        write()
    assert list(tmp_path.iterdir()) == []


def test_folders_are_made_unless_a_file_stands_there(tmp_path):
    assert folder(tmp_path / "a" / "b").is_dir()
    (tmp_path / "file").write_text("")
    with pytest.raises(ExportError, match="cannot be made a folder"):
        folder(tmp_path / "file")


@given(st.text(max_size=200))
def test_names_never_become_paths(name):
    stem = safe_stem(name)
    assert 0 < len(stem) <= 80
    assert "/" not in stem
    assert "\\" not in stem
    assert not stem.startswith((".", "-"))
    assert stem.isascii()


def test_files_of_one_stem_are_held_by_one_run(tmp_path):
    with alone(tmp_path, "blade"):
        held = alone(tmp_path, "blade")
        with pytest.raises(ExportError, match="another run is writing blade there"):
            held.__enter__()
        with alone(tmp_path, "other"):
            pass
    assert list(tmp_path.iterdir()) == []
    (tmp_path / ".blade.lock").write_text("")  # of a run that was killed
    with alone(tmp_path, "blade"):
        assert (tmp_path / ".blade.lock").exists()
    assert list(tmp_path.iterdir()) == []


def test_a_lock_that_its_holder_took_away_is_made_anew(tmp_path, monkeypatch):
    import fcntl

    def flock(handle, how):
        if not tried:
            (tmp_path / ".blade.lock").unlink()  # the last holder ends in between
        tried.append(how)
        if len(tried) == 2:
            raise OSError(37, "No locks available")  # and goes without where there are none

    tried = []
    monkeypatch.setattr(fcntl, "flock", flock)
    with alone(tmp_path, "blade"):
        assert (tmp_path / ".blade.lock").exists()
    assert len(tried) == 2


def test_only_regular_files_are_read_and_no_more_than_is_asked_for(tmp_path):
    path = tmp_path / "a.txt"
    path.write_bytes(b"0123456789")
    assert content_of(path, 10) == b"0123456789"
    assert beginning_of(path, 3) == b"012"
    with pytest.raises(FileError, match="larger than 9 bytes, the most that is read"):
        content_of(path, 9)


@pytest.mark.parametrize("kind", ["pipe", "link to a pipe", "folder", "device", "nothing"])
def test_what_has_no_end_is_not_read(tmp_path, kind):
    """A pipe without a writer would hold up a plain `open`, /dev/zero would fill the memory."""
    path = tmp_path / "a"
    if "pipe" in kind:
        os.mkfifo(path)
    if "link" in kind:
        (tmp_path / "b").symlink_to(path)
        path = tmp_path / "b"
    if kind == "folder":
        path.mkdir()
    if kind == "device":
        path.symlink_to("/dev/zero")
    with pytest.raises(FileError, match=r"is no regular file|cannot be read: No such file"):
        content_of(path, 10)
    assert beginning_of(path, 10) == b""
