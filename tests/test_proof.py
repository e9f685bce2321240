"""What is written is read back and compared before it gets its name."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import bladegen as bg
from bladegen.definition.blade_definition import Airfoil, Distribution, Station
from bladegen.errors import ExportError, Finding
from bladegen.formats.into import write_into
from bladegen.formats.proof import compared, proven, put_in_place, taken_back
from bladegen.formats.windio import version2
from bladegen.formats.writing import FORMATS
from strategies import naca


@pytest.fixture(scope="module")
def small():
    """A blade of two airfoils on the NREL 5 MW's planform."""
    stations = [Station(eta, Airfoil(f"foil {eta}", naca(0.2, 0.02, 0.0))) for eta in (0.0, 1.0)]
    return replace(bg.read("nrel5mw"), stations=tuple(stations), relative_thickness=None)


def crossing():
    """An airfoil whose sides change places near the trailing edge."""
    points = naca(0.2, 0.0, 0.0).copy()
    points[1:4, 1] -= 0.05
    return Airfoil("crossing", points)


@pytest.mark.parametrize("format_", [row.name for row in FORMATS if row.tolerance is not None])
def test_what_cannot_be_read_back_is_not_written(tmp_path, small, format_, monkeypatch):
    suffix = next(row.suffixes[0] for row in FORMATS if row.name == format_)
    path = tmp_path / f"blade{suffix}"
    bg.write(small, path, format=format_)
    before = {file: file.read_bytes() for file in tmp_path.rglob("*") if file.is_file()}

    def refuse(draft):
        raise bg.errors.FileError(str(draft), ["chord: is nonsense"])

    monkeypatch.setattr("bladegen.formats.proof.read", refuse)
    with pytest.raises(ExportError, match=r"not written, for it could not be read back: chord"):
        bg.write(replace(small, chord=Distribution.constant(2.0)), path, format=format_)
    assert {file: file.read_bytes() for file in tmp_path.rglob("*") if file.is_file()} == before


@pytest.mark.parametrize("name", ["blade.yaml", "blade.csv", "blade.htc"])
def test_a_section_that_crosses_itself_is_not_written(tmp_path, small, name):
    odd = replace(small, stations=(small.stations[0], Station(1.0, crossing())))
    with pytest.raises(ExportError, match=r"not written, for it could not be read back: .*cross"):
        bg.write(odd, tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_a_pitch_axis_beyond_what_is_read_is_not_written(tmp_path, small):
    wide = replace(small, section_offset_y=Distribution.constant(8.0))
    with pytest.raises(ExportError, match=r"allowed is -1 to 2 of the chord"):
        bg.write(wide, tmp_path / "one.yaml", format="windio1")
    assert list(tmp_path.iterdir()) == []


def test_what_comes_back_as_another_blade_is_said_in_figures(small):
    assert compared(small, small, 1e-9) == ()
    chord = replace(small.chord, values=small.chord.values + 3e-3)
    (first, second) = compared(small, replace(small, chord=chord), 1e-3)
    assert str(first).startswith("read back: differs: chord by up to 3 mm at eta = ")
    assert "sections by up to" in str(second)
    twist = replace(small.twist, values=small.twist.values + 0.01)
    said = compared(small, replace(small, twist=twist), 1e-3)
    assert "twist by up to 0.57 deg" in str(said[0])
    odd = replace(small, stations=(small.stations[0], Station(1.0, crossing())))
    assert compared(small, odd, 1e-3)


def test_a_writer_that_loses_something_is_found_out(tmp_path, small):
    def lossy(path: Path) -> tuple[Finding, ...]:
        version2.write(replace(small, twist=Distribution.constant(0.0)), path)
        return (Finding("own", "remark"),)

    said = proven(lossy, tmp_path / "blade.yaml", small, 1e-3)
    assert [finding.where for finding in said] == ["own", "read back", "read back"]
    assert (tmp_path / "blade.yaml").is_file()


def test_files_that_a_format_takes_away_are_taken_away(tmp_path):
    path = tmp_path / "blade.htc"
    for name in ("blade.step", "blade_ae.dat", "blade_pc.dat"):
        (tmp_path / name).write_text(name)
    (tmp_path / "blade_htc_airfoils").mkdir()
    (tmp_path / "blade_htc_airfoils" / "old.dat").write_text("old")
    untouched = (tmp_path / "blade_ae.dat").stat().st_ino
    with put_in_place(path) as draft:
        draft.with_name("blade_pc.dat").unlink()
        (draft.parent / "blade_htc_airfoils" / "old.dat").unlink()
        (draft.parent / "blade_htc_airfoils" / "new.dat").write_text("new")
        draft.write_text("main")
    found = sorted(str(file.relative_to(tmp_path)) for file in tmp_path.rglob("*.*"))
    assert found == ["blade.htc", "blade.step", "blade_ae.dat", "blade_htc_airfoils/new.dat"]
    assert (tmp_path / "blade_ae.dat").stat().st_ino == untouched


def test_what_was_written_in_place_is_taken_back(tmp_path):
    path = tmp_path / "model.htc"
    path.write_text("before")
    (tmp_path / "model_blade_ae.dat").write_text("before")

    def fail():
        path.write_text("after")
        (tmp_path / "model_blade_ae.dat").unlink()
        (tmp_path / "model_blade_pc.dat").write_text("after")
        raise ExportError("no")

    with pytest.raises(ExportError, match="no"), taken_back(path):
        fail()
    assert {file.name: file.read_text() for file in tmp_path.iterdir()} == {
        "model.htc": "before",
        "model_blade_ae.dat": "before",
    }


def test_a_turbine_that_is_damaged_elsewhere_is_named(tmp_path, small):
    turbine, out = tmp_path / "turbine.yaml", tmp_path / "out.yaml"
    bg.write(replace(small, chord=Distribution.constant(2.0)), turbine)
    whole = turbine.read_text()
    turbine.write_text(whole.replace("number_of_blades: 3", "number_of_blades: many"))
    with pytest.raises(ExportError) as caught:
        write_into(small, turbine, out)
    said = str(caught.value)
    assert f"{turbine} cannot be read itself, apart from its blade: assembly.number_of_b" in said
    assert not out.exists()
    turbine.write_text(whole)
    write_into(small, turbine, out)
    assert np.isclose(bg.read(out).chord(0.3), small.chord(0.3))
