"""Errors and findings are one visible line, whatever names a file holds."""

import json
import logging
import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from bladegen.cli.commands import app, main
from bladegen.cli.terminal import log_to_terminal, print_findings, print_table
from bladegen.errors import BladegenError, DefinitionError, FileError, Finding, visible
from strategies import circle, naca

ACTING = (
    "\x1b[31m",  # an escape sequence
    "\x9b31m",  # the same with a C1 control
    "\x1b]0;title\x07",
    "\u202egnp.x",  # right to left from here
    "\u2066a\u2069",
    "\u200f",
    "a\rb",
    "a\nb",
    "a\u2028b",
    "\x7f",
    "\x00",
    "\ud800",
)


def acts(text):
    return any(unicodedata.category(letter) in ("Cc", "Cf", "Cs", "Zl", "Zp") for letter in text)


@given(st.text())
def test_what_is_visible_shows_all_its_letters(text):
    shown = visible(text)
    assert not acts(shown)
    assert visible(shown) == shown
    if not acts(text):
        assert shown == text


def test_letters_of_all_scripts_stay():
    text = "Flügel 翼型 профиль 🌀 NACA\u00a063-215, 0.5°"
    assert visible(text) == text


@pytest.mark.parametrize("name", ACTING)
def test_errors_and_findings_show_names(name):
    assert not acts(str(BladegenError(f"airfoil {name}: is none")))
    assert not acts(str(DefinitionError(name)))
    error = FileError(f"a{name}.csv", [f"airfoil {name}: is none", "b"])
    assert not acts(str(error))
    assert not any(map(acts, error.problems))
    finding = Finding(name, name)
    assert not acts(str(finding))
    assert not acts(finding.where + finding.message)


@pytest.mark.parametrize("name", ACTING)
def test_tables_findings_and_messages_show_names(name, capsys):
    print_table(["a", "b"], [[name, "x"]], title=name)
    print_findings([f"airfoil {name}: x"])
    log_to_terminal(logging.INFO)
    logging.getLogger("bladegen").warning("wrote %s", name)
    out, err = capsys.readouterr()
    plain = (out + err).replace("\n", "")
    assert visible(name)[:3] in plain
    assert not acts(plain)


@pytest.fixture
def hostile(tmp_path):
    """A blade whose airfoil, file and table bear names that act."""
    name = "foil\x1b[31m\x9b\u202e"
    folder = tmp_path / "airfoils"
    folder.mkdir()
    for stem, points in ((name, naca(0.18, 0.02, 0.0, 41)[:-1]), ("circle", circle())):
        rows = "\n".join(f"{x:.6f} {y:.6f}" for x, y in points)
        (folder / f"{stem}.dat").write_text(rows)
    path = tmp_path / f"blade{name}.csv"
    path.write_text(f"z_m,chord_m,twist_deg,airfoil\n0,1,2,circle\n5,1,0,{name}\n")
    return path


def test_info_of_a_hostile_file_is_visible(hostile):
    result = CliRunner().invoke(app, ["info", str(hostile)])
    assert result.exit_code == 0
    assert "foil\\x1b[31m\\x9b\\u202e" in result.output
    assert "is listed once" in result.output
    assert not acts(result.output.replace("\n", ""))
    found = CliRunner().invoke(app, ["info", str(hostile), "--json"])
    assert not acts(found.output.replace("\n", ""))
    assert json.loads(found.output)["stations"][-1]["airfoil"] == "foil\x1b[31m\x9b\u202e"


def test_errors_of_a_hostile_file_are_visible(hostile, capsys, monkeypatch):
    hostile.write_text(hostile.read_text().replace("circle", "circle\x1b[2J"))
    monkeypatch.setattr("sys.argv", ["bladegen", "info", str(hostile)])
    with pytest.raises(SystemExit):
        main()
    said = capsys.readouterr().err
    assert "circle\\x1b[2J" in said
    assert not acts(said.rstrip("\n"))
