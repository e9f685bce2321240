"""A file's suffix says what is in it: another kind is refused before anything is computed."""

import inspect
import typing
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cli import commands as cli
from bladegen.cli.options import common
from bladegen.errors import ExportError
from bladegen.views import page, sweep
from bladegen.views.rendering.picture import save_image

RUN = CliRunner()
READ = {"airfoils", "space", "table", "into", "deviation"}  # options that name what is read
IMAGE = np.zeros((4, 4, 3), np.uint8)


@pytest.mark.parametrize(
    ("command", "allowed"),
    [
        ("preview nrel5mw --gif x.mp4", ".gif; such as x.gif"),
        ("preview nrel5mw --mp4 x.gif", ".mp4; such as x.mp4"),
        ("preview nrel5mw --screenshot x.svg", ".png; such as x.png"),
        ("preview nrel5mw --screenshot x", ".png; such as x.png"),
        ("preview nrel5mw --html x.png", ".html, .htm; such as x.html"),
        ("preview --compare nrel5mw dtu10mw --screenshot x.jpg", ".png; such as x.png"),
        ("check nrel5mw dtu10mw --screenshot x.pdf", ".png; such as x.png"),
        ("plot nrel5mw -o x.gif", ".png, .svg, .pdf; such as x.png"),
        ("plot nrel5mw -o x.png --format svg --what planform", ".svg; such as x.svg"),
        ("space build -o x.csv", ".npz; such as x.npz"),
        ("space plot -o x.txt", ".png, .svg, .pdf; such as x.png"),
        ("convert nrel5mw x.dat --to windio2", ".yaml, .yml; such as x.yaml"),
        ("convert nrel5mw x.dat --to selig", "a folder of files, such as x"),
        ("convert nrel5mw x.dat --into turbine.yaml", ".yaml, .yml; such as x.yaml"),
        ("convert nrel5mw x.yaml --into aerodyn.dat", ".dat; such as x.dat"),
        ("build nrel5mw -o x.step", "must be a folder; such as -o . --format step"),
        ("perturb nrel5mw -o a/x.yaml", "must be a folder; such as -o a --format yaml"),
        ("family nrel5mw -o x.sections.csv", "must be a folder; such as -o . --format sections"),
    ],
)
def test_another_kind_of_file_is_refused(command, allowed, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    refused = RUN.invoke(cli.app, command.split())
    assert isinstance(refused.exception, ExportError)
    assert allowed in str(refused.exception)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_may_be_named_as_one_likes(tmp_path):
    (tmp_path / "run.step").mkdir()
    command = ["build", "nrel5mw", "-o", str(tmp_path / "run.step"), "--landmarks", "100"]
    assert "odd" in str(RUN.invoke(cli.app, command).exception)  # it came so far


def functions():
    for name in cli.SUMMARIES:
        found = cli.function_of(name)
        if isinstance(found, typer.Typer):
            yield from (info.callback for info in found.registered_commands)
        else:
            yield found


def test_no_option_that_names_an_output_is_left_unchecked():
    unchecked, checked = set(), 0
    for command in functions():
        for name, parameter in inspect.signature(command, eval_str=True).parameters.items():
            kind, option = typing.get_args(parameter.annotation)[:2]
            if Path not in (kind, *typing.get_args(kind)) or name in READ:
                continue
            if isinstance(option, typer.models.OptionInfo):
                checked += 1
                if option.callback is None:
                    unchecked.add(f"{command.__name__} {name}")
    assert checked >= 10
    assert unchecked == {"plot output"}  # a file or a folder: it looks itself
    assert common.ending_in(".png")(None, None) is None


def test_functions_refuse_them_too(tmp_path):
    with pytest.raises(ExportError, match=r"x\.gif, suffix '\.gif', allowed are \.mp4"):
        sweep.write_mp4([IMAGE], tmp_path / "x.gif")
    with pytest.raises(ExportError, match=r"allowed are \.gif"):
        sweep.write_gif([IMAGE], tmp_path / "x.mp4")
    with pytest.raises(ExportError, match=r"allowed are \.png"):
        save_image(IMAGE, tmp_path / "x.svg")
    with pytest.raises(ExportError, match=r"allowed are \.html, \.htm"):
        page.write_page(None, tmp_path / "x.png")
    with pytest.raises(ExportError, match=r"allowed are \.npz"):
        bg.ShapeSpace.bundled().save(tmp_path / "x.csv")
