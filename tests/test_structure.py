"""What lies inside the skin, as windIO 1 and 2 give it: read into one, never guessed."""

from copy import deepcopy

import numpy as np
import pytest
from numpy.testing import assert_allclose

from bladegen.definition.blade_definition import Distribution
from bladegen.definition.structure.positions import LEADING_EDGE, Arc, PlaneCut, Shifted, base_of
from bladegen.definition.structure.structure import Layer, Material, Structure, Web
from bladegen.errors import DefinitionError
from bladegen.formats.common.document import Node, Notes
from bladegen.formats.windio.structure import reading1, reading2
from strategies import STEADY

DELETE = object()
GRID = [0.0, 0.5, 1.0]
FOAM = {"name": "foam", "rho": 130, "E": 1.4e8, "nu": 0.3, "orth": 0, "ply_t": 0.001}
GLASS = {"name": "glass", "rho": 1940.0, "E": [4e10, 1e10, 1e10], "Xt": [1e9, 1e8, 1e8], "orth": 1}


def over(*values):
    return {"grid": GRID[: len(values)] if len(values) == 3 else [0.0, 1.0], "values": [*values]}


def layer(name, **more):
    return {"name": name, "material": "foam", "thickness": over(0.01, 0.02), **more}


def anchored(name, start, end, **more):
    ends = zip(("start_nd_arc", "end_nd_arc"), (start, end), strict=True)
    refs = {
        key: {"anchor": dict(zip(("name", "handle"), one.split("."), strict=True))}
        for key, one in ends
    }
    return layer(name, **refs, **more)


def read(version, structure, materials=(FOAM, GLASS)):
    """The structure, and what is said of it."""
    key = {1: "internal_structure_2d_fem", 2: "structure"}[version]
    notes = Notes()
    document = {"components": {"blade": {key: structure}}, "materials": list(materials)}
    found = {1: reading1, 2: reading2}[version].read(Node(document, "", notes))
    assert not notes.problems  # nothing inside the skin refuses a file
    return found, [str(finding) for finding in notes.findings]


CUT = {"side": "both", "defines": ["start_nd_arc", "end_nd_arc"], "offset": over(-0.3, 0.4)}
PLANE = {"anchor_curve": "reference_axis", "anchors_nd_grid": [0.0, 1.0], "rotation": 10.0}
CAP = {"side": "suction", "defines": ["midpoint_nd_arc"], "offset": over(0.1, 0.1)}
BOTH = ["start_nd_arc", "end_nd_arc"]
ANCHORS = [
    {"name": "TE", "start_nd_arc": over(0.0, 0.0), "end_nd_arc": over(1.0, 1.0)},
    {"name": "LE", "start_nd_arc": over(0.5, 0.49)},
    {
        "name": "web",
        "plane_intersection": {**CUT, "plane_type1": PLANE},
        "start_nd_arc": over(0.2, 0.3),
    },
    {
        "name": "cap",
        "plane_intersection": {**CAP, "plane_type1": {**PLANE, "rotation": 0.0}},
        "width": {**over(1.0, 0.2), "defines": BOTH},
        "start_nd_arc": over(0.2, 0.2),
        "end_nd_arc": over(0.3, 0.4),
    },
    {
        "name": "nose",
        "midpoint_nd_arc": {"anchor": {"name": "LE", "handle": "start_nd_arc"}},
        "width": {**over(0.6, 0.1), "defines": BOTH},
    },
    {
        "name": "tail",
        "start_nd_arc": {"anchor": {"name": "TE", "handle": "start_nd_arc"}},
        "width": {**over(0.3, 0.05), "defines": ["end_nd_arc"]},
    },
    {
        "name": "edge",
        "midpoint_nd_arc": {"anchor": {"name": "TE", "handle": "end_nd_arc"}},
        "width": {**over(0.8, 0.1), "defines": BOTH},
    },
    {
        "name": "behind",
        "offset_arc": {
            "defines": "start_nd_arc",
            "anchor": {"name": "cap", "handle": "end_nd_arc"},
            **over(0.1, 0.1),
        },
    },
]
WEB = {
    "name": "main",
    "start_nd_arc": {"anchor": {"name": "web", "handle": "start_nd_arc"}},
    "end_nd_arc": {"anchor": {"name": "web", "handle": "end_nd_arc"}},
    "anchors": [{"name": "all", "start_nd_arc": over(0.0, 0.0), "end_nd_arc": over(0.5, 0.5)}],
    "start_nd_grid": 0.1,
    "end_nd_grid": 0.9,
}


