"""What another process answers: lift, drag, power, structure and mass, beside the baseline's."""

import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.blade.aero.evaluation import evaluated
from bladegen.blade.aero.performance import coefficients
from bladegen.curves import polygons
from bladegen.errors import MissingLibraryError
from bladegen.studio.page.drawing.layers import layers
from bladegen.studio.page.drawing.lift import lift
from bladegen.studio.page.figures import rows, table
from bladegen.studio.results import answers
from bladegen.studio.results.answers import UNSOUND, about_blade, about_section
from bladegen.studio.results.question import Question
from bladegen.studio.state import State

MOVED = State("iea15mw", (0.03, -0.02, 0.01, 0.005), thickness=1.05, twist=1.0, at=0.4)
ASKED = Question("iea15mw", None, MOVED)


@pytest.fixture(scope="module")
def section():
    return about_section(ASKED)


@pytest.fixture(scope="module")
def blade():
    return about_blade(ASKED)


@pytest.fixture(scope="module")
def variant():
    return ASKED.baseline.variant(MOVED)


def test_the_rotor_is_that_of_evaluate_at_the_files_tip_speed_ratio(blade, variant):
    found = evaluated([ASKED.baseline.blade, variant])
    point = np.full((2, 1), 9.0), np.full((2, 1), found.performance.pitch[0])
    known = coefficients(found.elements, found.polars.extended(), 3, *point)[:, 0]
    for rotor, row in ((blade.rotor.before, known[0]), (blade.rotor.now, known[1])):
        assert_allclose([rotor.power, rotor.thrust, rotor.moment], row, rtol=1e-9)
    assert blade.working.ratio == 9.0  # control.optimal_tsr


def test_a_section_works_at_the_angle_that_the_baselines_rotor_gives_it(section):
    now, before = section.lift.now, section.lift.before
    assert now.at == before.at
    assert 4.0 < now.at < 8.0
    assert 0.9 < before.lift < 1.5
    assert now.lift / now.drag != before.lift / before.drag
    assert about_section(replace(ASKED, state=replace(MOVED, twist=3.0))).lift.now.at == now.at


def test_mass_and_layers_are_those_of_the_layup(section, blade, variant):
    laid = variant.layup.at(np.array([0.4]))
    assert section.inside.now.mass == float(laid.mass_per_length[0])
    assert blade.mass.now == variant.layup.mass
    assert blade.mass.before == ASKED.baseline.blade.layup.mass
    area = sum(
        abs(float(polygons.measure(piece.border)[0])) for piece in section.inside.now.section.pieces
    )
    assert area == pytest.approx(float((laid.width * laid.thickness).sum()), rel=0.05)


def test_what_cannot_be_known_is_said(monkeypatch):
    bad = replace(ASKED, state=State("iea15mw", (-0.145, 0.111, -0.078, 0.06)))
    assert about_section(bad).lift.trouble == about_blade(bad).rotor.trouble == UNSOUND
    bare = Question("dtu10mw", None, State("dtu10mw", at=0.6))
    assert about_section(bare).inside.trouble == answers.BARE
    assert about_section(bare).lift.now is not None

    def missing(*_):
        raise MissingLibraryError(ImportError(name="neuralfoil"))

    monkeypatch.setattr(answers.Working, "lift", missing)
    said = about_section(replace(bare, state=replace(bare.state, at=0.61))).lift.trouble
    assert "bladegen[aero]" in said


def test_without_a_hub_radius_the_section_is_known_and_the_rotor_is_not():
    blade = bg.Blade.from_definition(bg.read("dtu10mw"))
    rotor = replace(blade.definition.rotor, hub_radius=None)
    working = answers.Working.of(replace(blade, definition=replace(blade.definition, rotor=rotor)))
    assert "names no hub radius" in working.trouble
    assert working.lift(blade, 0.7).at == 6.0
    with pytest.raises(bg.errors.BladegenError, match="names no hub radius"):
        working.rotor(blade)


def test_figures_say_by_how_much_they_differ(section, blade):
    found = rows(section, blade)
    assert list(found) == ["Section at 40 %", "Blade"]
    by_name = {row.name: row for those in found.values() for row in those}
    mass = by_name["Mass, t"]
    assert mass.change == f"{100 * (blade.mass.now / blade.mass.before - 1):+.1f} %"
    page = ET.fromstring(table(found))
    assert len(page.findall("tr")) == 1 + 2 + len(by_name)
    plain = rows(about_section(replace(ASKED, state=MOVED.reset())), None)
    assert {row.change for those in plain.values() for row in those} == {""}


def test_charts_of_lift_and_layers_are_drawn_within_their_frames(section):
    inside = section.inside
    for svg in (
        lift(section.lift.now, section.lift.before),
        layers(inside.now.section, inside.before.section, inside.now.mass, inside.before.mass),
    ):
        root = ET.fromstring(svg)
        width, height = (float(word) for word in root.get("viewBox").split()[2:])
        for part in root.iter("path"):
            pairs = part.get("d").strip("MZ").replace(" L", " ").split()
            points = np.array([pair.strip("ML").split(",") for pair in pairs], dtype=float)
            assert points.min() >= 0.0
            assert (points <= [width, height]).all()
        assert "baseline" in root.get("aria-label")
