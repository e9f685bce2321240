"""What lies inside the skin goes along: into windIO 1 and 2 and back, of variants too."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_structure import WAYS, read

import bladegen as bg
from bladegen.definition.rotor import Rotor
from bladegen.definition.structure.positions import LEADING_EDGE, Arc, PlaneCut, Shifted
from bladegen.formats.common.document import Node, Notes
from bladegen.formats.windio import turbine_facts, version1
from bladegen.formats.windio.structure import reading1, reading2, writing1, writing2
from bladegen.formats.windio.structure.parts import whole

VERSIONS = {
    1: (writing1.document, reading1.read, "internal_structure_2d_fem"),
    2: (writing2.document, reading2.read, "structure"),
}
TAIL = "structure: edge: its middle is the trailing edge; WISDEM 4 takes middles at LE alone"
ETA = np.linspace(0.0, 1.0, 31)
constant = bg.Distribution.constant


@pytest.fixture(scope="module")
def plain():
    return bg.read("iea15mw")


def there_and_back(definition, version):
    """The structure that a version keeps, its document, and what is said of it."""
    write, take, key = VERSIONS[version]
    said, notes = [], Notes()
    inside, materials = write(definition, lambda *words: said.append(": ".join(words)))
    document = {"components": {"blade": {key: inside}}, "materials": materials}
    again = take(Node(document, "", notes))
    assert not notes.problems
    assert not notes.findings
    return again, inside, said


def rules(structure):
    """A structure without the fractions that stand besides its rules."""
    bare = {"stated": (None, None)}
    return replace(
        structure,
        webs=tuple(replace(web, **bare) for web in structure.webs),
        layers=tuple(replace(layer, **bare) for layer in structure.layers),
    )


def laid(definition, structure):
    return bg.Blade.from_definition(
        replace(definition, structure=structure), landmarks=201
    ).layup.at(ETA)


@pytest.mark.parametrize("version", WAYS)
def test_every_rule_comes_back_as_it_was(plain, version):
    structure, _ = read(version, WAYS[version])
    structure = replace(structure, webs=tuple(_straight(web) for web in structure.webs))
    again, _, said = there_and_back(replace(plain, structure=structure), version)
    assert said == ([TAIL] if version == 2 else [])
    assert rules(again) == rules(structure)


def _straight(web):
    """A web whose planes have a form in either version: the root's, turned by nothing over span."""
    if isinstance(web.start, Arc):
        return web
    one, other = (
        PlaneCut(side, web.start.offset, through=web.start.through)
        for side in ("suction", "pressure")
    )
    return replace(web, start=one, end=other)


@pytest.mark.parametrize("version", WAYS)
def test_fractions_besides_the_rules_are_those_of_the_blade(plain, version):
    structure, _ = read(2, WAYS[2])
    definition = replace(plain, structure=structure)
    again, _, _ = there_and_back(definition, version)
    own = laid(definition, structure)
    for i, layer in enumerate(again.layers):
        for end, stated in enumerate(layer.stated):
            if stated is not None:
                grid, inside = stated.grid, np.isfinite(own.arcs[i, :, end])
                held = inside & (grid[0] <= ETA) & (grid[-1] >= ETA)
                turn = layer.around and end == 0  # begins below 0
                fractions = np.clip(own.arcs[i, held, end] + turn, 0.0, 1.0)
                assert_allclose(stated(ETA[held]), fractions, atol=5e-3, err_msg=layer.name)


def test_one_version_says_the_same_as_the_other(plain):
    structure, _ = read(1, WAYS[1])
    structure = replace(structure, webs=tuple(_straight(web) for web in structure.webs))
    two, _, said = there_and_back(replace(plain, structure=structure), 2)
    assert said == [
        "structure: arcs: stands on no plane; WISDEM 4 takes webs on planes alone, and stops at "
        "this one",
        TAIL,
    ]
    one, _, said = there_and_back(replace(plain, structure=two), 1)
    assert said == []
    first, second, third = (laid(plain, known) for known in (structure, two, one))
    for other in (second, third):
        assert_allclose(other.arcs, first.arcs, atol=1e-9)
        assert_allclose(other.mass_per_length, first.mass_per_length, rtol=1e-9)