TURNED = {"rotation": {"fixed": "twist", **over(-0.2, 0.0)}}
WAYS = {
    2: {
        "anchors": ANCHORS,
        "webs": [WEB],
        "layers": [
            anchored("skin", "TE.start_nd_arc", "TE.end_nd_arc", fiber_orientation=over(45.0, 0.0)),
            anchored("cap", "cap.start_nd_arc", "cap.end_nd_arc", start_nd_grid=0.2),
            anchored("nose", "nose.start_nd_arc", "nose.end_nd_arc"),
            anchored("core", "tail.end_nd_arc", "cap.start_nd_arc"),
            anchored("edge", "edge.start_nd_arc", "edge.end_nd_arc"),
            anchored("next", "behind.start_nd_arc", "LE.start_nd_arc"),
            anchored("wall", "all.start_nd_arc", "all.end_nd_arc", web="main"),
            layer("other side", web="main", material="glass"),
        ],
    },
    1: {
        "webs": [
            {"name": "main", "offset_y_pa": over(-0.3, 0.4), "rotation": over(-0.2, 0.0)},
            {"name": "arcs", "start_nd_arc": over(0.2, 0.2), "end_nd_arc": over(0.7, 0.7)},
        ],
        "layers": [
            layer("core", start_nd_arc={"fixed": "tail"}, end_nd_arc={"fixed": "cap"}),
            layer("skin", start_nd_arc=over(0.0, 0.1), end_nd_arc=over(1.0, 0.9)),
            layer("cap", offset_y_pa=over(0, 0), side="pressure", width=over(1.0, 0.2), **TURNED),
            layer("nose", midpoint_nd_arc={"fixed": "LE", **over(0, 0)}, width=over(0.6, 0.1)),
            layer(
                "tail",
                start_nd_arc={"fixed": "TE"},
                width=over(0.3, 0.1),
                end_nd_arc=over(0.1, 0.1),
            ),
            layer("edge", midpoint_nd_arc={"fixed": "TE", **over(1, 1)}, width=over(0.8, 0.1)),
            layer("on", start_nd_arc={"fixed": "edge"}, end_nd_arc={"fixed": "LE"}),
            layer("round", start_nd_arc=over(0.9, 0.95), end_nd_arc=over(0.1, 0.05)),
            layer("end", end_nd_arc={"fixed": "TE"}, width=over(0.3, 0.1)),
            layer("wall", web="main", fiber_orientation=over(0.7, 0.7)),
        ],
    },
}


def assert_around(edge):
    """A strip about the trailing edge starts on the pressure side and ends on the suction side."""
    assert edge.around
    assert (edge.start.times, edge.end.times) == (-0.5, 0.5)
    assert_allclose(base_of(edge.start).fraction.values, 1.0)
    assert_allclose(base_of(edge.end).fraction.values, 0.0)


def test_every_way_of_windio2():
    structure, said = read(2, WAYS[2])
    assert said == []
    skin, cap, nose, core, edge, behind, wall, other = structure.layers
    assert_allclose(skin.angle.values, [np.pi / 4, 0.0])
    cut = base_of(cap.start)
    assert isinstance(cut, PlaneCut)
    assert cut is base_of(cap.end)
    assert (cut.side, cut.frame, cut.rotation, cut.through) == ("suction", "root", None, (0.0, 1.0))
    assert (cap.start.times, cap.end.times, cap.extent) == (-0.5, 0.5, (0.2, 1.0))
    assert_allclose(cap.stated[1].values, [0.3, 0.4])
    assert base_of(nose.start) is LEADING_EDGE
    assert core.end is cap.start
    assert core.start.times == 1.0
    assert_around(edge)
    assert behind.start.base is cap.end
    assert behind.end is LEADING_EDGE
    assert_allclose(wall.end.fraction.values, 0.5)
    assert_allclose(other.end.fraction.values, 1.0)
    (web,) = structure.webs
    assert (web.start.side, web.end.side, web.extent) == ("suction", "pressure", (0.1, 0.9))
    assert_allclose(web.start.rotation(0.5), np.radians(10.0))
    assert [m.name for m in structure.materials] == ["foam", "glass"]
    foam, glass = structure.materials
    assert (foam.density, foam.E, foam.ply_thickness) == (130.0, (1.4e8,) * 3, 0.001)
    assert (glass.tensile, glass.orthotropic, glass.G) == ((1e9, 1e8, 1e8), True, None)


