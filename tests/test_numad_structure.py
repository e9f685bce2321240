"""What lies inside the skin by a NuMAD workbook, against arithmetic on a round blade."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from openpyxl import Workbook
from refusals import findings

import bladegen as bg
from bladegen.blade.edges import MinimumThickness
from bladegen.blade.layup.outlines import Outlines
from bladegen.definition.structure.positions import (
    Arc,
    Between,
    EdgeMiddle,
    Limited,
    Shifted,
    around,
    extent_of,
    knots,
)
from bladegen.errors import DefinitionError
from bladegen.formats.common.document import Notes
from bladegen.formats.numad import components
from bladegen.formats.numad.keypoints import Widths, places
from strategies import circle

CHORD = np.array([2.0, 0.4])  # m at root and tip; a round section's side is half its outline
TWIST = 20.0  # deg
WIDE = Widths(0.1, 0.4, {"HP": 0.6, "LP": 0.6}, {"HP": 0.0, "LP": 0.0})
MATERIALS = [
    [1, "gel", "isotropic", 0.5, 3000, *[None] * 5, 0.5, None, None, 1200, 600, 70, 80],
    [2, "glass", "orthotropic", 1.0, 4e4, 1e4, None, 4000, None, None, 0.3, *[None] * 2, 1900],
    [3, "foam", "isotropic", 20.0, 50, *[None] * 5, 0.3, None, None, 100, None, 1, 1, "a report"],
]
PARTS = [  # group, name, material, angle, HP, LP, spans, plies, method
    [0, "gel", 1, 0, "le,te", "te,le", "[0, 1]", "[1, 1]", "pchip"],
    [0, "cap", 2, 0, "b,c", "b,c", "[0, 0.5, 1", "[40, 20, 0]", "linear"],
    [0, "front", 3, 0, "a,b", None, "[0, 1]", "[1, 1]", None],
    [0, "rear", 3, 0, None, "d , c", "[0.25, 0.75]", "[2, 2]", "spline"],
    [0, "edge", 2, 45, "d,te", "te,d", "[0, 1]", "[6, 6]", "pchip"],
    [0, "gel", 1, 0, "le,te", "le,te", "[0, 1]", "[2, 2]", "pchip"],
    [1, "wall", 2, 0, "b", "b", "[0.1, 0.9]", "[2, 2]", "pchip"],
    [2, "wall", 3, 0, "0.5b-c", "0.25b-c", "[0.1, 0.9]", "[1, 1]", "pchip"],
]


def numbered(rows, first):
    """Rows as a reader has them, from a row of the sheet on."""
    return [
        (first + i, tuple(float(c) if isinstance(c, int) else c for c in row))
        for i, row in enumerate(rows)
    ]


def above(cap=600, leading=100, trailing=400, offset=0):
    return [[], *([None, None, width] for width in (cap, leading, trailing, offset)), []]


def read(parts, materials=MATERIALS, widths=None, **more):
    notes = Notes()
    rows = numbered(above() if widths is None else widths, 1) + numbered(parts, 7)
    made = components.read(rows, numbered(materials, 4), notes, **more)
    assert not notes.problems  # nothing inside the skin refuses a file
    return made, [str(finding) for finding in notes.findings]


def workbook(path, *, swept="F", outputs=(None, None)):
    (path / "airfoils").mkdir()
    rows = "\n".join(f"{x:.12f} {y:.12f}" for x, y in circle(801))
    (path / "airfoils" / "round.dat").write_text(f"round\n{rows}\n")
    tail = [None, None, 0, "round"], [None, None, 20, "round"]
    geometry = [
        [],
        *([None, word] for word in ("F", "CW", swept)),
        [],
        [],
        *([20 * i, TWIST, CHORD[i], 100, 0.5, *tail[i], None, outputs[i]] for i in (0, 1)),
    ]
    book = Workbook()
    book.remove(book.active)
    content = {"Geometry": geometry, "components": [*above(), *PARTS], "Materials": [[]] * 3}
    content["Materials"] = [[], [], ["head"], *MATERIALS]
    for title, lines in content.items():
        sheet = book.create_sheet(title)
        for at, line in enumerate(lines, 1):
            for k, cell in enumerate(line, 1):
                sheet.cell(at, k, cell)
    book.save(path / "blade.xlsx")
    return path / "blade.xlsx"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return bg.read(workbook(tmp_path_factory.mktemp("numad")))


@pytest.fixture(scope="module")
def blade(made):
    return bg.Blade.from_definition(made, landmarks=401)


def lengths(blade, side, frame, widths=WIDE, eta=(0.0, 1.0)):
    """Where key points are from the leading edge [m], at root and tip."""
    outlines = Outlines.of(blade, np.array(eta))
    nose = outlines.fractions[:, outlines.fractions.shape[1] // 2]
    found = places(side, widths, frame).items()
    return {k: np.abs(outlines.places(place) - nose) * outlines.length for k, place in found}


@pytest.mark.parametrize(("side", "sign"), [("LP", 1.0), ("HP", -1.0)])
@pytest.mark.parametrize("frame", ["root", "chord"])
def test_key_points_of_a_circle(blade, side, sign, frame):
    """The nose is turned upwind, so that the plane along the blade is farther behind it below."""
    half = np.pi * CHORD / 2
    turned = sign * np.deg2rad(TWIST) * CHORD / 2 if frame == "root" else 0.0
    cap = half / 2 + turned
    rear = 0.96 if side == "LP" else 0.98
    wanted = {
        "le": 0.0 * half,
        "a": np.clip(0.1, 0.01 * half, 0.1 * half),
        "b": np.maximum(cap - 0.3, 0.15 * half),
        "c": np.minimum(cap + 0.3, 0.8 * half),
        "d": np.clip(half - 0.4, 0.85 * half, rear * half),
        "te": half,
    }
    found = lengths(blade, side, frame)
    assert list(found) == list(wanted)
    for label, there in wanted.items():
        assert_allclose(found[label], there, atol=2e-3, err_msg=label)
    assert wanted["a"][1] < 0.1 - 1e-3  # limits are met at the tip
    assert wanted["d"][1] > half[1] - 0.4 + 1e-3


def test_caps_have_a_width_and_an_offset_a_side(blade):
    widths = Widths(0.1, 0.4, {"HP": 0.4, "LP": 0.6}, {"HP": -0.1, "LP": 0.05})
    for side, behind, wide in (("HP", -0.1, 0.4), ("LP", 0.05, 0.6)):
        found = lengths(blade, side, "chord", widths, (0.0, 0.1))
        assert_allclose(found["c"] - found["b"], wide, atol=1e-9)
        about = np.pi * blade.chord(np.array([0.0, 0.1])) / 4
        assert_allclose(0.5 * (found["b"] + found["c"]) - about, behind, atol=2e-3)


def test_the_band_of_a_wide_edge_counts_from_its_middle():
    definition = bg.read("nrel5mw")
    blade = bg.Blade.from_definition(
        definition, landmarks=201, trailing_edge=MinimumThickness(0.05)
    )
    outlines = Outlines.of(blade, np.array([0.3, 0.5]))
    assert_allclose(outlines.half_edge, 0.025, rtol=1e-3)
    corner = {"suction": 0.0, "pressure": 1.0}
    for side, place in corner.items():
        off = (outlines.places(EdgeMiddle(side)) - place) * outlines.length
        assert_allclose(off, 0.025 * (2 * place - 1), rtol=1e-3)


def test_each_component_is_a_layer_of_its_plies(made):
    structure = made.structure
    names = "gel,cap HP,cap LP,front,rear,edge HP,edge LP,gel 2,wall,wall 2"
    assert [layer.name for layer in structure.layers] == names.split(",")
    by_name = {layer.name: layer for layer in structure.layers}
    cap = by_name["cap HP"].thickness
    assert_allclose(
        cap(np.array([0.0, 0.25, 0.5, 0.75, 1.0])), [0.04, 0.03, 0.02, 0.01, 0.0], atol=1e-9
    )
    assert by_name["rear"].extent == (0.25, 0.75)
    assert_allclose(by_name["edge LP"].angle(0.5), np.pi / 4)
    assert [web.extent for web in structure.webs] == [(0.1, 0.9)] * 2
    assert isinstance(structure.webs[1].start, Between)
    glass = structure.by_name["glass"]
    assert glass.E == (4e10, 1e10, 1e10)
    assert glass.G == (4e9,) * 3
    foam = structure.by_name["foam"]
    assert_allclose(foam.G, 50e6 / 2.6)
    assert foam.others == (("source", "a report"),)
    gel = structure.by_name["gel"]
    assert gel.tensile == (70e6,) * 3
    assert gel.others == (("area_density_dry", 0.6),)
    assert "what is empty is taken as pyNuMAD does: Ez as Ey" in findings(made)


def test_a_section_weighs_its_plies(blade):
    """Plies times thickness times width times density, at mid-span, by hand."""
    laid = blade.layup.at(0.5)
    half = np.pi * 1.2 / 2
    turned = np.deg2rad(TWIST) * 0.6
    front = {"HP": half / 2 - turned - 0.3, "LP": half / 2 + turned - 0.3}
    front = {side: max(0.15 * half, place) for side, place in front.items()}
    back = {
        side: min(0.8 * half, half / 2 + s * turned + 0.3) for side, s in (("HP", -1), ("LP", 1))
    }
    band = min(0.1, 0.1 * half)
    behind = np.clip(half - 0.4, 0.85 * half, 0.96 * half)

    def chord(first, second):
        return 1.2 * np.sin((first + second) / 1.2)

    middle = front["HP"] + 0.5 * (back["HP"] - front["HP"])
    quarter = front["LP"] + 0.25 * (back["LP"] - front["LP"])
    by_hand = {
        "gel": 1 * 0.5e-3 * 2 * half * 1200,
        "cap HP": 20 * 1e-3 * (back["HP"] - front["HP"]) * 1900,
        "cap LP": 20 * 1e-3 * (back["LP"] - front["LP"]) * 1900,
        "front": 1 * 20e-3 * (front["HP"] - band) * 100,
        "rear": 2 * 20e-3 * (behind - back["LP"]) * 100,
        "edge HP": 6 * 1e-3 * (half - behind) * 1900,
        "edge LP": 6 * 1e-3 * (half - behind) * 1900,
        "gel 2": 2 * 0.5e-3 * 2 * half * 1200,
        "wall": 2 * 1e-3 * chord(front["HP"], front["LP"]) * 1900,
        "wall 2": 1 * 20e-3 * chord(middle, quarter) * 100,
    }
    edge = laid.half_edge * laid.width[0]  # the circle is open there, by 2 mm
    assert edge < 2e-3
    assert_allclose(laid.layer_mass, list(by_hand.values()), rtol=7e-3)
    assert_allclose(laid.mass_per_length, sum(by_hand.values()), rtol=2e-3)


def test_the_rules_hold_on_a_variant(blade):
    variant = blade.perturbed(chord_scale=1.1)
    before, after = (one.layup.at(0.1) for one in (blade, variant))
    assert_allclose(after.width[1], before.width[1], rtol=1e-6)  # a cap keeps its width in metres
    assert_allclose(after.width[0], 1.1 * before.width[0], rtol=1e-6)


def test_windio_carries_it(made, blade, tmp_path):
    bg.write(made, tmp_path / "out.yaml", polars="keep")
    again = bg.Blade.from_definition(bg.read(tmp_path / "out.yaml"), landmarks=401)
    own, back = blade.layup.layer_masses, again.layup.layer_masses
    assert_allclose([back[name] for name in own], list(own.values()), rtol=2e-3)


@pytest.mark.parametrize(
    ("outputs", "extent", "said"),
    [
        ((2, 12), (0.15, 0.55), False),
        ((0, 40), (0.1, 0.9), True),
        ((None, None), (0.1, 0.9), False),
    ],
)
def test_spans_count_over_the_output_stations(tmp_path, outputs, extent, said):
    made = bg.read(workbook(tmp_path, swept="T", outputs=outputs))
    web = made.structure.webs[0]
    assert web.extent == pytest.approx(extent)
    assert web.start.base.base.frame == "chord"
    told = "Geometry!K7: output stations run 0 to 40 m, the blade 0 to 20 m"
    assert (told in findings(made)) is said


@pytest.mark.parametrize(
    ("row", "column", "value", "said"),
    [
        (1, 0, "x", "Components!A8: group: got 'x', must be 0 (skin), 1, 2, ... (webs)"),
        (1, 0, -1, "Components!A8: group: got '-1'"),
        (1, 2, 9, "Components!C8: material: got '9', known are 1, 2, 3"),
        (1, 3, "[0, 90]", "Components!D8: angle: got '[0, 90]', must be one figure"),
        (1, 4, "b", "Components!E8: extents: got 'b', must be two, such as b,c"),
        (1, 4, "b,e", "Components!E8: extents: got 'e', known here are le, a, b, c, d, te"),
        (1, 5, "b,b", "Components!F8: extents: got 'b,b', must be two"),
        (3, 5, None, "Components!E10: extents: none on either side"),
        (1, 6, "[0, 0.5, 1.2]", "Components!G8: control points: got '[0, 0.5, 1.2]'"),
        (1, 6, "[0, 0.5]", "Components!H8: control points: 3 plies at 2 spans"),
        (
            1,
            6,
            "[0, 0.5, 0.5]",
            "Components!G8: control points: got '[0, 0.5, 0.5]', must increase",
        ),
        (1, 7, "[40, -1, 0]", "Components!H8: control points: got '[40, -1, 0]', must be at least"),
        (1, 7, "[4, many, 0]", "Components!H8: control points: got '[4, many, 0]'"),
        (1, 7, "", "Components!H8: control points: got ''"),
        (
            1,
            8,
            "nearest",
            "Components!I8: layers: got 'nearest', allowed are pchip, linear, spline",
        ),
        (6, 4, "b+100", "Components!E13: foot: got 'b+100', known here are"),
        (6, 4, None, "Components!E13: foot: got ''"),
        (6, 5, "1.5b-c", "Components!F13: foot: got '1.5b-c', the share must be 0 to 1"),
        (6, 5, "0.5b-z", "Components!F13: extents: got 'z', known here"),
    ],
)
def test_what_cannot_be_held_is_left_out_and_said(row, column, value, said):
    parts = [[*part] for part in PARTS]
    parts[row][column] = value
    structure, findings = read(parts)
    told = [one for one in findings if one.endswith(f"{parts[row][1]} is left out")]
    assert len(told) == 1
    assert told[0].startswith(said)
    assert len(structure.layers) == 10 - (2 if row == 1 else 1)
    assert len(structure.webs) == (1 if row == 6 else 2)


def test_components_of_a_web_must_agree():
    structure, said = read([*PARTS, [1, "core", 3, 0, "c", "b", "[0.1, 0.9]", "[1, 1]", "pchip"]])
    assert [web.name for web in structure.webs] == ["web 2"]
    told = "foot: got b and c, must be the same in a group"
    assert f"Components!E13: {told}; wall is left out" in said
    assert f"Components!E15: {told}; core is left out" in said


def test_an_angle_on_a_web_is_said():
    parts = [[*part] for part in PARTS]
    parts[6][3] = 45
    structure, said = read(parts)
    assert structure.layers[-2].angle is None
    assert "Components!D13: wall lies on a web, where NuMAD has no angle; taken as 0" in said


@pytest.mark.parametrize(
    ("widths", "said"),
    [
        (above(cap="[600, 500, 400]"), "Components!C2: spar cap width: got '[600, 500, 400]'"),
        (above(leading=None), "Components!C3: LE band width: got nothing, must be one figure"),
        (above(trailing=-1), "Components!C4: TE band width: got -1.0"),
        (above(offset="x"), "Components!C5: spar cap offset: got 'x', must be one or two figures"),
    ],
)
def test_widths_that_are_none_leave_it_all_out(widths, said):
    structure, findings = read(PARTS, widths=widths)
    assert structure is None
    assert len(findings) == 1
    assert findings[0].startswith(said)
    assert findings[0].endswith("; the structure is left out")


def test_two_widths_are_those_of_the_sides():
    structure, _ = read(PARTS, widths=above(cap="[400, 800]", offset=None))
    high, low = (layer.start.base.width.values[0] for layer in structure.layers[1:3])
    assert (high, low) == (0.2, 0.4)


@pytest.mark.parametrize(
    ("column", "value", "said"),
    [
        (2, "anisotropic", "type: got 'anisotropic', allowed are isotropic and orthotropic"),
        (3, None, "thickness is empty, must be given"),
        (4, "stiff", "Ex: got 'stiff', allowed is above 0"),
        (13, 0, "density: got '0.0', allowed is above 0"),
        (0, 1, "got 1, must be a whole number that stands once"),
    ],
)
def test_a_material_that_is_none_leaves_out_what_is_made_of_it(column, value, said):
    materials = [[*row] for row in MATERIALS]
    materials[1][column] = value
    structure, findings = read(PARTS, materials)
    assert f"Materials!A5: {said}" in "\n".join(findings)
    gone = {one[: -len(" is left out")].rpartition("; ")[2] for one in findings if "!C" in one}
    assert gone == {"cap", "edge", "wall"}
    assert {layer.material for layer in structure.layers} == {"gel", "foam"}


def test_materials_without_a_number_count_by_their_rows():
    materials = [[None, *row[1:]] for row in MATERIALS]
    structure, said = read(PARTS, materials)
    assert structure == read(PARTS)[0]
    assert "Materials!A5: got no number; counted by its row, 2, as NuMAD does" in said


def test_places_between_others_know_where_they_end():
    arc = Arc(bg.Distribution([0.2, 0.8], [0.1, 0.1]))
    wide = Shifted(arc, bg.Distribution([0.3, 0.9], [1.0, 1.0]))
    other = Arc(bg.Distribution([0.0, 0.7], [0.3, 0.3]))
    for place in (Limited(wide, arc, other), Between(wide, other, 0.5)):
        assert extent_of(place) == (0.2, 0.7)
        assert set(knots(place)) == {0.2, 0.7, 0.3, 0.9}
        assert not around(place, other)
    with pytest.raises(DefinitionError, match="edge: side"):
        EdgeMiddle("lower")


def test_materials_of_one_name_get_one_each():
    materials = [[i, "gel", *MATERIALS[i - 1][2:]] for i in (1, 2, 3)]
    structure, _ = read(PARTS, materials)
    assert [one.name for one in structure.materials] == ["gel", "gel 2", "gel 3"]
