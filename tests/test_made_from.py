"""Files of `convert`, `preview`, `plot`, `check` and of Python say what they are made from."""

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import openpyxl
import pytest
import windIO
from PIL import Image
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cli import commands
from bladegen.exports import marks
from bladegen.exports.definitions import write_into
from bladegen.exports.inventory import made_by
from bladegen.exports.provenance import made_from
from bladegen.support.files import digest_of
from bladegen.views import page, sweep
from bladegen.views.plots.figures import figure, save_figure, save_pages

SOURCE = Path(bg.read("nrel5mw").source)
WAYS = ("x.yaml", "x.htc", "x.dat", "x.csv", "x.xlsx", "airfoils")


def run(*words):
    result = CliRunner().invoke(commands.app, [str(word) for word in words])
    assert result.exit_code == 0, repr(result.exception)
    return result.output


@pytest.fixture(scope="module")
def polars():
    """A definition whose airfoils all have polars."""
    return bg.read("iea15mw")


@pytest.fixture(scope="module")
def converted(tmp_path_factory):
    folder = tmp_path_factory.mktemp("converted")
    for name in WAYS:
        run("convert", "nrel5mw", folder / name)
    return folder


@pytest.mark.parametrize("name", WAYS)
def test_every_file_of_convert_tells(converted, name):
    whole = converted / name
    stem = [] if whole.is_dir() else [f for f in converted.rglob("x*") if f.is_file()]
    files = [whole] if whole.is_file() else list(whole.glob("*.dat"))
    files += [file for file in stem if file.suffix in (".dat", ".txt")]
    assert files
    for file in files:
        made = made_by(file)
        assert (made.version, made.source) == (bg.__version__, "nrel5mw.yaml"), file
        assert made.sha256 == digest_of(SOURCE)
        assert made.command.startswith("bladegen convert nrel5mw ")
    if whole.is_file():
        assert made_by(whole).command == f"bladegen convert nrel5mw {name}"


def test_the_same_command_writes_the_same_bytes(converted, tmp_path):
    for name in WAYS:
        if not name.endswith("xlsx"):  # openpyxl's own time
            run("convert", "nrel5mw", tmp_path / name)
    for file in tmp_path.rglob("*"):
        if file.is_file():
            assert file.read_bytes() == (converted / file.relative_to(tmp_path)).read_bytes()


def test_other_readers_take_the_files(converted):
    windIO.validate(windIO.load_yaml(converted / "x.yaml"), "turbine/turbine_schema")
    assert made_by(converted / "x.xlsx").text == (
        openpyxl.load_workbook(converted / "x.xlsx").properties.description
    )
    for file in (converted / "airfoils").glob("*.dat"):
        assert np.loadtxt(file, skiprows=1).shape[1] == 2
    # readers that count lines: HAWC2's first word, AeroDyn's table behind six lines
    assert int((converted / "x_ae.dat").read_text().split()[0]) == 1
    rows = (converted / "x.dat").read_text().splitlines()
    assert rows[3].split()[1] == "NumBlNds"
    assert len(rows) == 6 + int(rows[3].split()[0])
    points = next(converted.glob("x_dat_airfoils/*_Coords.txt")).read_text().splitlines()
    assert len(points) == 4 + int(points[0].split()[0])


def test_python_writes_it_too(tmp_path):
    definition = bg.read("nrel5mw")
    bg.write(definition, tmp_path / "a.yaml")
    assert marks.read(tmp_path / "a.yaml") == made_from(definition, {})
    assert bg.read(tmp_path / "a.yaml").chord == definition.chord


def test_info_says_where_a_file_comes_from(converted, tmp_path):
    said = json.loads(run("info", converted / "x.yaml", "--json"))
    assert said["made_from"] == made_by(converted / "x.yaml").text
    assert "nrel5mw.yaml" in run("info", converted / "x.yaml")
    for file in ("x_ae.dat", "airfoils/DU40_A17.dat"):
        told = json.loads(run("info", converted / file, "--json"))["made_from"]
        assert told["source"] == "nrel5mw.yaml"
        assert told["sha256"] == digest_of(SOURCE)
    assert "bladegen convert nrel5mw" in run("info", converted / "x_ae.dat")
    assert "made from: bladegen" in run("check", converted / "x.csv")
    assert "made_from" not in json.loads(run("info", "nrel5mw", "--json"))


def test_a_changed_airfoil_is_none_of_the_report(converted, tmp_path):
    folder = shutil.copytree(converted / "airfoils", tmp_path / "airfoils")
    one, two = sorted(folder.glob("*.dat"))[:2]
    one.write_text(one.read_text() + "\n")
    assert made_by(one) is None
    assert made_by(two) is not None
    bg.write(replace(bg.read("iea15mw"), name="other"), folder)
    assert made_by(two).source == "nrel5mw.yaml"
    assert made_by(folder / "circular.dat").source == Path(bg.read("iea15mw").source).name