def test_every_way_of_windio1():
    structure, said = read(1, WAYS[1])
    assert said == []
    core, skin, cap, nose, tail, edge, on, turned, end, wall = structure.layers
    assert_around(edge)
    assert on.start is edge.end
    assert [one.name for one in structure.layers if one.around] == ["edge", "round"]
    assert_allclose(turned.end.fraction.values, [0.1, 0.05])
    assert core.end is cap.start
    assert core.start is tail.end
    assert isinstance(skin.start, Arc)
    assert (base_of(cap.start).frame, base_of(cap.start).rotation) == ("root", None)
    assert base_of(nose.end) is LEADING_EDGE
    assert_allclose(base_of(tail.end).fraction.values, 0.0)
    assert_allclose(tail.stated[1].values, 0.1)
    assert_allclose(base_of(end.start).fraction.values, 1.0)
    assert end.start.times == -1.0
    assert_allclose(wall.angle.values, 0.7)
    assert structure.webs[0].start.frame == "chord"


A = "components.blade.structure."
B = "components.blade.internal_structure_2d_fem."
LOOP = [
    {"name": n, "start_nd_arc": {"anchor": {"name": m, "handle": "start_nd_arc"}}}
    for n, m in ("ab", "ba")
]
NO_PLANE = {"name": "x", "plane_intersection": {**CAP, "plane_type2": PLANE, "defines": BOTH}}
NO_CURVE = {**CAP, "defines": BOTH, "plane_type1": {**PLANE, "anchor_curve": "quarter chord"}}
ALONE = {"name": "x", "width": {**over(1, 1), "defines": BOTH}}
SHARE = {"name": "x", "offset_nd_arc": {"defines": "start_nd_arc", **over(0.1, 0.1)}}
X = [anchored("one", "x.start_nd_arc", "TE.end_nd_arc")]


@pytest.mark.parametrize(
    ("version", "structure", "place", "said"),
    [
        (
            2,
            {"layers": X},
            A + "layers[0].start_nd_arc.anchor.name",
            "got 'x', must be the name of",
        ),
        (2, {"layers": X, "anchors": [NO_PLANE]}, "plane_intersection", "plane_type1 is missing"),
        (
            2,
            {"layers": X, "anchors": [{"name": "x", "plane_intersection": NO_CURVE}]},
            "anchor_curve",
            "'quarter chord', allowed is",
        ),
        (
            2,
            {"layers": X, "anchors": [ALONE]},
            A + "anchors[0].width",
            "must have a midpoint or the other",
        ),
        (
            2,
            {"layers": X, "anchors": [SHARE]},
            "offset_nd_arc",
            "is not known here, allowed is offset_arc",
        ),
        (2, {"layers": X, "anchors": [{"name": "x"}]}, A + "anchors[0].start_nd_arc", "is missing"),
        (
            2,
            {"layers": [anchored("one", "a.start_nd_arc", "a.start_nd_arc")], "anchors": LOOP},
            A,
            "rests on itself",
        ),
        (
            2,
            {"layers": [anchored("one", "TE.left", "TE.end_nd_arc")]},
            "anchor.handle",
            "got 'left', allowed are",
        ),
        (
            2,
            {
                "layers": [
                    anchored("one", "TE.start_nd_arc", "TE.end_nd_arc", thickness=over(1, -1))
                ]
            },
            "thickness.values[1]",
            "got -1, allowed is 0 to 10 m",
        ),
        (
            2,
            {"layers": [anchored("one", "TE.start_nd_arc", "TE.end_nd_arc", material="tin")]},
            A + "layers[0]",
            "material tin is not known",
        ),
        (2, {"layers": [layer("one", web="none")]}, A + "layers[0]", "web none is not known"),
        (2, {"layers": {"name": "one"}}, A + "layers", "must be a list; left out"),
        (
            1,
            {"layers": [layer("one", start_nd_arc={"fixed": "x"}, end_nd_arc=over(1, 1))]},
            "start_nd_arc.fixed",
            "'x' is not known here, must be TE, LE or a layer",
        ),
        (
            1,
            {"layers": [layer("one", midpoint_nd_arc={"fixed": "x"}, width=over(1, 1))]},
            "midpoint_nd_arc.fixed",
            "'x' is not known here, must be LE or TE",
        ),
        (
            1,
            {"layers": [layer("one", start_nd_arc={"fixed": "one"}, end_nd_arc=over(1, 1))]},
            "start_nd_arc.fixed",
            "rests on itself",
        ),
        (
            1,
            {
                "layers": [
                    layer(
                        "one",
                        offset_y_pa=over(0, 0),
                        rotation=over(0, 0),
                        side="left",
                        width=over(1, 1),
                    )
                ]
            },
            "side",
            "got 'left', allowed are",
        ),
        (
            1,
            {
                "layers": [
                    layer(
                        "one",
                        offset_y_pa=over(0, 0),
                        rotation={"fixed": "x"},
                        side="suction",
                        width=over(1, 1),
                    )
                ]
            },
            "rotation.fixed",
            "got 'x', allowed is 'twist'",
        ),
        (
            1,
            {"layers": [layer("one", offset_y_pa=over(0, 0), rotation=over(0, 0), side="suction")]},
            B + "layers[0]",
            "without a width",
        ),
        (1, {"layers": [layer("one")]}, B + "layers[0].start_nd_arc", "is missing"),
        (
            1,
            {"webs": [{"name": "w", "offset_y_pa": over(0, 0)}]},
            B + "webs[0].rotation",
            "is missing",
        ),
    ],
)
def test_an_unknown_way_is_a_finding_with_its_place(version, structure, place, said):
    if version == 2:
        structure = {**structure, "anchors": [*ANCHORS, *structure.get("anchors", ())]}
        structure["anchors"].sort(key=lambda one: one["name"] not in "xab")
    found, findings = read(version, structure)
    assert found is None
    assert len(findings) == 1
    assert place in findings[0]
    assert said in findings[0]
    assert "left out" in findings[0]


