import os
import signal
import socket
import subprocess
import sys
import urllib.error
import urllib.request
from pathlib import Path

import pytest
from typer.testing import CliRunner

from bladegen.cli import commands
from bladegen.errors import FileError, StudioError
from bladegen.studio import server
from bladegen.studio.server import Serving, bound, serve


def test_a_port_that_is_taken_is_said_or_left_for_a_free_one(monkeypatch):
    with bound("127.0.0.1", 0) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(StudioError, match=f"port {port}: .*; --port 0 takes a free one"):
            bound("127.0.0.1", port)
        monkeypatch.setattr(server, "PORT", port)
        with bound("127.0.0.1", None) as other:
            assert other.getsockname()[1] not in (0, port)
    with pytest.raises(StudioError, match=r"cannot listen at 203\.0\.113\.7, port 0"):
        bound("203.0.113.7", 0)


def test_addresses_hold_the_token_and_a_name_that_can_be_reached():
    with bound("127.0.0.1", 0) as sock:
        port = sock.getsockname()[1]
        assert server._address(sock, "127.0.0.1", None) == f"http://127.0.0.1:{port}/"
        assert server._address(sock, "::1", None) == f"http://[::1]:{port}/"
        everywhere = server._address(sock, "0.0.0.0", "abc")
        assert everywhere == f"http://{socket.gethostname()}:{port}/?token=abc"


def test_without_the_web_framework_one_line_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "nicegui", None)
    result = CliRunner().invoke(commands.app, ["studio", "--no-browser"])
    assert isinstance(result.exception, StudioError)
    assert str(result.exception) == ('needs nicegui, which pip install "bladegen[studio]" brings')


def test_a_blade_that_is_none_is_said_before_anything_is_served():
    with pytest.raises(FileError, match="neither a bundled blade nor a file"):
        serve("missing.yaml", port=0)


def test_the_command_says_where_and_opens_the_browser(monkeypatch):
    opened, asked = [], []

    def fake(blade, host, port, told, *, airfoils):
        asked.append((blade, host, port, airfoils))
        told(Serving("http://127.0.0.1:1/", lambda: None))

    monkeypatch.setattr(server, "serve", fake)
    monkeypatch.setattr("webbrowser.open", opened.append)
    result = CliRunner().invoke(commands.app, ["studio", "a.csv", "--airfoils", "b", "--port", "5"])
    assert result.exit_code == 0
    assert "http://127.0.0.1:1/" in result.output
    assert asked == [("a.csv", "127.0.0.1", 5, Path("b"))]
    assert opened == ["http://127.0.0.1:1/"]
    CliRunner().invoke(commands.app, ["studio", "--no-browser"])
    assert len(opened) == 1


def test_a_studio_elsewhere_needs_its_token_and_leaves_nothing_behind(tmp_path):
    for name in ("temporary", "here"):
        (tmp_path / name).mkdir()
    code = "from bladegen.cli.commands import main; main()"
    command = [sys.executable, "-c", code, "studio", "nrel5mw", "--no-browser"]
    process = subprocess.Popen(
        [*command, "--port", "0", "--host", "0.0.0.0"],
        stdout=subprocess.PIPE,
        text=True,
        cwd=tmp_path / "here",
        env={**os.environ, "TMPDIR": str(tmp_path / "temporary"), "PYTHONUNBUFFERED": "1"},
    )
    try:
        address = process.stdout.readline().split()[2]
        port = address.split(":")[2].split("/")[0]
        plain = f"http://127.0.0.1:{port}/"
        with pytest.raises(urllib.error.HTTPError, match="403"):
            urllib.request.urlopen(plain, timeout=600)
        browser = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
        with browser.open(f"{plain}?{address.split('?')[1]}", timeout=600) as answer:
            assert answer.url == plain
            assert b"bladegen studio" in answer.read()
        assert browser.open(plain, timeout=600).status == 200
        assert len(list((tmp_path / "temporary").glob("bladegen-studio-*"))) == 1
    finally:
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=600)
    assert not list((tmp_path / "temporary").iterdir())
    assert not list((tmp_path / "here").iterdir())
