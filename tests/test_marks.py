"""Every file says what it is made from, in its format's own place, and it is read again."""

import json
import struct
import zipfile
from dataclasses import replace
from pathlib import Path

import h5py
import meshio
import openpyxl
import pytest
import pyvista
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

import bladegen as bg
from bladegen.cad import exchange
from bladegen.exports import marks
from bladegen.exports.build import build, report_path
from bladegen.exports.inventory import made_by
from bladegen.exports.options import Kind, Options
from bladegen.exports.products import Products
from bladegen.exports.provenance import Provenance, made_from, word
from bladegen.exports.registry import FORMATS
from bladegen.measures import checks
from bladegen.surface.grids.grid import Spacing
from bladegen.surface.tips import round_tip

SMALL = Spacing(around=33, along=9, edge=4, leading_edge=0.02, trailing_edge=0.02, root=0.1)
SILENT = {".p3d", ".fmt", ".volume.p3d", ".volume.fmt"}  # PLOT3D has no place for words
SLOW = {".png", ".stp", ".igs", ".dat", ".htc"}  # tested by themselves, or as others
SLOW |= {suffix for suffix, row in FORMATS.items() if row.kind is Kind.beam}  # test_beam
SUFFIXES = tuple(suffix for suffix in FORMATS if suffix not in SLOW)
COMMAND = "bladegen build nrel5mw --tip round"
WORDS = st.text(st.characters(codec="utf-8"), max_size=40)


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=51)


@pytest.fixture(scope="module")
def products(blade):
    options = Options(tolerance=0.02, sections=20, stations=20, spacing=SMALL, command=COMMAND)
    return Products(blade, options)


@pytest.fixture(scope="module")
def folder(products, tmp_path_factory):
    from bladegen.exports.exporters import write

    target = tmp_path_factory.mktemp("all")
    for suffix in SUFFIXES:
        write(products, target / f"a{suffix}")
    return target


@given(WORDS, WORDS, WORDS, st.dictionaries(st.from_regex(r"\A[a-z_.0-9]{1,9}\Z"), WORDS))
def test_a_line_is_read_as_it_was_written(blade, source, command, settings_):
    taken = {"blade", "source", "sha256", "definition", "command", "id"}
    pairs = tuple((k, v) for k, v in settings_.items() if v and k not in taken)
    made = Provenance("1.2.3", blade or "x", source, "ab" * 32, "0" * 16, command, pairs)
    assert made.text.isascii()
    assert made.text.isprintable()
    assert not set("'\"<>&\\") & set(made.text)
    assert Provenance.read(f"before {made.text} behind") == made
    brief = made.short("mm", 80)
    assert len(brief) <= 80
    assert brief.isascii()
    again = Provenance.read(brief)
    assert (again.id, again.sha256, again.is_partial) == (made.id, "ab" * 4, True)
    assert replace(made, command="another").id == made.id
    assert replace(made, source="other", id="").id != made.id or source == "other"


@given(st.text(st.characters(codec="utf-8"), min_size=200, max_size=900))
def test_lines_of_inp_files_are_no_longer_than_abaqus_takes(tmp_path_factory, command):
    made = Provenance("1.2.3", "x", "x.yaml", "ab" * 32, "0" * 16, command, ())
    path = tmp_path_factory.getbasetemp() / "x.inp"
    path.write_text("** x: 2 elements\n*NODE\n")
    marks.put(path, made)
    lines = path.read_text().split("\n")
    assert max(map(len, lines)) <= 256
    assert all(line.startswith("** ") for line in lines[:-2])
    assert marks.read(path) == made


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_each_format_holds_it(folder, products, suffix):
    path = folder / f"a{suffix}"
    wanted = products.made_from(FORMATS[suffix].kind, suffix)
    found = marks.read(path)
    if suffix in SILENT:
        assert found is None
    elif suffix == ".stl":
        assert found.id == wanted.id
        assert wanted.sha256.startswith(found.sha256)
    else:
        assert found == wanted
        assert found.command == COMMAND
        assert found.source == "nrel5mw.yaml"


def test_independent_readers_find_it(folder, products):
    def text(suffix):
        return products.made_from(FORMATS[suffix].kind, suffix).text

    with h5py.File(folder / "a.cgns") as file:
        node = file["Base/bladegen"]
        assert node.attrs["label"].startswith(b"Descriptor_t")
        assert bytes(node[" data"][:]).decode() == text(".cgns")
    assert pyvista.read(folder / "a.vtp").field_data["bladegen"][0] == text(".vtp")
    for read in (pyvista.read, meshio.read):  # codes, for meshio reads no text
        codes = read(folder / "a.vtu").field_data["bladegen"]
        assert bytes(codes).rstrip(b"\0").decode() == text(".vtu")
    content = (folder / "a.glb").read_bytes()
    (size,) = struct.unpack_from("<I", content, 12)
    asset = json.loads(content[20 : 20 + size])["asset"]
    assert asset["extras"] == {"bladegen": text(".glb")}
    assert struct.unpack_from("<4sII", content) == (b"glTF", 2, len(content))
    book = openpyxl.load_workbook(folder / "a.xlsx")
    assert book.properties.description == text(".xlsx")
    model = zipfile.ZipFile(folder / "a.3mf").read("3D/3dmodel.model").decode()
    assert f'<metadata name="Description">{text(".3mf")}</metadata>' in model
    assert f"comment {text('.ply')}\n".encode() in (folder / "a.ply").read_bytes()[:2000]
    assert (folder / "a.yaml").read_text().startswith(f"# {text('.yaml')}\n")
    assert (folder / "a.sections.csv").read_text().splitlines()[1] == f"# {text('.sections.csv')}"