def test_a_rule_without_a_form_is_written_as_fractions_and_said(plain):
    twisting = bg.Distribution([0.0, 1.0], [0.0, 0.2])
    cut = PlaneCut("suction", constant(0.1), twisting, "chord")
    ends = Shifted(cut, constant(0.4), -0.5), Shifted(cut, constant(0.4), 0.5)
    foam = bg.Material("foam", 100.0)
    structure = bg.Structure((foam,), (), (bg.Layer("cap", "foam", constant(0.1), *ends),))
    again, inside, said = there_and_back(replace(plain, structure=structure), 2)
    assert said == [
        f"structure: cap.{key}: has no rule in windIO 2; written as fractions of the arc on this "
        "blade"
        for key in ("start_nd_arc", "end_nd_arc")
    ]
    assert "width" not in inside["anchors"][-1]
    before, after = laid(plain, structure), laid(plain, again)
    assert_allclose(after.arcs, before.arcs, atol=3e-3)
    assert there_and_back(replace(plain, structure=structure), 1)[2] == []


@pytest.mark.parametrize("version", WAYS)
def test_a_layer_around_the_trailing_edge_comes_back(plain, version):
    wide = bg.Distribution([0.0, 1.0], [0.8, 0.2])
    strip = Shifted(whole(1.0), wide, -0.5), Shifted(whole(0.0), wide, 0.5)
    arcs = Arc(constant(0.9)), Arc(constant(0.05))
    foam = bg.Material("foam", 100.0)
    layers = [
        bg.Layer(name, "foam", constant(0.1), *ends)
        for name, ends in (("edge", strip), ("arcs", arcs), ("on", (strip[1], LEADING_EDGE)))
    ]
    structure = bg.Structure((foam,), (), tuple(layers))
    again, _, said = there_and_back(replace(plain, structure=structure), version)
    assert [one.around for one in again.layers] == [True, True, False]
    assert rules(again) == rules(structure)
    assert said == ([TAIL] if version == 2 else [])
    edge = again.layers[0]
    assert 0.0 < edge.stated[1].values.max() < 0.5 < edge.stated[0].values.min() < 1.0


def test_a_variant_s_file_holds_the_rules_and_their_places_on_it(plain, tmp_path):
    structure, _ = read(2, WAYS[2])
    blade = bg.Blade.from_definition(replace(plain, structure=structure), landmarks=201)
    variant = blade.perturbed(chord_scale=1.1)
    bg.write(variant, tmp_path / "variant.yaml", polars="keep")
    again = bg.read(tmp_path / "variant.yaml")
    assert rules(again.structure) == rules(structure)
    own, back = variant.layup, bg.Blade.from_definition(again, landmarks=201).layup
    assert_allclose(back.at(ETA).arcs, own.at(ETA).arcs, atol=1e-3)
    assert_allclose(back.mass, own.mass, rtol=1e-4)
    cap = again.structure.layers[1].stated[0]
    assert_allclose(cap(0.5), own.at(0.5).arcs[1, 0], atol=5e-3)


def test_a_web_on_no_plane_is_said_for_wisdem(plain):
    web = bg.Web("web", Arc(constant(0.3)), Arc(constant(0.7)))
    foam = bg.Material("foam", 100.0)
    wall = bg.Layer(
        "wall", "foam", constant(0.1), Arc(constant(0.0)), Arc(constant(1.0)), web="web"
    )
    _, _, said = there_and_back(replace(plain, structure=bg.Structure((foam,), (web,), (wall,))), 2)
    assert any("web: stands on no plane; WISDEM 4" in one for one in said)


def test_what_a_material_costs_goes_along(plain):
    ends = {"start_nd_arc": {"grid": [0, 1], "values": [0, 0]}}
    ends["end_nd_arc"] = {"grid": [0, 1], "values": [1, 1]}
    skin = {"name": "skin", "material": "foam", "thickness": {"grid": [0, 1], "values": [0.01] * 2}}
    foam = {"name": "foam", "rho": 100.0, "orth": 0, "E": 1e8, "nu": 0.3, "ply_t": 0.001}
    foam |= {"unit_cost": 7.2, "waste": 0.25, "source": "a report", "alpha": [1e-5, 1e-5, 2e-5]}
    structure, _ = read(1, {"layers": [skin | ends]}, [foam])
    for write in (writing1.document, writing2.document):
        _, materials = write(replace(plain, structure=structure), lambda *_: None)
        assert materials == [foam]


