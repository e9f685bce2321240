"""Webs and layers on a blade's sections: places, widths, masses, and what does not fit."""

import json
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from typer.testing import CliRunner

import bladegen as bg
from bladegen.blade.edges import MinimumThickness
from bladegen.blade.layup.pieces import section
from bladegen.cli import commands
from bladegen.definition.structure.positions import LEADING_EDGE, Arc, PlaneCut, Shifted
from bladegen.measures.checks import check_blade

ETA = np.array([0.0, 0.13, 0.4, 0.77, 1.0])
constant = bg.Distribution.constant
THIN = constant(0.01)
DENSITY = 1900.0
TE = Arc(constant(0.0)), Arc(constant(1.0))
PUBLISHED = 65.25e3  # kg, Gaertner et al., NREL/TP-5000-75698 (2020)


@pytest.fixture(scope="module")
def plain():
    return bg.read("iea15mw")


@pytest.fixture(scope="module")
def bare(plain):
    return bg.Blade.from_definition(replace(plain, structure=None), landmarks=201)


def inside(bare, *layers, webs=()):
    """The layup of a blade with these layers, all of one material."""
    structure = bg.Structure((bg.Material("glass", DENSITY),), webs, layers)
    return replace(bare, definition=replace(bare.definition, structure=structure)).layup


def layer(name, start, end, thickness=THIN, **more):
    return bg.Layer(name, "glass", thickness, start, end, **more)


def strip(middle, width):
    return Shifted(middle, constant(width), -0.5), Shifted(middle, constant(width), 0.5)


def at(fraction):
    return Arc(constant(fraction))


def test_a_blade_without_structure_has_no_layup(bare):
    assert bare.layup is None


def test_a_skin_weighs_its_outline(bare):
    laid = inside(bare, layer("skin", *TE)).at(ETA)
    around = bare.sections(ETA)
    around = np.concatenate([around, around[:, :1]], axis=1)  # the trailing edge among it
    steps = np.linalg.norm(np.diff(around, axis=1), axis=-1)
    assert_allclose(laid.width[0], steps.sum(axis=1), rtol=1e-12)
    assert_allclose(laid.mass_per_length, DENSITY * 0.01 * steps.sum(axis=1), rtol=1e-12)
    middles = 0.5 * (around[:, 1:] + around[:, :-1])
    centre = (middles * steps[..., None]).sum(axis=1) / steps.sum(axis=1)[:, None]
    assert_allclose(laid.centre, centre, atol=1e-9)


def test_layers_side_by_side_are_the_skin(bare):
    cuts = [0.0, 0.111, 0.36, 0.5001, 0.9, 1.0]
    parts = [layer(f"{start:g}", at(start), at(end)) for start, end in pairwise(cuts)]
    split, whole = inside(bare, *parts), inside(bare, layer("skin", *TE))
    assert_allclose(split.at(ETA).mass_per_length, whole.at(ETA).mass_per_length, rtol=1e-12)
    assert_allclose(split.at(ETA).centre, whole.at(ETA).centre, atol=1e-9)
    assert_allclose(split.mass, whole.mass, rtol=1e-12)
    assert_allclose(split.centre, whole.centre, atol=1e-9)
    assert sum(split.layer_masses.values()) == pytest.approx(split.material_masses["glass"])


def trailing_edge(blade, eta):
    """Corners (k, 3) of the suction and the pressure side, and how far they are apart."""
    first, last = blade.sections(eta)[:, [0, -1]].swapaxes(0, 1)
    return first, last, np.linalg.norm(last - first, axis=-1)


@pytest.fixture(scope="module")
def blunt(bare):
    """The same blade with a trailing edge 8 % of the chord wide outside of its root."""
    return bg.Blade.from_definition(
        bare.definition, landmarks=101, trailing_edge=MinimumThickness(0.5, 0.08)
    )


def test_a_layer_that_reaches_the_trailing_edge_covers_its_half_of_it(blunt):
    first, last, wide = trailing_edge(blunt, ETA)
    kinds = {"whole": TE, "upper": (at(0.0), at(0.3)), "lower": (at(0.6), at(1.0)),
             "off": (at(0.1), at(0.9)), "none": (at(0.0), at(0.0))}  # fmt: skip
    laid = inside(blunt, *(layer(name, *ends) for name, ends in kinds.items())).at(ETA)
    outline = np.linalg.norm(np.diff(blunt.sections(ETA), axis=1), axis=-1).sum(axis=1)
    shares = {"whole": (1.0, 1.0), "upper": (0.3, 0.5), "lower": (0.4, 0.5), "off": (0.8, 0.0)}
    for name, width in zip(kinds, laid.width, strict=True):
        part, edge = shares.get(name, (0.0, 0.0))
        assert_allclose(width, part * outline + edge * wide, rtol=1e-9, atol=1e-12, err_msg=name)
    assert_allclose(2.0 * laid.half_edge * outline, wide, rtol=1e-9)
    short = inside(blunt, layer("a", at(0.0), at(1e-4))).at(ETA)
    assert_allclose(short.centre[2], 0.75 * first[2] + 0.25 * last[2], atol=2e-3)