@pytest.mark.parametrize("suffix", [".step", ".iges", ".brep"])
def test_cad_files_are_read_as_before(folder, products, suffix):
    path = folder / f"a{suffix}"
    figures = checks.solid_figures(exchange.read(path), quick=True)
    assert figures["valid"]
    assert figures["faces"] == 5
    if suffix == ".step":
        made = products.made_from(Kind.solid, suffix)
        assert (
            f"PRODUCT('nrel5mw','nrel5mw','bladegen {made.version}; source=nrel5mw.yaml; id="
            in (path.read_text())
        )
    if suffix == ".iges":
        lines = path.read_text().splitlines()
        assert {len(line) for line in lines} == {80}
        starts = sum(line[72] == "S" for line in lines)
        assert lines[-1].startswith(f"S{starts:7d}G")


@pytest.mark.parametrize("suffix", [".yaml", ".csv", ".xlsx"])
def test_definitions_are_read_as_before(folder, blade, suffix):
    assert bg.read(folder / f"a{suffix}").length == pytest.approx(blade.length)


@pytest.mark.parametrize(
    ("name", "content", "line"),
    [
        ("a.htc", "; blade\nbegin new_htc_structure ;\n", 0),
        ("a.dat", "---- AERODYN BLADE ----\nby bladegen\n== Properties ==\n", 1),
    ],
)
def test_files_of_aeroelastic_codes_hold_it_in_comments(tmp_path, blade, name, content, line):
    (tmp_path / name).write_text(content)
    made = made_from(blade, {}, COMMAND)
    marks.put(tmp_path / name, made)
    lines = (tmp_path / name).read_text().splitlines()
    old = content.splitlines()[1] + "; " if line else "; "  # no word of the file is lost
    assert lines[line] == old + made.text
    assert lines[-1] == content.splitlines()[-1]
    assert lines[0].startswith(content[0])
    assert marks.read(tmp_path / name) == made


def test_pictures_hold_it(tmp_path, blade):
    Image.new("RGB", (8, 8)).save(tmp_path / "a.png")
    made = made_from(blade, {"view": "oblique"})
    marks.put(tmp_path / "a.png", made)
    assert Image.open(tmp_path / "a.png").text["bladegen"] == made.text
    assert marks.read(tmp_path / "a.png") == made


@pytest.mark.parametrize("suffix", sorted({*SUFFIXES, *SLOW, ".txt"}))
@pytest.mark.parametrize(
    "content", [b"", b"solid x", b"glTF" + b"\xff" * 40, b"PK\x03\x04" + b"\0" * 30]
)
def test_foreign_and_damaged_files_say_nothing(tmp_path, suffix, content):
    path = tmp_path / f"a{suffix}"
    path.write_bytes(content)
    assert marks.read(path) is None
    assert marks.read(tmp_path / f"none{suffix}") is None
    assert marks.read(tmp_path) is None


def test_no_time_and_no_folder_is_in_it(products, blade):
    text = products.made_from(Kind.solid, ".step").text
    source = Path(blade.definition.source)
    assert source.is_absolute()
    assert str(source.parent) not in text
    assert "0x" not in word(lambda: None)
    moved = replace(blade, definition=replace(blade.definition, source=""))
    made = made_from(moved, {})
    assert (made.source, made.sha256) == ("", "")
    assert made.definition == made_from(blade, {}).definition


def test_files_of_another_build_are_listed_and_named(blade, tmp_path):
    def run(formats, **options):
        return build(blade, tmp_path, formats=formats, options=Options(stations=20, **options))

    first = run(["stl", "ply", "glb"], command="first")
    assert first["remarks"] == []
    second = run(["ply"], tip=round_tip, unit="mm", command="second")
    said = [remark for remark in second["remarks"] if "is of another build" in remark]
    assert said == [
        "nrel5mw.glb: is of another build: tip: flat, here round",
        "nrel5mw.stl: is of another build: tip: flat, here round; unit: m, here mm",
    ]
    by_name = {entry["name"]: entry for entry in second["files"]}
    assert by_name["nrel5mw.stl"]["settings"]["tip"] == "flat"
    assert by_name["nrel5mw.stl"]["command"] == "first"
    assert by_name["nrel5mw.ply"]["settings"]["tip"] == "round"
    assert by_name["nrel5mw.ply"]["command"] == "second"
    assert made_by(tmp_path / "nrel5mw.stl").settings == made_by(tmp_path / "nrel5mw.glb").settings
    third = run(["stl", "glb"], tip=round_tip, unit="mm")
    assert third["remarks"] == []
    assert json.loads(report_path(tmp_path, "nrel5mw").read_text())["files"] == third["files"]