def test_orthotropic_materials_have_three_figures_even_if_they_are_equal():
    """IEA 10 MW's biax, whose Poisson's ratio windIO 2 allows of no isotropic material."""
    plain = bg.read("iea15mw")
    biax = bg.Material(
        "biax", 1845.0, (1.39e10,) * 3, (1.15e10,) * 3, (0.533,) * 3, orthotropic=True
    )
    layer = plain.structure.layers[0]
    structure = bg.Structure((biax,), (), (replace(layer, material="biax"),))
    for write in (writing1.document, writing2.document):
        _, (made,) = write(replace(plain, structure=structure), lambda *_: None)
        assert (made["orth"], made["nu"]) == (1, [0.533] * 3)
        assert made["E"] == [1.39e10] * 3


@pytest.mark.parametrize(
    ("layer", "said"),
    [
        (
            {"material": "glas_uni"},
            "material glas_uni is not known; x is left out; did you mean glass_uni",
        ),
        ({"web": "Web-0"}, "web Web-0 is not known; x is left out; did you mean web0"),
    ],
)
def test_a_name_that_is_nearly_known_is_suggested(layer, said):
    one = {
        "name": "x",
        "material": "glass_uni",
        "thickness": {"grid": [0, 1], "values": [0.01] * 2},
    }
    ends = {"start_nd_arc": {"grid": [0, 1], "values": [0, 0]}}
    ends["end_nd_arc"] = {"grid": [0, 1], "values": [1, 1]}
    webs = [{"name": "web0", **ends}]
    glass = {"name": "glass_uni", "rho": 1900.0, "orth": 0}
    _, findings = read(1, {"webs": webs, "layers": [one | ends | layer]}, [glass])
    assert any(said in str(finding) for finding in findings)


def test_a_format_without_a_place_for_it_says_so(plain, tmp_path):
    structure, _ = read(1, WAYS[1])
    said = bg.write(replace(plain, structure=structure), tmp_path / "blade.csv")
    assert any(str(one).startswith("structure: has no place in") for one in said)


def test_the_converter_of_windio_makes_the_same_of_what_is_written(tmp_path):
    """An oracle of windIO 1 and of the reading of windIO 2: the package's own way between them."""
    converters = pytest.importorskip("windIO.converters.windIO2windIO")
    home = Path(pytest.importorskip("windIO.examples.turbine").__file__).parent
    definition = bg.read(home / "IEA-15-240-RWT.yaml")
    document = version1.document(definition, lambda *_: None)
    converter = converters.v1p0_to_v2p0("", str(tmp_path / "two.yaml"))
    document = converter.convert_blade_reference_axis(document)
    document = converter.convert_blade_structure(document)
    notes = Notes()
    again = reading2.read(Node(_plain(document), "", notes))
    assert not notes.findings
    first, second = (
        bg.Blade.from_definition(replace(definition, structure=one), landmarks=201).layup
        for one in (definition.structure, again)
    )
    assert_allclose(second.at(ETA).arcs, first.at(ETA).arcs, atol=1e-9)
    assert_allclose(second.mass, first.mass, rtol=1e-6)


