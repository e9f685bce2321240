"""Definitions are compared with files as these were made; what still differs is told."""

from pathlib import Path

import pytest

import bladegen as bg
from bladegen.blade.edges import MinimumThickness
from bladegen.cli.options.provenance import alike
from bladegen.surface.tips import flat_tip, round_tip


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=51)


@pytest.fixture(scope="module")
def folder(blade, tmp_path_factory):
    target = tmp_path_factory.mktemp("files")
    thick = blade.with_trailing_edge(MinimumThickness(0.02)).mirror_image()
    bg.export(thick, target / "thick.ply", stations=12, tip=round_tip)
    bg.export(blade, target / "plain.obj", stations=12)
    bg.export(blade.perturbed(chord=1.1), target / "wide.ply", stations=12)
    (target / "foreign.stl").write_text("solid x\nendsolid x\n")
    return target


def test_a_blade_is_made_as_the_file_was(blade, folder):
    (one, two), tips, said = alike([folder / "thick.ply", blade])
    assert one == folder / "thick.ply"
    assert str(two.trailing_edge) == "20mm"
    assert two.mirrored
    assert len(two.u) == 51
    assert tips == [flat_tip, round_tip]
    told = "nrel5mw is taken as thick.ply was made: trailing edge 20mm, mirrored yes, tip round"
    assert said == [told]


def test_what_was_made_alike_is_not_told(blade, folder):
    (one, _), _, said = alike([blade, folder / "plain.obj"])
    assert said == []
    assert (one.sections([0.5]) == blade.sections([0.5])).all()


def test_files_are_held_against_each_other(blade, folder):
    said = alike([folder / "plain.obj", folder / "thick.ply"])[2]
    assert sorted(said) == [
        "mirrored: none in plain.obj, yes in thick.ply",
        "tip: flat in plain.obj, round in thick.ply",
        "trailing edge: 2mm,1% in plain.obj, 20mm in thick.ply",
    ]
    said = alike([folder / "wide.ply", blade])[2]
    assert "change1.chord: 1.1 in wide.ply, none in nrel5mw" in said


def test_foreign_files_are_taken_as_they_are(blade, folder):
    things = [folder / "foreign.stl", blade]
    assert alike(things) == (things, [flat_tip, flat_tip], [])
    assert alike([Path("none.step"), folder / "plain.obj"])[2] == []
