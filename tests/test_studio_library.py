from pathlib import Path

import pytest
from test_readers_tables import TABLE, airfoils

import bladegen as bg
from bladegen.errors import BladegenError, FileError, StudioError
from bladegen.studio import library as module
from bladegen.studio.library import Library

CONTENT = Path(bg.read("nrel5mw").source).read_bytes()


@pytest.fixture
def library(tmp_path):
    return Library(tmp_path)


def test_bundled_blades_are_there_and_made_once(library):
    assert set(library.labels) == set(bg.bundled())
    assert library.add("nrel5mw") == "nrel5mw"
    assert library.baseline("nrel5mw") is library.baseline("nrel5mw")
    assert library.baseline("nrel5mw").blade.name == "nrel5mw"
    with pytest.raises(StudioError, match="'gone' is not here"):
        library.baseline("gone")


def test_uploads_are_kept_under_their_content(library, tmp_path):
    key = library.upload("../../etc/my blade.yaml", CONTENT)
    assert key.startswith("my_blade-")
    assert list(tmp_path.rglob("*.*")) == [tmp_path / key / "my_blade.yaml"]
    assert library.upload("C:\\x\\my blade.yaml", CONTENT) == key
    assert library.upload("other.yaml", CONTENT) != key
    assert library.entry(key).named == library.labels[key] == "my blade.yaml"
    assert library.baseline(key).blade.name == "my_blade"
    assert library.baseline(key).blade.length == pytest.approx(61.5)


def test_a_file_from_the_command_line_has_the_same_key_as_its_upload(library, tmp_path):
    path = tmp_path / "given" / "mine.yaml"
    path.parent.mkdir()
    path.write_bytes(CONTENT)
    key = library.add(str(path))
    assert library.upload("mine.yaml", CONTENT) == key
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
    library._baselines.clear()
    assert library.baseline(key).blade.length == 20.0
    foil = folder / "naca.dat"
    foil.write_text(foil.read_text().replace("1.000000000", "0.999000000"))
    assert library.add(str(path), folder) not in (key, "mine")


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("bad.yaml", b"components: [1, 2", "bad.yaml: is no YAML"),
        ("bad.yaml", CONTENT.replace(b"chord:", b"chrod:"), "bad.yaml: "),
        ("bad.yaml", b"", "is empty"),
        ("deck.htc", CONTENT, "suffix '.htc'"),
        ("..", CONTENT, "suffix ''"),
    ],
)
def test_what_is_no_blade_is_refused_and_not_kept(library, tmp_path, name, content, words):
    with pytest.raises(BladegenError) as caught:
        library.upload(name, content)
    assert words in str(caught.value)
    assert str(tmp_path) not in str(caught.value)
    assert not list(tmp_path.iterdir())
    assert set(library.labels) == set(bg.bundled())


def test_too_large_a_file_is_refused(library, tmp_path, monkeypatch):
    monkeypatch.setattr(module, "UPLOAD_BYTES", 1000)
    with pytest.raises(FileError, match="larger than"):
        library.upload("large.yaml", CONTENT)
    assert not list(tmp_path.iterdir())


def test_only_the_latest_uploads_are_kept(library, tmp_path, monkeypatch):
    monkeypatch.setattr(module, "KEPT", 2)
    keys = [library.upload("a.yaml", CONTENT + b"\n#" + bytes([65 + i])) for i in range(3)]
    assert {path.name for path in tmp_path.iterdir()} == set(keys[-2:])
    assert set(library.labels) == {*bg.bundled(), *keys[-2:]}
    assert library.baseline(keys[-1]).blade.length == pytest.approx(61.5)