def _plain(value):
    """Numbers of NumPy and its lists as those of a document."""
    if isinstance(value, dict):
        return {key: _plain(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(part) for part in value]
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value


def test_facts_of_the_turbine_go_along_in_windio_2_and_in_part_in_windio_1(plain, tmp_path):
    assert dict(plain.rotor.facts)["assembly.rated_power"] == 15e6
    bg.write(plain, tmp_path / "two.yaml")
    assert bg.read(tmp_path / "two.yaml").rotor.facts == plain.rotor.facts
    said = bg.write(plain, tmp_path / "one.yaml", format="windio1")
    assert any(finding.where == "turbine" for finding in said)
    kept = bg.read(tmp_path / "one.yaml").rotor.facts
    assert kept == tuple(fact for fact in plain.rotor.facts if fact[0].startswith("assembly"))


# of IEA 22 MW: windIO 1 as its repository has it, and what windIO 2 of the same turbine says
OLDER = {
    "assembly": {"rotor_diameter": 284.0},
    "control": {
        "supervisory": {"maxTS": 105.0},
        "torque": {"tsr": 9.153211158238001, "VS_maxspd": 0.7500028861670033},
    },
}


def test_windio_1_says_how_the_rotor_turns_in_other_words():
    found = turbine_facts.read_older(Node(OLDER, "", Notes()))
    rotor = Rotor(facts=found)
    assert_allclose(rotor.design_ratio, 9.15, rtol=1e-3)
    assert_allclose(rotor.speed * 30.0 / np.pi, 7.061131867192266, rtol=1e-5)
    slow = OLDER["control"] | {"torque": {"VS_maxspd": 0.5}}
    turned = turbine_facts.read_older(Node(OLDER | {"control": slow}, "", Notes()))
    assert_allclose(Rotor(facts=turned).speed, 0.5)
    assert Rotor(facts=turned).design_ratio is None


def test_what_wisdem_asks_of_a_rotor_is_taken_from_windio_1_in_windio_2s_units():
    """Units as of windIO's own converter: rad to deg, rad/s to 1/min."""
    control = {
        "supervisory": {"Vin": 4.0, "Vout": 25.0},
        "pitch": {"max_pitch": 1.57, "max_pitch_rate": 0.0349, "min_pitch": 0.0},
        "torque": {"max_torque_rate": 4500000.0, "VS_minspd": 0.0, "VS_maxspd": 2.0},
    }
    nacelle = {"drivetrain": {"overhang": 7.0, "distance_tt_hub": 3.0}}
    document = {"control": control, "components": {"nacelle": nacelle}}
    found = dict(turbine_facts.read_older(Node(document, "", Notes())))
    assert found["assembly.cut_in_wind_speed"] == 4.0
    assert found["control.min_rotor_speed"] == 0.0
    assert_allclose(found["control.max_rotor_speed"], 19.0986, rtol=1e-5)
    assert_allclose(found["control.max_pitch_limit"], 89.954, rtol=1e-5)
    assert_allclose(found["control.max_pitch_rate"], 2.0, rtol=1e-3)
    assert found["control.min_pitch_limit"] == 0.0
    assert found["components.drivetrain.outer_shape.overhang"] == 7.0
    names = [f"{path}.{name}" for path, names in turbine_facts.KEPT.items() for name in names]
    assert [*found] == [name for name in names if name in found]


@pytest.mark.parametrize("junk", [None, "fast", -1.0, 0, True, float("inf"), float("nan"), [9.0]])
def test_what_is_no_speed_in_windio_1_is_passed_over(junk):
    control = {"supervisory": {"maxTS": junk}, "torque": {"tsr": junk, "VS_maxspd": junk}}
    found = dict(turbine_facts.read_older(Node({"control": control}, "", Notes())))
    assert not {"control.rated_rotor_speed", "control.optimal_tsr"} & found.keys()
    assert turbine_facts.read_older(Node({"control": junk}, "", Notes())) == ()


@pytest.mark.parametrize("junk", [None, "x" * 101, [1.0], {"a": 1}, True])
def test_a_fact_that_is_no_number_or_short_text_is_passed_over(junk):
    root = {"assembly": {"rated_power": junk, "lifetime": 25.0}, "control": junk}
    assert turbine_facts.read(Node(root, "", Notes())) == (("assembly.lifetime", 25.0),)


def test_an_airfoil_of_unknown_thickness_is_measured_for_windio_2(tmp_path):
    """WISDEM stops at an airfoil without one; Cylinder2 of the NREL 5 MW has none."""
    first = bg.read("nrel5mw")
    said = bg.write(first, tmp_path / "two.yaml")
    assert any("Cylinder2: rthick" in finding.where for finding in said)
    stated = [s.airfoil.relative_thickness for s in bg.read(tmp_path / "two.yaml").stations]
    assert None not in stated


def test_what_bonds_layers_is_kept_of_the_materials(plain):
    structure = plain.structure
    assert {"resin", "adhesive"} <= structure.by_name.keys()
    ends = {"start_nd_arc": {"grid": [0, 1], "values": [0, 0]}}
    ends["end_nd_arc"] = {"grid": [0, 1], "values": [1, 1]}
    foam, glue = (
        {"name": "foam", "rho": 100.0},
        {"name": "Adhesive", "rho": 1100.0},
    )  # as BAR has it
    skin = {"name": "skin", "material": "foam", "thickness": {"grid": [0, 1], "values": [0.01] * 2}}
    named, _ = read(1, {"layers": [skin | ends]}, [foam, glue])
    assert named.by_name.keys() == {"foam", "Adhesive"}
    layup = bg.Blade.from_definition(plain, landmarks=201).layup
    assert set(layup.material_masses) == {layer.material for layer in structure.layers}
