"""What people hand to public functions: it works, or one line says what it must be."""

import warnings
from pathlib import Path

import numpy as np
import pytest

import bladegen as bg
from bladegen.blade import edges, planform
from bladegen.blade.changes.deformation import AffineChange
from bladegen.errors import BladegenError, ExportError, PerturbationError
from bladegen.exports.options import Options
from bladegen.shapes import affine, grassmann
from bladegen.support.arguments import (
    amount,
    function,
    numbers,
    one_of,
    path_of,
    shown,
    suggestion,
    whole,
)
from bladegen.surface import tips

DEFINITION = bg.read("iea15mw")
BLADE = bg.Blade.from_definition(DEFINITION)
SPACE = bg.ShapeSpace.bundled()
T = [0.02, -0.01, 0.01, 0.0]
ODD = (
    None,
    "x",
    "",
    -1,
    2.5,
    1j,
    True,
    float("nan"),
    [],
    ["a"],
    [1.0, [2.0]],
    {},
    object(),
    np.zeros((2, 3)),
    np.array(["a"]),
    np.array([None]),
    len,
    dict,
    Path("nowhere/at-all.yaml"),
    DEFINITION,
    SPACE,
)
POINTS = SPACE.decode(np.array([T, [0.0] * 4]))
LINE = bg.Distribution([0, 1], [1, 2])
AXIS = bg.ReferenceAxis(LINE, LINE, LINE)
FOIL = DEFINITION.stations[-1].airfoil
PARTS = {
    "name": "b",
    "stations": (bg.Station(0, FOIL), bg.Station(1, FOIL)),
    "chord": LINE,
    "twist": LINE,
    "axis": AXIS,
    "pitch_axis": LINE,
}
CALLS = {
    "read": bg.read,
    "read airfoils": lambda x: bg.read("iea15mw", airfoils=x),
    "from_definition": bg.Blade.from_definition,
    **{
        f"from_definition {name}": lambda x, n=name: bg.Blade.from_definition(DEFINITION, **{n: x})
        for name in (
            "landmarks",
            "path",
            "planes",
            "trailing_edge",
            "spacing",
            "fairing",
            "fair_planform",
        )
    },
    "perturbed space": BLADE.perturbed,
    "perturbed t": lambda x: BLADE.perturbed(SPACE, x),
    "perturbed both": lambda x: BLADE.perturbed(x, x),
    **{
        f"perturbed {name}": lambda x, n=name: BLADE.perturbed(**{n: x})
        for name in ("t", "thickness", "twist", "prebend_scale", "window", "name")
    },
    "profiles": BLADE.profiles,
    "profiles u": lambda x: BLADE.profiles(0.5, x),
    "sections": BLADE.sections,
    "stations": BLADE.stations,
    "chord": BLADE.chord,
    "twist": BLADE.twist,
    "axis": BLADE.axis,
    "relative_thickness": BLADE.relative_thickness,
    "export": lambda x: bg.export(x, "x.step"),
    "export path": lambda x: bg.export(BLADE, x),
    **{
        f"export {name}": lambda x, n=name: Options(**{n: x})
        for name in ("tolerance", "sections", "stations", "tip", "unit", "step_schema", "spacing")
    },
    "write": lambda x: bg.write(x, "x.yaml"),
    "write path": lambda x: bg.write(DEFINITION, x),
    "write format": lambda x: bg.write(DEFINITION, "x.step", format=x),
    "write_airfoil": lambda x: bg.write_airfoil(x, "x.dat"),
    "write_airfoil path": lambda x: bg.write_airfoil(FOIL, x),
    "write_airfoil layout": lambda x: bg.write_airfoil(FOIL, "x/y/z.dat", layout=x),
    "fit": bg.ShapeSpace.fit,
    "fit modes": lambda x: bg.ShapeSpace.fit(POINTS, modes=x),
    "load": bg.ShapeSpace.load,
    "save": SPACE.save,
    "encode": SPACE.encode,
    "decode": SPACE.decode,
    "tangent": SPACE.tangent,
    "carried": lambda x: SPACE.carried(x, POINTS),
    "carried points": lambda x: SPACE.carried([T, T], x),
    "outside": SPACE.outside,
    "sample": lambda x: SPACE.sample(x, np.random.default_rng(1)),
    "sample rng": lambda x: SPACE.sample(2, x),
    "Window": lambda x: bg.Window(x, 0.5),
    "Coordinates": lambda x: bg.Coordinates(x, [T]),
    "Coordinates values": lambda x: bg.Coordinates([0.5], x),
    "Airfoil": lambda x: bg.Airfoil("a", x),
    "Airfoil name": lambda x: bg.Airfoil(x, FOIL.coordinates),
    "Distribution": lambda x: bg.Distribution(x, [1, 2]),
    "Distribution values": lambda x: bg.Distribution([0, 1], x),
    "Distribution spline": lambda x: bg.Distribution([0, 1], [1, 2], x),
    "Distribution eta": LINE,
    "Distribution.constant": bg.Distribution.constant,
    "Station": lambda x: bg.Station(x, FOIL),
    "Station airfoil": lambda x: bg.Station(0.5, x),
    "ReferenceAxis": lambda x: bg.ReferenceAxis(x, LINE, LINE),
    "Rotor": lambda x: bg.Rotor(hub_radius=x),
    **{
        f"BladeDefinition {name}": lambda x, n=name: bg.BladeDefinition(**PARTS | {n: x})
        for name in PARTS
    },
    "standardise": affine.standardise,
    **{
        f.__name__: lambda x, f=f: f(x, POINTS)
        for f in (grassmann.align, grassmann.exp, grassmann.log, grassmann.distance)
    },
    "norm": grassmann.norm,
    "transport": lambda x: grassmann.transport(x, POINTS, POINTS),
    "karcher_mean": grassmann.karcher_mean,
}