def leaves(value, path=()):
    """The paths of all parts of a document, but for the single numbers of lists."""
    yield path
    parts = value if isinstance(value, dict) else {}
    if isinstance(value, list) and value and not isinstance(value[0], float | int):
        parts = dict(enumerate(value))
    for key, part in parts.items():
        yield from leaves(part, (*path, key))


@pytest.mark.parametrize("version", WAYS)
@pytest.mark.parametrize("junk", [None, "x", -1e300, {}, [{}], DELETE])
def test_nothing_in_a_structure_refuses_a_file(version, junk):
    whole = WAYS[version]
    for path in list(leaves(whole))[:: 4 if STEADY else 1]:
        document = deepcopy(whole)
        holder = {"all": document}
        place, last = holder, "all"
        for key in path:
            place, last = place[last], key
        if junk is DELETE:
            del place[last]
        else:
            place[last] = junk
        read(version, holder.get("all"))


def test_a_long_chain_of_places_ends():
    layers = [
        layer(f"{i}", start_nd_arc={"fixed": f"{i + 1}"}, end_nd_arc=over(1, 1)) for i in range(900)
    ]
    found, said = read(1, {"layers": layers})
    assert found is None
    assert "rests on itself" in " ".join(said)


def test_what_rests_on_an_unknown_place_is_left_out_and_the_rest_kept():
    layers = [
        layer("cap", start_nd_arc={"fixed": "x"}, end_nd_arc=over(1, 1)),
        layer("core", start_nd_arc=over(0, 0), end_nd_arc={"fixed": "cap"}),
        layer("skin", start_nd_arc=over(0, 0), end_nd_arc=over(1, 1)),
        layer("skin", start_nd_arc=over(0, 0), end_nd_arc=over(1, 1)),
    ]
    found, said = read(1, {"layers": layers})
    assert [one.name for one in found.layers] == ["skin"]
    assert [text.split(": ")[1] for text in said[1:]] == [
        "where cap lies is not known; core is left out",
        "skin stands twice; this one is left out",
    ]


def test_a_thickness_below_zero_by_rounding_is_zero():
    ends = {"start_nd_arc": over(0, 0), "end_nd_arc": over(1, 1)}
    found, said = read(1, {"layers": [layer("skin", **ends) | {"thickness": over(0.1, -1e-20)}]})
    assert said == []
    assert found.layers[0].thickness.values[-1] == 0.0


def test_a_material_without_density_leaves_its_layers_out():
    ends = {"start_nd_arc": over(0, 0), "end_nd_arc": over(1, 1)}
    found, said = read(1, {"layers": [layer("skin", **ends)]}, [{"name": "foam", "E": 1.0}])
    assert found is None
    assert "materials[0].rho: is missing, must be given; foam is left out" in said


def test_values_are_refused_in_one_line():
    foam, thin = Material("foam", 100.0), Distribution.constant(0.01)
    arc = Arc(Distribution.constant(0.5))
    skin = Layer("skin", "foam", thin, arc, arc)
    with pytest.raises(DefinitionError, match="material tin is not among foam"):
        Structure((foam,), (), (Layer("skin", "tin", thin, arc, arc),))
    with pytest.raises(DefinitionError, match="layers: skin stands 2 times"):
        Structure((foam,), (), (skin, skin))
    on_web = Layer("wall", "foam", thin, arc, arc, web="main")
    with pytest.raises(DefinitionError, match="web main is not among rear"):
        Structure((foam,), (Web("rear", arc, arc),), (on_web,))
    with pytest.raises(DefinitionError, match="side: got 'left', allowed are suction, pressure"):
        PlaneCut("left", thin)
    with pytest.raises(DefinitionError, match=r"width: got 0.5, must be a bladegen\.Distribution"):
        Shifted(arc, 0.5)
    assert repr(Structure((foam,), (), (skin,))) == "<Structure of 0 webs, 1 layers, 1 materials>"
