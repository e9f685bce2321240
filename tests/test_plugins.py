"""Packages of others add formats by entry points, and break nothing if they are broken."""

import pytest

MODULE = """
from pathlib import Path

import numpy as np

import bladegen as bg
from bladegen.exports.options import Kind
from bladegen.exports.registry import Format as Export
from bladegen.formats.format import Format, Reader, Writer

print("toys are loaded")


def recognises(path):
    return path.read_text().startswith("toy")


def read(path, notes, airfoils):
    words = path.read_text().split()
    if words[1:] == ["nothing"]:
        notes.problems.append("blade: is missing")
        return None
    return {"raise": lambda: 1 / 0, "none": lambda: None}.get(
        words[1], lambda: bg.read(words[1])
    )()


def write(definition, path):
    path.write_text(f"toy {definition.name}")
    return (bg.Finding("toy", "holds a name only"),)


def points(products, path):
    np.savetxt(path, products.mesh.vertices)


def broken(products, path):
    raise KeyError("of mine")


FORMATS = [
    Format("Toy", Reader((".toy",), "the word toy", recognises, read),
           (Writer("toy", "Toy of a blade", (".toy",), write, tolerance=None),)),
    Format("False windIO", Reader((".yaml",), "anything", lambda path: 1 / 0, read),
           (Writer("windio2", "False windIO", (".yaml", ".yml"), write),)),
]
EXPORTS = [
    Export(Kind.triangles, "points, m", points, ".points"),
    Export(Kind.triangles, "not STL", broken, ".stl"),
    Export(Kind.table, "cannot be", broken, ".broken"),
]
NO_ROW = 3
UNPLACED = Export(Kind.table, "cannot be", broken)
"""
ENTRIES = """
[bladegen.readers]
toys = toys:FORMATS
{readers}
[bladegen.exporters]
toys = toys:EXPORTS
{exporters}
"""


@pytest.fixture
def run(tmp_path, command):
    """Run code, or a command, where the package of toys is installed."""
    site = tmp_path / "site"
    info = site / "toys-1.0.dist-info"
    info.mkdir(parents=True)
    (site / "toys.py").write_text(MODULE)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: toys\nVersion: 1.0\n")

    def run(*arguments, readers="", exporters="", status=0):
        (info / "entry_points.txt").write_text(ENTRIES.format(readers=readers, exporters=exporters))
        code = f"import sys; sys.path.insert(0, {str(site)!r}); sys.argv[0] = 'bladegen'\n"
        begin = "from bladegen.cli.commands import main; main()"
        script = tmp_path / "script.py"
        script.write_text(code + (arguments[0] if len(arguments) == 1 else begin))
        done = command(*arguments[1:], script=str(script), folder=str(tmp_path))
        assert done["status"] == status, done["err"]
        assert "Traceback" not in done["err"]
        return done["out"] + done["err"]

    return run


def said_by(run, words, **options):
    return run("bladegen", *words.split(), **options)


def test_functions_find_formats_of_others(run, tmp_path):
    (tmp_path / "a.toy").write_text("toy nrel5mw")
    said = run(
        "import bladegen as bg; a = bg.read('a.toy'); print(a.name, a.format)\n"
        "print(*bg.write(a, 'b.toy')); print(*bg.write(a, 'c.toy', format='toy'))\n"
        "blade = bg.Blade.from_definition(a, landmarks=41)\n"
        "print(bg.export(blade, 'a.points', stations=20).stat().st_size > 1000)"
    )
    assert said.splitlines()[1:] == ["nrel5mw windIO 2", *["toy: holds a name only"] * 2, "True"]
    assert (tmp_path / "b.toy").read_text() == "toy nrel5mw"


def test_commands_and_lists_find_formats_of_others(run, tmp_path):
    (tmp_path / "a.toy").write_text("toy nrel5mw")
    assert "Toy of a blade" in said_by(run, "convert a.toy b.toy")
    assert "windIO 2" in said_by(run, "convert b.toy b.yaml")
    said_by(run, "build a.toy -o out --format points,csv --landmarks 41 --stations 20")
    assert {"nrel5mw.points", "nrel5mw.csv"} <= {path.name for path in (tmp_path / "out").iterdir()}
    said = said_by(run, "formats")
    assert ".toy" in said
    assert ".points" in said
    (tmp_path / "a.toys").write_text("toy nrel5mw")
    assert ".toy" in said_by(run, "info a.toys", status=1).split("allowed are .yaml,")[1]
    assert ".toy, or none" in said_by(run, "convert a.toy b.toys", status=1)
    assert ".points" in said_by(run, "build a.toy -o out --format toys", status=1)


def test_own_formats_load_no_plugins_and_are_not_hidden(run, tmp_path):
    said = said_by(run, "convert nrel5mw a.yaml")
    assert "toys are loaded" not in said
    assert "windIO 2" in said
    (tmp_path / "b.yaml").write_text("toy nrel5mw")
    assert "windIO" in said_by(run, "info b.yaml", status=1)
    said = run(
        "import bladegen as bg\n"
        "blade = bg.Blade.from_definition(bg.read('nrel5mw'), landmarks=41)\n"
        "print(bg.export(blade, 'a.stl', stations=20)); print('toys' in sys.modules)"
    )
    assert said.split() == ["a.stl", "False"]


READ = """
import bladegen as bg
for text in ("toy nothing", "toy raise", "toy none", "other"):
    with open("a.toy", "w") as file:
        file.write(text)
    try:
        bg.read("a.toy")
    except bg.BladegenError as error:
        print(error)
"""


def test_what_a_plugin_cannot_read_or_write_is_one_line(run):
    assert run(READ).splitlines() == [
        "toys are loaded",
        "a.toy: blade: is missing",
        "a.toy: plug-in toys: ZeroDivisionError: division by zero",
        "a.toy: plug-in toys: TypeError: read: got None, must be a BladeDefinition, or note a "
        "problem",
        "a.toy: holds no blade that is known, must hold the word toy (Toy)",
    ]
    said = said_by(run, "build nrel5mw -o out --format broken --landmarks 41", status=1)
    assert said.splitlines()[-1] == "bladegen: plug-in toys: KeyError: 'of mine'"


def test_broken_plugins_are_named_where_they_may_be_missed(run, tmp_path):
    (tmp_path / "a.toy").write_text("toy nrel5mw")
    (tmp_path / "a.toys").write_text("toy nrel5mw")
    entries = "a = not_there:ROW\nb = toys:NOTHING\nc = toys:NO_ROW"
    broken = {"readers": entries, "exporters": f"{entries}\nd = toys:UNPLACED"}
    faults = [
        "plug-in a (not_there:ROW) is not used: ModuleNotFoundError: No module named 'not_there'",
        "plug-in b (toys:NOTHING) is not used: AttributeError: module 'toys' has no attribute",
        "plug-in c (toys:NO_ROW) is not used: TypeError: got a int, must be a bladegen.",
    ]
    assert "nrel5mw" in said_by(run, "info a.toy", **broken)
    for words in ("info a.toys", "convert nrel5mw a.toys", "build nrel5mw -o out --format toys"):
        lines = said_by(run, words, status=1, **broken).splitlines()
        assert len(lines) == 2
        assert all(fault in lines[1] for fault in faults)
    said = " ".join(said_by(run, "formats", **broken).split())
    assert all(said.count(fault) == 2 for fault in faults)
    assert "plug-in d (toys:UNPLACED) is not used: ExportError: suffix: got ''" in said