@pytest.mark.parametrize("name", CALLS)
def test_odd_arguments_work_or_are_refused_in_a_line(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    refused = 0
    for odd in ODD:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")  # a complex number loses its imaginary part
                CALLS[name](odd)
        except BladegenError as error:
            refused += "\n" not in str(error)
    assert refused > len(ODD) // 3
    assert "0x" not in shown(object())  # of an address, which says nothing


def test_a_space_or_coordinates_that_are_forgotten_are_asked_for():
    how = r"call perturbed\(space, \[t1, t2, \.\.\.\]\), with space = bladegen\.ShapeSpace\.bundled"
    for arguments, said in (
        ((T,), r"space: got \[0\.02, .*\], must be a ShapeSpace"),
        (("bundled",), "space: got 'bundled', must be a ShapeSpace"),
        ((SPACE,), "t: got no coordinates for the shape space"),
        ((SPACE, None), "t: got no coordinates for the shape space"),
        ((None, T), "t: coordinates need a shape space"),
    ):
        with pytest.raises(PerturbationError, match=f"{said}; {how}"):
            BLADE.perturbed(*arguments)
    with pytest.raises(PerturbationError, match=r"t: got 3 coordinates .*--pga.*has 4 modes"):
        BLADE.perturbed(SPACE, [0.1, 0.1, 0.1])
    with pytest.raises(PerturbationError, match="allow_extrapolation=True"):
        BLADE.perturbed(SPACE, [0.9, 0, 0, 0])


def test_a_twist_of_degrees_is_refused_with_both_units():
    with pytest.raises(PerturbationError, match=r"twist: got 1 rad \(57\.3 deg\), allowed"):
        BLADE.perturbed(twist=1)
    with pytest.raises(PerturbationError, match=r"got 1 rad \(57\.3 deg\)"):
        AffineChange(twist=np.array([0.0, 1.0]))


def test_a_variant_is_told_from_its_baseline():
    plain = repr(BLADE)
    assert plain == "<Blade iea15mw: 117.0 m, 10 stations, 401 landmarks>"
    variant = BLADE.perturbed(SPACE, T, thickness=1.05).perturbed(twist=np.radians(2.0))
    assert repr(variant) == (
        f"{plain[:-1]}; perturbed: t 0.02, -0.01, 0.01, 0, thickness 1.05; "
        "perturbed: twist 0.03491 rad (2 deg)>"
    )
    knots = bg.Coordinates([0.5, 0.6], [T, T])
    assert "perturbed: t at 2 spans>" in repr(BLADE.perturbed(SPACE, knots))
    assert "perturbed: by nothing>" in repr(BLADE.perturbed())
    assert repr(SPACE).startswith("<ShapeSpace of 4 modes, 401 landmarks: 16 airfoils, 1000 CST")


def test_what_is_no_blade_says_how_one_is_made(tmp_path):
    with pytest.raises(ExportError, match=r"blade: got 'iea15mw', .*from_definition\(.*read"):
        bg.export("iea15mw", tmp_path / "x.step")
    with pytest.raises(BladegenError, match=r"definition: got 'iea15mw', .*read\('iea15mw'\)"):
        bg.Blade.from_definition("iea15mw")
    with pytest.raises(BladegenError, match="what: got 'iea15mw', must be a Blade, or a"):
        bg.write("iea15mw", tmp_path / "x.yaml")


@pytest.mark.parametrize("tolerance", [100, 0.3, 1e-9, 0, -1e-4, "0.3mm", None])
def test_tolerances_that_cannot_be_meant_are_refused(tmp_path, tolerance):
    with pytest.raises(ExportError, match="tolerance: got "):
        bg.export(BLADE, tmp_path / "x.step", tolerance=tolerance)
    assert not list(tmp_path.iterdir())


def test_options_that_are_none_name_the_one_that_is_meant(tmp_path):
    with pytest.raises(ExportError, match=r"tolerence: no option .*did you mean tolerance"):
        bg.export(BLADE, tmp_path / "x.stl", tolerence=1e-3)
    with pytest.raises(
        ExportError, match=r"tip: got 'round', must be bladegen\.surface\.tips\.flat_tip or"
    ):
        bg.export(BLADE, tmp_path / "x.stl", tip="round")
    assert Options(tip=tips.round_tip).stations == 300


def test_right_arguments_of_other_types_are_taken():
    small = bg.Blade.from_definition(
        DEFINITION,
        landmarks=np.int64(51),
        planes=planform.normal_to_z,
        trailing_edge=edges.Sharp(),
    )
    assert len(small.u) == 51
    assert len(small.stations(np.float64(40))) == 40
    assert BLADE.perturbed(thickness=np.float32(1.0), twist=np.array(0)).changes[-1].keys() == {
        "window"
    }
    assert bg.Station(np.int64(1), FOIL).eta == 1


def test_words_for_values():
    assert shown(np.float64(0.5)) == "np.float64(0.5)"
    assert shown(AXIS) == "a ReferenceAxis"
    assert shown(FOIL) == "an Airfoil"
    assert shown(edges.Sharp) == "the class Sharp"
    assert len(shown(list(range(100)))) < 70
    assert suggestion("--Tolerence", ["tolerance", "tip"]) == "; did you mean tolerance?"
    assert suggestion("zzz", ["tolerance"]) == ""
    assert suggestion(5, ["tolerance"]) == ""


def test_values_come_back_as_their_kind():
    error = BladegenError
    assert amount(np.array([2]), "x", error) == 2.0
    assert whole(401.0, "x", error) == 401
    assert numbers([1, 2], "x", error).dtype == np.float64
    assert path_of("a/b", "x", error) == Path("a/b")
    assert one_of("a", ["a", "b"], "x", error) == "a"
    assert function(len, "x", "a function", error) is len
    with pytest.raises(BladegenError, match="x: got 'B', allowed are a, bb; did you mean bb"):
        one_of("B", ["a", "bb"], "x", error)


def test_complex_numbers_are_called_so():
    """`got an array of shape (14,), must be numbers` said nothing of complex steps."""
    from bladegen.errors import PerturbationError
    from bladegen.support.arguments import numbers

    with pytest.raises(PerturbationError, match=r"x: got .*, must be real numbers; complex steps"):
        numbers(np.ones(3) + 1e-20j, "x", PerturbationError)


def test_a_design_that_is_called_otherwise_is_named():
    from bladegen.errors import SpaceError

    with pytest.raises(SpaceError, match=r"'normal', which is .* called 'gaussian' here"):
        bg.ShapeSpace.bundled().distribution("normal")