def test_a_model_with_its_own_blade_stays_the_same_to_the_byte(tmp_path):
    turbine, whole = tmp_path / "turbine.yaml", bg.read("nrel5mw")
    stations = [(one.eta, one.airfoil) for one in whole.stations[::4]]
    few = [
        bg.Station(eta, replace(foil, coordinates=foil.coordinates[::3])) for eta, foil in stations
    ]
    bg.write(replace(whole, stations=tuple(few), structure=None), turbine)
    write_into(bg.read(turbine), turbine, turbine)  # in the way that such files are written
    before = turbine.read_bytes()
    write_into(bg.read(turbine), turbine, tmp_path / "again.yaml", command="bladegen convert")
    assert (tmp_path / "again.yaml").read_bytes() == before
    changed = replace(bg.read(turbine), twist=bg.Distribution([0.0, 1.0], [0.1, 0.0]))
    for _ in range(2):  # an earlier line is replaced
        write_into(changed, turbine, tmp_path / "new.yaml", command="bladegen convert")
        changed = replace(changed, twist=bg.Distribution([0.0, 1.0], [0.2, 0.0]))
    text = (tmp_path / "new.yaml").read_text()
    assert len(re.findall("bladegen [^;]*; blade=", text)) == 1
    assert made_by(tmp_path / "new.yaml").command == "bladegen convert"


@pytest.mark.parametrize("end", [b"\n", b"\r\n"])
@pytest.mark.parametrize("bom", [b"", b"\xef\xbb\xbf"])
@pytest.mark.parametrize("name", ["a.yaml", "a.htc", "a.dat"])
def test_lines_are_kept_and_the_last_maker_is_told(tmp_path, name, bom, end):
    file, blade = tmp_path / name, bg.read("nrel5mw")
    lines = [b"--- AERODYN ---" if name == "a.dat" else b"# first", b"my own title", b"x: 1", b""]
    file.write_bytes(bom + end.join(lines))
    for command in ("one", "two"):
        marks.put(file, made_from(blade, {}, command))
    content = file.read_bytes()
    assert made_by(file).command == "two"
    assert content.startswith(bom)
    assert content.count(b"blade=nrel5mw") == 1
    assert content.count(b"\n") == content.count(end)
    for line in lines:
        assert line in content
    if name == "a.dat":
        assert content.count(b"\n") == 3


def drawn():
    return figure(1, 1, width=2, height=2)[0]


MADE = made_from(bg.read("nrel5mw"), {}, "bladegen plot nrel5mw --what (x)")
IMAGES = [np.full((16, 16, 3), shade, dtype=np.uint8) for shade in (0, 200)]


@pytest.mark.parametrize(
    ("name", "write"),
    [
        ("a.png", lambda path: save_figure(drawn(), path)),
        ("a.svg", lambda path: save_figure(drawn(), path)),
        ("a.pdf", lambda path: save_figure(drawn(), path, MADE.text)),
        ("b.pdf", lambda path: save_pages([drawn(), drawn()], path, MADE.text)),
        ("a.gif", lambda path: sweep.write_gif(IMAGES, path)),
        ("a.mp4", lambda path: sweep.write_mp4(IMAGES, path, about=MADE.text)),
    ],
)
def test_pictures_and_films_tell(tmp_path, name, write):
    if name == "a.mp4":
        pytest.importorskip("imageio_ffmpeg")
    contents = []
    for place in ("one", "two"):
        (tmp_path / place).mkdir()
        with marks.marked(tmp_path / place / name, MADE) as temporary:
            write(temporary)
        assert marks.read(tmp_path / place / name) == MADE
        contents.append((tmp_path / place / name).read_bytes())
    assert contents[0] == contents[1]  # no time
    if name in ("a.png", "a.gif"):
        with Image.open(tmp_path / "one" / name) as image:
            image.load()
            key = {"a.png": "bladegen", "a.gif": "comment"}[name]
            said = image.info[key]
            assert (said.decode() if isinstance(said, bytes) else said) == MADE.text
            assert name == "a.png" or image.n_frames == 2


def test_a_page_and_a_picture_of_the_command_line_tell(tmp_path, monkeypatch):
    monkeypatch.setattr(page, "write_page", lambda _scene, path, **_: path.write_text(PAGE))
    run("preview", "nrel5mw", "--html", tmp_path / "a.html", "--thickness", "1.1")
    made = made_by(tmp_path / "a.html")
    assert made.command == "bladegen preview nrel5mw --html a.html --thickness 1.1"
    assert dict(made.settings)["change1.thickness"] == "1.1"
    text = (tmp_path / "a.html").read_text()
    assert text.index("charset") < text.index('<meta name="bladegen"') < text.index("<title")
    told = json.loads(run("info", tmp_path / "a.html", "--json"))["made_from"]
    assert told["source"] == "nrel5mw.yaml"
    run("plot", "nrel5mw", "--what", "planform", "-o", tmp_path / "a.svg", "--mirror")
    assert dict(made_by(tmp_path / "a.svg").settings)["mirrored"] == "yes"


PAGE = '<!doctype html>\n<head>\n<meta charset="utf-8">\n<title>x</title>\n'
