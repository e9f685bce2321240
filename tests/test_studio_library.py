from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from test_readers_tables import TABLE, airfoils, table

import bladegen as bg
from bladegen.airfoils.polars import Polar
from bladegen.errors import BladegenError, FileError, StudioError
from bladegen.exports.provenance import content_of
from bladegen.families.identity import fingerprint
from bladegen.studio import library as module
from bladegen.studio.library import Library

CONTENT = Path(bg.read("nrel5mw").source).read_bytes()


@pytest.fixture
def library(tmp_path):
    return Library(tmp_path)


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """A definition of two airfoils."""
    return bg.read(table(tmp_path_factory.mktemp("small"), TABLE))


def test_bundled_blades_are_there_and_made_once(library):
    assert set(library.labels) == set(bg.bundled())
    assert library.add("nrel5mw") == "nrel5mw"
    assert library.baseline("nrel5mw") is library.baseline("nrel5mw")
    assert library.baseline("nrel5mw").blade.name == "nrel5mw"
    with pytest.raises(StudioError, match="'gone' is not here"):
        library.baseline("gone")


def test_uploads_are_kept_under_their_content(library, tmp_path):
    key = library.upload(("../../etc/my blade.yaml", CONTENT))
    assert key.startswith("my_blade-")
    assert list(tmp_path.rglob("*.*")) == [tmp_path / key / "my_blade.yaml"]
    assert library.upload(("C:\\x\\my blade.yaml", CONTENT)) == key
    assert library.upload(("other.yaml", CONTENT)) != key
    assert library.entry(key).named == library.labels[key] == "my blade.yaml"
    assert library.baseline(key).blade.name == "my_blade"
    assert library.baseline(key).blade.length == pytest.approx(61.5)


def test_a_file_from_the_command_line_has_the_same_key_as_its_upload(library, tmp_path):
    path = tmp_path / "given" / "mine.yaml"
    path.parent.mkdir()
    path.write_bytes(CONTENT)
    key = library.add(str(path))
    assert library.upload(("mine.yaml", CONTENT)) == key
    assert library.entry(key).source == str(path)
    with pytest.raises(FileError, match="neither a bundled blade nor a file"):
        library.add("missing.yaml")


def test_shapes_that_a_file_only_names_come_from_a_folder(library, tmp_path):
    path, folder = tmp_path / "mine.csv", airfoils(tmp_path / "shapes")
    path.write_text(TABLE)
    with pytest.raises(FileError, match="--airfoils DIR"):
        library.add(str(path))
    key = library.add(str(path), folder)
    assert library.entry(key).airfoils == str(folder)
    assert library.baseline(key).blade.length == 20.0
    foil = folder / "naca.dat"
    foil.write_text(foil.read_text().replace("1.000000000", "0.999000000"))
    assert library.add(str(path), folder) not in (key, "mine")


@pytest.mark.parametrize("suffix", [".csv", ".xlsx", ".dat", ".htc"])
def test_files_that_belong_together_are_one_blade(library, small, tmp_path, suffix):
    place = tmp_path / "written"
    place.mkdir()
    path = place / f"blade{suffix}"
    bg.write(small, path)
    files = [(f.name, f.read_bytes()) for f in sorted(place.rglob("*.*")) if f.is_file()]
    assert len(files) >= 3 or suffix == ".xlsx"
    key = library.upload(*files)
    assert library.entry(key).named == path.name
    assert library.upload(*reversed(files)) == key
    definition = bg.read(path)
    assert content_of(library.baseline(key).blade.definition) == content_of(definition)
    assert fingerprint(bg.read(library.entry(key).source)) == fingerprint(definition)
    assert {p.name for p in tmp_path.iterdir()} == {"written", key}


@pytest.mark.parametrize("suffix", [".dat", ".htc"])
def test_files_with_polars_are_one_blade(library, small, tmp_path, suffix):
    alpha = np.radians([-180.0, 0.0, 180.0])
    polars = (Polar(alpha, np.zeros(3), np.ones(3), np.zeros(3), 1e6),)
    made = {s.airfoil.name: replace(s.airfoil, polars=polars) for s in small.stations}
    stations = tuple(replace(s, airfoil=made[s.airfoil.name]) for s in small.stations)
    place = tmp_path / "written"
    place.mkdir()
    bg.write(replace(small, stations=stations), place / f"blade{suffix}")
    files = [(f.name, f.read_bytes()) for f in sorted(place.rglob("*.*")) if f.is_file()]
    assert any("_part.dat" in name or "_pc.dat" in name for name, _ in files)
    key = library.upload(*files)
    assert library.entry(key).named == f"blade{suffix}"
    assert library.baseline(key).blade.definition.stations[-1].airfoil.polars


@pytest.mark.parametrize(
    ("files", "words"),
    [
        ({"a.csv": TABLE, "b.csv": TABLE}, "must hold one blade, got a.csv, b.csv"),
        ({"a.dat": "x", "b.dat": "x"}, "must hold one blade, got none"),
        ({"a b.csv": TABLE, "a_b.csv": TABLE}, "allowed are 500 of different names"),
        ({}, "got 0 files"),
        ({"a.csv": TABLE, "circle.dat": "x"}, "circle.dat holds no coordinates"),
        ({"a.csv": TABLE, "../naca.dat": "x"}, "naca.dat holds no coordinates"),
    ],
)
def test_files_that_are_no_blade_together_are_refused(library, tmp_path, files, words):
    with pytest.raises(FileError) as caught:
        library.upload(*[(name, content.encode()) for name, content in files.items()])
    assert words in str(caught.value)
    assert str(tmp_path) not in str(caught.value)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("bad.yaml", b"components: [1, 2", "bad.yaml: is no YAML"),
        ("bad.yaml", CONTENT.replace(b"chord:", b"chrod:"), "bad.yaml: "),
        ("bad.yaml", b"", "is empty"),
        ("deck.zip", CONTENT, "suffix '.zip'"),
        ("deck.htc", CONTENT, "holds no blade that is known"),
        ("mine.csv", TABLE.encode(), "`bladegen convert` it to .yaml first"),
        ("..", CONTENT, "suffix ''"),
    ],
)
def test_what_is_no_blade_is_refused_and_not_kept(library, tmp_path, name, content, words):
    with pytest.raises(BladegenError) as caught:
        library.upload((name, content))
    assert words in str(caught.value)
    assert str(tmp_path) not in str(caught.value)
    assert not list(tmp_path.iterdir())
    assert set(library.labels) == set(bg.bundled())


def test_too_large_a_file_is_refused(library, tmp_path, monkeypatch):
    monkeypatch.setattr(module, "UPLOAD_BYTES", 1000)
    with pytest.raises(FileError, match="larger than"):
        library.upload(("large.yaml", CONTENT[:999]), ("b.yaml", b"##"))
    assert not list(tmp_path.iterdir())


def test_only_the_latest_uploads_are_kept(library, tmp_path, monkeypatch):
    monkeypatch.setattr(module, "KEPT", 2)
    keys = [library.upload(("a.yaml", CONTENT + b"\n#" + bytes([65 + i]))) for i in range(3)]
    assert {path.name for path in tmp_path.iterdir()} == set(keys[-2:])
    assert set(library.labels) == {*bg.bundled(), *keys[-2:]}
    assert library.baseline(keys[-1]).blade.length == pytest.approx(61.5)