def test_a_layer_around_the_trailing_edge_is_its_two_halves(blunt):
    wide = constant(0.8)
    ends = Shifted(at(1.0), wide, -0.5), Shifted(at(0.0), wide, 0.5)
    halves = layer("lower", ends[0], at(1.0)), layer("upper", at(0.0), ends[1])
    layup = inside(blunt, layer("around", *ends), *halves)
    whole, lower, upper = (layup.at(ETA).layer_mass[i] for i in range(3))
    assert_allclose(whole, lower + upper, rtol=1e-12)
    assert_allclose(whole / DENSITY / 0.01, 0.8 + trailing_edge(blunt, ETA)[2], rtol=1e-9)
    centre = layup.at(ETA).layer_centre
    assert_allclose(centre[0] * whole[:, None], centre[1] * lower[:, None] + centre[2]
                    * upper[:, None])  # fmt: skip
    assert_allclose(layup.at(ETA).arcs[0].sum(axis=-1), 0.0, atol=1e-9)


def test_a_drawing_shows_the_trailing_edge_covered(blunt):
    wide = constant(0.8)
    edge = layer("edge", Shifted(at(1.0), wide, -0.5), Shifted(at(0.0), wide, 0.5))
    drawn = section(inside(blunt, edge, layer("skin", *TE)).blade, 0.6)
    assert [piece.layer for piece in drawn.pieces] == ["edge", "edge", "skin"]
    middle = 0.5 * drawn.outline[[1, -2]].sum(axis=0)
    for piece in drawn.pieces[:2]:
        assert np.linalg.norm(piece.border - middle, axis=-1).min() < 1e-9


def test_places_on_the_round_root_are_those_of_its_circle(bare):
    radius, off, width = 0.5 * float(bare.chord(0.0)), 0.7, 0.8
    cuts = tuple(PlaneCut(side, constant(off)) for side in ("suction", "pressure"))
    walls = bg.Web("main", *cuts)
    cap, wall = layer("cap", *strip(cuts[0], width)), layer("wall", *TE, web="main")
    laid = inside(bare, cap, wall, webs=(walls,)).at(0.0)
    y = float(bare.axis(0.0)[1]) + off
    circle = bare.sections(0.0)
    centre = 0.5 * (circle.min(axis=0) + circle.max(axis=0))
    assert_allclose(laid.web_height, 2.0 * np.sqrt(radius**2 - (y - centre[1]) ** 2), rtol=1e-3)
    assert_allclose(laid.width, [width, laid.web_height[0]], rtol=1e-9)
    assert_allclose(laid.layer_centre[:, 1], [y, y], atol=0.02)
    assert laid.layer_centre[0, 0] > centre[0]  # x points to the suction side
    assert_allclose(laid.layer_centre[1, 0], centre[0], atol=2e-3)
    assert_allclose(np.diff(laid.arcs[0]), width / (2.0 * np.pi * radius), rtol=2e-3)


@pytest.mark.parametrize("rotation", [0.0, 0.1])
def test_a_plane_of_the_root_is_flat_whatever_the_twist(bare, rotation):
    turn = constant(rotation) if rotation else None
    plane = PlaneCut("pressure", constant(0.3), turn)
    laid = inside(bare, layer("line", plane, plane)).at(ETA[1:-1])
    found = np.array(
        [
            bare.point(eta, _landmark(bare, eta, arc))
            for eta, arc in zip(ETA[1:-1], laid.arcs[0, :, 0], strict=True)
        ]
    )
    off = found - bare.axis(ETA[1:-1])
    y = off[:, 1] * np.cos(rotation) + off[:, 0] * np.sin(rotation)
    assert_allclose(y, 0.3, atol=5e-3)  # sections lean with the axis


def _landmark(blade, eta, fraction):
    steps = np.linalg.norm(np.diff(blade.sections(eta), axis=0), axis=-1)
    along = np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()
    return np.interp(fraction, along, blade.u)


