"""A blade as a component of OpenMDAO, in the real library."""

import subprocess
import sys
from functools import cache

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.errors import PerturbationError
from bladegen.openmdao import BladeComponent
from bladegen.parametric.adapters.outputs import follows
from bladegen.parametric.parameters import AFFINE

PARAMETERS = (("pga", (0.3, 0.6, 0.9)), ("chord", (0.3, 0.9)), ("twist", (0.3, 0.9)), "thickness")
EVERY = ("sections", "volume", "section_inertia_xx", "relative_thickness", "twist")


@cache
def model():
    blade = bg.Blade.from_definition(bg.read("iea15mw"), landmarks=101)
    space = bg.ShapeSpace.bundled()
    u = np.linspace(0.0, 1.0, 21)
    return bg.ParametricBlade(blade, space, PARAMETERS, np.linspace(0.35, 1.0, 5), u)


def problem(*args, **options):
    made = om.Problem(reports=False)
    made.model.add_subsystem("blade", BladeComponent(model(), *args, **options), promotes=["*"])
    made.setup()
    return made


def vector():
    rng = np.random.default_rng(4)
    return model().baseline + 0.02 * rng.normal(size=len(model().names))


NIGHTLY = pytest.mark.nightly
OTHERS = [pytest.param(False, None, marks=NIGHTLY), pytest.param(True, False, marks=NIGHTLY)]


@pytest.mark.parametrize(("split", "matrix_free"), [(True, None), (False, False), *OTHERS])
@pytest.mark.filterwarnings("error")
def test_partials_are_those_of_differences_forward_and_back(split, matrix_free):
    made = problem(EVERY, split=split, matrix_free=matrix_free)
    component = made.model.blade
    x = vector()
    for name, place in component.places.items():
        made[name] = x[place]
    made.run_model()
    assert_allclose(made["sections"], model().sections(x), rtol=0, atol=1e-12)
    found = made.check_partials(out_stream=None, form="central", step=1e-5)["blade"]
    for (output, given), pair in found.items():
        if not follows(output, given.removeprefix("x_")):
            continue
        exact = component.made.at(x).jacobian(output)
        size = np.abs(exact).max()
        assert np.abs(pair["J_fwd"] - pair["J_fd"]).max() < 1e-6 * size
        if component.matrix_free:
            assert_allclose(pair["J_rev"], pair["J_fwd"], rtol=0, atol=1e-12 * size)
    assert component.matrix_free is (matrix_free is None)


def test_outputs_follow_the_kinds_that_are_declared_and_no_others():
    blade = model().blade
    every = bg.ParametricBlade(blade, model().space, ("pga", *AFFINE), np.linspace(0.3, 0.9, 4))
    x = every.baseline + 0.02
    component = BladeComponent(every, ("sections", *every.quantities(x)), split=True)
    for output in component.made.names:
        jacobian = component.made.at(x).jacobian(output)
        for name, place in component.places.items():
            followed = follows(output, name.removeprefix("x_"))
            assert followed == (np.abs(jacobian[..., place]).max() > 1e-9), (output, name)


def test_products_go_through_a_whole_problem_in_both_directions():
    x, totals = vector(), {}
    for mode in ("fwd", "rev"):
        made = om.Problem(reports=False)
        made.model.add_subsystem("blade", BladeComponent(model(), ("sections", "area")))
        made.model.add_subsystem(
            "sum",
            om.ExecComp(
                "y = sum(points**2) + area",
                points={"shape": (5, 21, 3), "units": "m"},
                area={"units": "m**2"},
            ),
        )
        made.model.connect("blade.sections", "sum.points")
        made.model.connect("blade.area", "sum.area")
        made.setup(mode=mode)
        made["blade.x"] = x
        made.run_model()
        totals[mode] = made.compute_totals("sum.y", "blade.x")["sum.y", "blade.x"][0]
    exact = model().vjp(x, 2.0 * model().sections(x)) + model().quantities(x).jacobian("area")
    assert_allclose(totals["fwd"], exact, rtol=1e-10)
    assert_allclose(totals["rev"], exact, rtol=1e-10)


def test_inputs_and_outputs_have_units_shapes_and_the_baselines_values():
    made = problem(("chord", "volume"), split=True)
    made.run_model()
    component = made.model.blade
    assert {name: len(made[name]) for name in component.places} == {
        "x_pga": 12,
        "x_chord": 2,
        "x_twist": 2,
        "x_thickness": 1,
    }
    assert_allclose(made["x_thickness"], [1.0])
    assert made.get_val("volume", units="L")[0] == pytest.approx(1e3 * made["volume"][0])
    assert made.get_val("x_twist", units="deg").shape == (2,)
    assert made["chord"].shape == (5,)
    assert not component.matrix_free
    assert problem("sections").model.blade.made.names == ("sections",)


def test_slips_are_answered_in_one_line():
    with pytest.raises(PerturbationError, match="did you mean volume"):
        BladeComponent(model(), ("volum",))
    with pytest.raises(PerturbationError, match="outputs: got none"):
        BladeComponent(model(), ())
    with pytest.raises(PerturbationError, match="model: got 'iea15mw', must be a bladegen"):
        BladeComponent("iea15mw")
    made = problem()
    made.setup(force_alloc_complex=True)
    made.run_model()
    with pytest.raises(PerturbationError, match="check_partials"):
        made.check_partials(out_stream=None, method="cs")


@pytest.mark.parametrize("library", ["openmdao", "torch", "jax"])
def test_a_missing_library_is_one_line_that_names_what_to_install(library):
    code = (
        f"import sys; sys.modules[{library!r}] = None\n"
        f"try: import bladegen.{library}\n"
        "except ImportError as error: print(error)"
    )
    said = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout.splitlines()
    assert len(said) == 1
    assert f"this needs {library}," in said[0]
    assert f"pip install 'bladegen[{library}]'" in said[0]