def test_a_rotation_from_the_chord_by_the_twist_back_is_the_root_s(bare):
    twist = bare.definition.twist
    back = replace(twist, values=-twist.values)
    planes = [
        PlaneCut("suction", constant(0.2)),
        PlaneCut("suction", constant(0.2), back, "chord"),
        PlaneCut("suction", constant(0.2), through=(0.0, 1.0)),
    ]
    laid = inside(bare, *(layer(str(i), *strip(one, 0.1)) for i, one in enumerate(planes))).at(ETA)
    assert_allclose(laid.arcs[0], laid.arcs[1], atol=1e-12)
    assert_allclose(laid.arcs[0], laid.arcs[2], atol=1e-12)  # its axis is straight in y


def test_a_batch_equals_its_parts_and_a_scalar(bare):
    web = bg.Web("main", at(0.2), at(0.7))
    layup = inside(bare, layer("skin", *TE), layer("wall", *TE, web="main"), webs=(web,))
    many, grid = layup.at(ETA), layup.at(ETA.reshape(5, 1))
    one = layup.at(ETA[2])
    for name in ("arcs", "thickness", "width", "web_arcs", "web_height", "layer_centre"):
        assert_allclose(getattr(grid, name)[:, :, 0], getattr(many, name), rtol=1e-12)
        assert_allclose(getattr(one, name), getattr(many, name)[:, 2], rtol=1e-9)
    assert one.mass_per_length.shape == ()
    assert grid.centre.shape == (5, 1, 3)


def test_a_mirror_image_weighs_the_same_on_the_other_side(bare):
    layup = inside(bare, layer("cap", *strip(PlaneCut("suction", constant(0.2)), 0.5)))
    other = layup.blade.mirror_image().layup
    assert_allclose(other.mass, layup.mass, rtol=1e-12)
    assert_allclose(other.centre, layup.centre * [1.0, -1.0, 1.0], rtol=1e-9)
    assert other.findings == layup.findings


def test_nothing_is_outside_of_its_grid(bare):
    part = bg.Distribution([0.2, 0.6], [0.01, 0.01])
    layup = inside(
        bare,
        layer("short", *TE, thickness=part, extent=(0.2, 0.6)),
        layer("narrow", LEADING_EDGE, Shifted(LEADING_EDGE, part)),
    )
    laid = layup.at([0.1, 0.2, 0.6, 0.7])
    assert_allclose(laid.thickness[0], [0.0, 0.01, 0.01, 0.0])
    assert_allclose(laid.width[1], [0.0, 0.01, 0.01, 0.0], atol=1e-12)


def test_places_follow_their_rule_on_a_perturbed_blade(bare):
    cap = layer("cap", *strip(PlaneCut("suction", constant(0.0)), 0.6))
    layup = inside(bare, cap, layer("part", at(0.1), at(0.2)))
    wide = layup.blade.perturbed(chord_scale=1.2).layup
    before, after = layup.at(ETA[:-1]), wide.at(ETA[:-1])
    assert_allclose(after.arcs[1], before.arcs[1])
    assert_allclose(after.width[1], 1.2 * before.width[1], rtol=1e-3)
    assert_allclose(after.width[0], before.width[0], rtol=1e-9)
    assert np.all(np.diff(after.arcs[0]) < np.diff(before.arcs[0]))


def findings(*args, **kwargs):
    return [str(finding) for finding in inside(*args, **kwargs).findings]


def test_what_fits_has_no_findings(bare):
    web = bg.Web("main", *(PlaneCut(side, constant(0.0)) for side in ("suction", "pressure")))
    assert findings(bare, layer("skin", *TE), layer("wall", *TE, web="main"), webs=(web,)) == []


@pytest.mark.parametrize(
    ("layers", "said"),
    [
        ([layer("a", at(0.4), at(0.3))], "a: starts behind its end, by up to 0.100 of the arc"),
        ([layer("a", at(-0.1), at(0.3))], "a: reaches 0.100 of the arc beyond the trailing edge"),
        (
            [
                layer("a", *strip(LEADING_EDGE, 0.5)),
                layer("b", *strip(PlaneCut("suction", constant(-0.1)), 9.0)),
            ],
            "a: overlaps b, by up to",
        ),
        (
            [
                layer("a", Shifted(at(1.0), constant(0.2), -0.5), Shifted(at(0.0), THIN, 0.5)),
                layer("b", *strip(at(0.98), 0.1)),
            ],
            "a: overlaps b, by up to",
        ),
        (
            [layer("a", *strip(PlaneCut("suction", constant(30.0)), 0.1))],
            "a: has a thickness where it has no place; not counted there (eta = 0.000 to 1.000)",
        ),
        (
            [layer("a", *strip(LEADING_EDGE, 0.1), stated=(constant(0.1), None))],
            "1 of 1 webs and layers lie up to 0.",
        ),
    ],
)
def test_what_does_not_fit_is_a_finding(bare, layers, said):
    assert said in " ".join(findings(bare, *layers))


def test_a_leaning_web_and_one_that_ends_early_are_findings(bare):
    lean, short = bg.Web("lean", at(0.1), at(0.6)), bg.Web("short", at(0.3), at(0.7), (0.1, 0.5))
    walls = [layer(name, *TE, web=name) for name in ("lean", "short")]
    said = findings(bare, *walls, webs=(lean, short))
    assert "lean: is higher than the section is thick" in said[1]
    assert said[0].endswith("not counted there (eta = 0.000 to 0.095, 0.505 to 1.000)")


def test_a_table_that_runs_out_beyond_the_end_of_its_web_is_a_remark_alone(bare):
    web = bg.Web("main", *(PlaneCut(side, constant(0.0)) for side in ("suction", "pressure")),
                 (0.13, 0.87))  # fmt: skip
    table = bg.Distribution([0.0, 0.1, 0.2, 0.8, 0.9, 1.0], [0.0, 0.0, 0.01, 0.01, 0.0, 0.0])
    runs = inside(bare, layer("wall", *TE, table, web="main"), webs=(web,))
    assert not runs.findings
    (said,) = map(str, runs.remarks)
    assert said.startswith("structure: main: their thickness runs out to 0")
    short = inside(
        bare, layer("wall", *TE, table, web="main"), webs=(replace(web, extent=(0.13, 0.7)),)
    )
    assert "main: has a thickness where it has no place" in str(short.findings[0])
    assert not inside(bare, layer("skin", *TE)).remarks


def test_check_weighs_the_layers_and_says_what_does_not_fit(bare):
    blade = inside(bare, layer("a", at(0.4), at(0.3)), layer("skin", *TE)).blade
    figures = check_blade(blade).figures
    assert figures["structure_mass_kg"] == blade.layup.mass
    assert any("a: starts behind its end" in said for said in figures["findings"])


@pytest.fixture(scope="module")
def file():
    home = Path(pytest.importorskip("windIO.examples.turbine").__file__).parent
    return home / "IEA-15-240-RWT.yaml"


@pytest.fixture(scope="module")
def iea15(file):
    return bg.Blade.from_definition(bg.read(file), landmarks=201)


def test_info_lists_webs_layers_and_what_they_weigh(file, iea15):
    figures = json.loads(CliRunner().invoke(commands.app, ["info", str(file), "--json"]).output)
    assert_allclose(figures["structure_mass_kg"], iea15.layup.mass, rtol=1e-3)
    assert figures["webs"] == ["web0", "web1"]
    assert_allclose(sum(one["mass_kg"] for one in figures["layers"]), figures["structure_mass_kg"])
    assert_allclose(
        sum(one["mass_kg"] for one in figures["materials"]), figures["structure_mass_kg"]
    )
    said = "structure: web0, web1: their thickness runs out to 0 at the next point of its table"
    assert [one for one in figures["findings"] if one.startswith(said)]
    assert not iea15.layup.findings  # and a build says nothing of it


def test_the_iea_15_mw_weighs_what_is_published(iea15):
    layup = iea15.layup
    assert_allclose(layup.mass, PUBLISHED, rtol=0.05)
    assert (len(layup.structure.webs), len(layup.structure.layers)) == (2, 18)


def test_the_rules_of_the_iea_15_mw_are_where_its_own_tool_found_them(iea15):
    """WISDEM takes the nearest of its points, so that it is off by half a hundredth of the arc."""
    eta = np.linspace(0.1, 0.95, 30)
    layup = iea15.layup
    laid = layup.at(eta)
    for i, one in enumerate(layup.structure.layers):
        for end, stated in enumerate(() if one.web else one.stated):
            if stated is not None and one.thickness.values.any():
                assert_allclose(laid.arcs[i, :, end], stated(eta), atol=0.01, err_msg=one.name)
    for web, arcs in zip(layup.structure.webs, laid.web_arcs, strict=True):
        for end, stated in enumerate(web.stated):
            assert_allclose(arcs[:, end], stated(eta), atol=0.01, err_msg=web.name)
