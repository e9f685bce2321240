import json
import warnings
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

import bladegen as bg
from bladegen.blade.changes.deformation import AffineChange, Coordinates
from bladegen.blade.edges import AsGiven, MinimumThickness, Sharp
from bladegen.blade.planform import normal_to_z
from bladegen.curves import polygons
from bladegen.errors import PerturbationError
from bladegen.parametric.parameters import AFFINE, clamped
from bladegen.surface.grids.grid import Spacing
from bladegen.surface.grids.grid import from_blade as grid_of
from bladegen.surface.tips import flat_tip, round_tip
from strategies import SEEDS, few

BLADES, PATHS = ("iea15mw", "nrel5mw", "dtu10mw"), ("geodesic", "spline")
SPANS = np.linspace(0.0, 1.0, 17)
ALL = ("pga", *AFFINE)
KNOTS = (("pga", (0.3, 0.6, 0.9)), ("chord", (0.25, 1.0)), ("twist", (0.4, 0.7, 0.95)), "camber")
EXACT = 1e-8  # of the largest derivative in a parameter
STEPS = 2e-3, 2e-4, 2e-5


@cache
def space():
    return bg.ShapeSpace.bundled()


@cache
def blade_of(name, path="geodesic"):
    return bg.Blade.from_definition(bg.read(name), path=path)


@cache
def model_of(name, path="geodesic", parameters=ALL, fine=False, line="kept"):
    u = np.concatenate([np.linspace(0, 0.5, 31), np.linspace(0.5, 1, 31)[1:]]) if fine else None
    return bg.ParametricBlade(blade_of(name, path), space(), parameters, SPANS, u, chord_line=line)


def drawn(model, seed, share=0.4):
    rng = np.random.default_rng(seed)
    return model.baseline + share * (model.upper - model.lower) * rng.uniform(
        -0.5, 0.5, len(model.names)
    )


def differences(f, x):
    """Derivatives (k, ..., p) by Richardson's extrapolation at `STEPS`, and their doubts (k, p)."""
    for step in STEPS:
        moves = step * np.eye(len(x)) * np.array([1.0, 0.5, 0.25])[:, None, None]
        up, down = f(x + moves), f(x - moves)  # (3, p, k, ...)
        rough, fine, finest = ((up[i] - down[i]) / (2 * step / 2**i) for i in range(3))
        first, second = (4 * fine - rough) / 3, (4 * finest - fine) / 3
        found = np.moveaxis((16 * second - first) / 15, 0, -1)
        yield found, np.abs(second - first).reshape(*first.shape[:2], -1).max(axis=2).T


def agree(exact, differences):
    """Hold exact derivatives (k, ..., p) against differences of some step that sees no kink."""
    size = np.abs(exact).reshape(-1, exact.shape[-1]).max(axis=0) + 1e-12
    off, doubts = np.full((2, len(exact), exact.shape[-1]), np.inf)
    for found, doubt in differences:
        here = np.abs(exact - found).reshape(len(exact), -1, exact.shape[-1]).max(axis=1)
        off = np.minimum(off, np.where(doubt < 1e3 * EXACT * size, here, np.inf))
        doubts = np.minimum(doubts, doubt)
    assert (off < EXACT * size).mean() > 0.9
    sure = doubts < 1e3 * EXACT * size
    assert sure.mean() > 0.97
    assert (off < np.maximum(EXACT * size, 3.0 * doubts))[sure].all()


@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize("name", BLADES)
@settings(max_examples=few(12), deadline=None)
@given(seed=SEEDS)
def test_derivatives_are_those_of_extrapolated_differences(name, path, seed):
    model = model_of(name, path)
    x = drawn(model, seed)
    agree(model.jacobian(x), differences(model.sections, x))


@pytest.mark.parametrize("line", ["kept", "paper"])
@pytest.mark.parametrize("fine", [False, True])
def test_knots_other_points_and_the_papers_chord_line_are_differentiated_too(fine, line):
    model = model_of("dtu10mw", parameters=KNOTS, fine=fine, line=line)
    x = drawn(model, 3)
    agree(model.jacobian(x), differences(model.sections, x))


@pytest.mark.parametrize(
    "edge", [AsGiven(), Sharp(), MinimumThickness(0.02), MinimumThickness(0.01, 0.004)]
)
def test_every_finish_of_the_trailing_edge_is_differentiated(edge):
    blade = blade_of("dtu10mw").with_trailing_edge(edge)
    model = bg.ParametricBlade(blade, space(), ("pga", "thickness", "chord"), SPANS)
    x = drawn(model, 4)
    agree(model.jacobian(x), differences(model.sections, x))


def test_planes_that_turn_from_the_flange_follow_the_prebend():
    """Between the flange and the end of the round root, where the bundled blades lean."""
    blade = bg.Blade.from_definition(bg.read("iea15mw"), landmarks=101)
    model = bg.ParametricBlade(blade, None, ("prebend_scale",), np.linspace(0.0, 0.03, 13))
    x = np.array([1.3])
    agree(model.jacobian(x), differences(model.sections, x))
    assert_allclose(model.sections(x)[0, :, 2], 0.0, atol=1e-14)
    bent = blade.perturbed(prebend_scale=1.3)
    assert_allclose(model.sections(x), bent.sections(model.eta), atol=1e-12)


def test_derivatives_of_a_fair_planform_are_exact_too():
    definition = bg.read("iea15mw")
    blade = bg.Blade.from_definition(definition, landmarks=101, fair_planform=bg.PlanformFairing())
    parameters = ("prebend_scale", "chord_scale", "twist_scale", "thickness")
    model = bg.ParametricBlade(blade, None, parameters, SPANS)
    x = np.array([1.2, 1.05, 0.9, 1.02])
    agree(model.jacobian(x), differences(model.sections, x))
    change = dict(zip(parameters, x.tolist(), strict=True))
    assert_allclose(model.sections(x), blade.perturbed(**change).sections(SPANS), atol=1e-11)


def test_sections_that_stay_normal_to_z_follow_the_prebend():
    definition = bg.read("iea15mw")
    blade = bg.Blade.from_definition(definition, planes=normal_to_z)
    model = bg.ParametricBlade(blade, None, ("prebend_scale",), SPANS)
    x = np.array([1.3])
    agree(model.jacobian(x), differences(model.sections, x))
    turned = bg.ParametricBlade(
        bg.Blade.from_definition(definition, planes=lambda _: blade.planform.frames),
        None,
        ("prebend_scale",),
        SPANS,
    )
    with pytest.raises(PerturbationError, match="section planes normal to the axis or to z"):
        turned.jacobian(x)


@pytest.mark.parametrize("name", BLADES)
@settings(max_examples=few(12), deadline=None)
@given(seed=SEEDS)
def test_products_with_the_jacobian_are_adjoint(name, seed):
    model, rng = model_of(name), np.random.default_rng(seed)
    x, dx = drawn(model, seed), rng.normal(size=len(model.names))
    g = rng.normal(size=(len(SPANS), 401, 3))
    along, back = model.jvp(x, dx), model.vjp(x, g)
    size = np.abs(along).max() * np.abs(g).sum()
    assert abs(np.sum(along * g) - back @ dx) < 1e-12 * size
    jacobian = model.jacobian(x)
    assert_allclose(along, jacobian @ dx, rtol=0, atol=1e-12 * np.abs(jacobian).max() * 30)


@pytest.mark.parametrize("name", BLADES)
def test_quantities_are_those_of_the_sections_with_exact_derivatives(name):
    model = model_of(name)
    x = drawn(model, 7)
    found = model.quantities(x)
    sections = model.sections(x)
    volume, area = polygons.volume_and_area(sections)
    assert_allclose([found["volume"], found["area"]], [volume, area], rtol=1e-12)
    batch = model._evaluated(x[None], measured=True)
    for name_, measure in zip(
        polygons.MEASURES, np.moveaxis(batch.measures[0], -1, 0), strict=True
    ):
        assert_allclose(found[f"section_{name_}"], measure, rtol=1e-9, atol=1e-9)
    assert_allclose(found["relative_thickness"], batch.relative_thickness[0], rtol=1e-12)
    assert_allclose(found["chord"], batch.chord[0], rtol=1e-12)
    over_span = [key for key in found if found[key].ndim]
    for keys, part in ((["volume", "area"], (..., None)), (over_span, (...,))):
        scale = np.array([np.abs(found.jacobian(key)).max() for key in keys])

        def together(x, keys=keys, scale=scale, part=part):
            made = model.quantities(x)
            return np.stack([made[key][part] for key in keys], axis=-1) / scale

        exact = np.stack([found.jacobian(key) for key in keys], axis=-2) / scale[:, None]
        exact = exact if exact.ndim == 3 else exact[None]
        agree(exact, differences(together, x))
    stack = model.quantities(np.stack([x, model.baseline]))
    assert_allclose(stack.jacobian("volume")[0], found.jacobian("volume"), rtol=1e-12)
    assert stack.jacobian("section_area").shape == (2, len(SPANS), 11)
    with pytest.raises(PerturbationError, match="quantity: got 'volumes', allowed are volume"):
        found["volumes"]


@pytest.mark.parametrize("fine", [False, True])
def test_a_batch_equals_its_parts_to_the_bit(fine):
    model = model_of("iea15mw", parameters=KNOTS, fine=fine)
    x = np.stack([drawn(model, seed) for seed in range(6)]).reshape(2, 3, -1)
    g = np.random.default_rng(1).normal(size=model.sections(x).shape)
    whole = model.sections(x), model.jacobian(x), model.jvp(x, 0.5 * x), model.vjp(x, g)
    for i, j in ((0, 0), (0, 2), (1, 1)):
        one = x[i, j]
        parts = (
            model.sections(one),
            model.jacobian(one),
            model.jvp(one, 0.5 * one),
            model.vjp(one, g[i, j]),
        )
        for part, all_ in zip(parts, whole, strict=True):
            assert_array_equal(part, all_[i, j])


@pytest.mark.parametrize("name", BLADES)
def test_sections_are_those_of_perturbed_blades(name):
    model = model_of(name)
    x = drawn(model, 5)
    change = AffineChange(**dict(zip(AFFINE, x[4:], strict=True)))
    variant = model.blade.untested(space(), x[:4], change)
    assert_allclose(model.sections(x), variant.sections(SPANS), rtol=0, atol=1e-9)
    finer = model_of(name, fine=True)
    assert_allclose(finer.sections(x), variant.sections(SPANS, finer.u), rtol=0, atol=1e-9)


@pytest.mark.parametrize("parameters", [ALL, KNOTS, (("pga", (0.4, 0.9)), "pga"), ("twist",)])
def test_a_variant_is_the_blade_with_the_models_sections(parameters):
    model = model_of("iea15mw", parameters=parameters)
    x = drawn(model, 6)
    variant = model.variant(x, name="best")
    assert variant.name == "best"
    assert_allclose(model.sections(x), variant.sections(SPANS), rtol=0, atol=1e-9)
    assert_allclose(model.quantities(x)["chord"], variant.chord(SPANS), rtol=1e-12)
    assert "best: 117.0 m" in repr(variant)
    json.dumps(variant.changes)


def over(f):
    """A function of one vector as one of many, (..., p), with points as sections (k, n, 3)."""

    def many(x):
        made = [np.asarray(f(row)) for row in x.reshape(-1, x.shape[-1])]
        return np.reshape(made, (*x.shape[:-1], *made[0].shape))

    return many


@pytest.mark.parametrize("tip", [flat_tip, round_tip])
def test_vertices_of_a_mesh_have_exact_derivatives_and_fixed_triangles(tip):
    model = bg.ParametricBlade(
        blade_of("dtu10mw"), space(), ("pga", "chord", "prebend_scale"), SPANS
    )
    x = drawn(model, 8)
    made = model.mesh(x, tip=tip)
    baseline = model.mesh(model.baseline, tip=tip)
    assert_array_equal(made.faces, baseline.faces)
    assert_allclose(
        model.quantities(x)["volume"], made.volume, rtol=1e-3 if tip is flat_tip else 1e-2
    )
    exact = model.mesh_jacobian(x, tip=tip)
    agree(exact[None], differences(over(lambda row: model.mesh(row, tip=tip).vertices[None]), x))
    with pytest.raises(PerturbationError, match="a mesh needs the tip, 1, as its last"):
        model.at([0.2, 0.5]).mesh(x)
    with pytest.raises(PerturbationError, match="derivatives are known of flat_tip and round_tip"):
        model.mesh(x, tip=lambda *sides: None)


@pytest.mark.parametrize("tip", [flat_tip, round_tip])
@pytest.mark.parametrize("edge", [None, Sharp()])
def test_points_of_a_grid_have_exact_derivatives(tip, edge):
    blade = blade_of("dtu10mw") if edge is None else blade_of("dtu10mw").with_trailing_edge(edge)
    model = bg.ParametricBlade(blade, space(), ("pga", "thickness", "chord"))
    spacing = Spacing(around=41, along=9, edge=4)
    own = grid_of(blade, spacing, tip)
    for block, points in zip(own.blocks, model.grid(model.baseline, spacing, tip=tip), strict=True):
        assert_allclose(points, block.points, rtol=0, atol=1e-9)
    x = drawn(model, 9)
    exact = model.grid_jacobian(x, spacing, tip=tip)
    assert [e.shape for e in exact] == [(*block.eta.shape, 3, 6) for block in own.blocks]

    def points(row):
        return np.concatenate([p.reshape(-1, 3) for p in model.grid(row, spacing, tip=tip)])[None]

    agree(np.concatenate([e.reshape(-1, 3, 6) for e in exact])[None], differences(over(points), x))


def test_parameters_over_span_are_taken_by_a_blade_too():
    blade, knots = blade_of("nrel5mw"), np.array([0.3, 0.9])
    over = bg.Distribution(knots, np.array([1.1, 0.9]))
    variant = blade.perturbed(thickness=over, chord=over, twist=bg.Distribution(knots, knots / 50))
    at = np.array([0.3, 0.5, 1.0])
    assert_allclose(variant.chord(at), blade.chord(at) * over(at), rtol=1e-12)
    ratio = variant.relative_thickness(at) / blade.relative_thickness(at)
    assert_allclose(ratio, np.ones(3), rtol=1e-9)
    assert_allclose(variant.twist(at) - blade.twist(at), [0.006, 0.0, 0.018], atol=0.02)
    assert "thickness over span" in repr(variant)
    with pytest.raises(PerturbationError, match="chord_scale: got <Distribution"):
        blade.perturbed(chord_scale=over)
    with pytest.raises(PerturbationError, match="thickness: got 9, allowed is"):
        blade.perturbed(thickness=bg.Distribution(knots, np.array([1.0, 9.0])))


def test_knots_are_joined_by_a_spline_that_is_level_at_its_ends():
    t = Coordinates([0.3, 0.6, 0.9], np.arange(6.0).reshape(3, 2), clamped)
    assert_allclose(t(np.array([0.0, 0.3, 1.0])), [[0, 1], [0, 1], [4, 5]], rtol=0, atol=1e-15)
    slope = (t(np.array([0.3 + 1e-6])) - t(np.array([0.3]))) / 1e-6
    assert np.abs(slope).max() < 1e-3
    two = (("pga", (0.3, 0.6)), ("pga", (0.2, 0.9)))
    with pytest.raises(PerturbationError, match="pga is given at two sets of knots"):
        model_of("iea15mw", parameters=two).variant(np.zeros(16))
    with pytest.raises(PerturbationError, match="must be one vector of 11"):
        model_of("iea15mw").variant(np.ones((2, 11)))


def test_at_a_kink_the_derivative_is_that_of_one_side():
    blade = blade_of("iea15mw")
    eta = np.array([0.9])
    chord = float(blade.chord(eta)[0])
    edge = MinimumThickness(0.01 * chord, 0.01)  # both rules meet at this chord
    model = bg.ParametricBlade(blade.with_trailing_edge(edge), None, ("chord_scale",), eta)
    one, width = np.ones(1), lambda x: model.sections(x)[0, 0] - model.sections(x)[0, -1]
    exact = model.jacobian(one)[0, 0, :, 0] - model.jacobian(one)[0, -1, :, 0]
    step = 1e-6
    below, above = (width(one) - width(one - step)) / step, (width(one + step) - width(one)) / step
    assert np.abs(below - above).max() > 1e-3 * chord
    assert_allclose(exact, below, rtol=0, atol=1e-7)


def test_names_baseline_and_bounds_are_those_of_parameters_and_data():
    model = model_of("nrel5mw", parameters=KNOTS)
    assert model.names[:4] == tuple(f"pga[{j}] at 0.3" for j in range(4))
    assert model.names[-4:] == ("twist at 0.4", "twist at 0.7", "twist at 0.95", "camber")
    assert_array_equal(model.baseline, [0.0] * 12 + [1.0] * 2 + [0.0] * 3 + [1.0])
    assert_array_equal(model.lower[:4], space().lower)
    assert_array_equal(model.upper[8:12], space().upper)
    assert_array_equal(model.sections(model.baseline)[3], model.sections(model.baseline)[3])
    bounded = bg.ParametricBlade(
        model.blade, space(), KNOTS, SPANS, bounds={"pga": (-1, 2), "twist at 0.7": (0, 0.1)}
    )
    assert (bounded.upper[:12] == 2.0).all()
    assert bounded.lower[-3] == 0.0
    assert repr(bounded).startswith("<ParametricBlade of nrel5mw: 17 sections, 18 parameters: pga[")


def test_sound_vectors_are_told_from_others_as_in_a_family():
    model = model_of("iea15mw")
    x = np.stack([drawn(model, seed, 1.5) for seed in range(12)])
    family = bg.family(model.blade, space(), bounds=dict.fromkeys(AFFINE[:3], (0.9, 1.1)))
    rules = type(family._rules)(model._batch, family.design.what, 0.05, False, False)
    values = np.concatenate([x[:, :4], x[:, 4:7]], axis=1)
    plain = x.copy()
    plain[:, 7:] = model.baseline[7:]
    found = model.faults(plain)
    for reason, other in zip(found, rules.tested(values), strict=True):
        assert reason == other or "outside" in other
    assert model.valid(plain).tolist() == [not reason for reason in found]
    assert 0 < model.valid(plain).sum() < 12
    assert model.valid(model.baseline).shape == ()
    assert model.faults(model.baseline) == [""]


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"parameters": ()}, "got none, must be a list of 'pga' or one of thickness"),
        ({"parameters": ("chrod",)}, "did you mean chord"),
        ({"parameters": (3,)}, "parameters: got 3, must be 'pga'"),
        ({"parameters": ("chord", "chord")}, "parameters: chord is given twice"),
        ({"parameters": (("chord_scale", [0.1]),)}, "chord_scale scales a whole distribution"),
        ({"parameters": (("chord", [0.5, 0.2]),)}, "must increase within 0"),
        ({"parameters": (("chord", "x"),)}, "must be span fractions"),
        ({"space": None}, "'pga' needs a shape space"),
        ({"bounds": {"chrod": (0, 1)}}, "did you mean chord"),
        ({"bounds": {"chord": (1, 0)}}, "chord: got 1 to 0, must not fall"),
        ({"bounds": {"chord": 3}}, "bounds: chord: got 3, must be two numbers"),
        ({"blade": "iea15mw"}, "blade: got 'iea15mw', must be a Blade"),
        ({"space": "bundled"}, "space: got 'bundled', must be a ShapeSpace"),
        ({"window": 3}, "window: got 3"),
        ({"u": np.array([0.1, 0.9])}, "u: must run from 0 to 1 and be symmetric"),
        ({"chord_line": "kpet"}, "chord_line: got 'kpet'"),
    ],
)
def test_slips_are_answered_in_one_line(changed, said):
    given = {"blade": blade_of("iea15mw"), "space": space(), "parameters": ("pga", "chord")}
    with pytest.raises(PerturbationError, match=said) as error:
        bg.ParametricBlade(**given | changed)
    assert "\n" not in str(error.value)


def test_vectors_and_gradients_of_another_kind_are_refused():
    model = model_of("iea15mw")
    with pytest.raises(PerturbationError, match="must be 11 numbers or arrays"):
        model.sections(np.zeros(3))
    with pytest.raises(PerturbationError, match="x: must be finite"):
        model.sections(np.full(11, np.nan))
    with pytest.raises(PerturbationError, match=r"dx: got .* must be of shape \(11,\), as x"):
        model.jvp(model.baseline, np.zeros(3))
    with pytest.raises(PerturbationError, match=r"g: got .* must be of shape \(17, 401, 3\)"):
        model.vjp(model.baseline, np.zeros(3))
    with pytest.raises(PerturbationError, match="thickness: got 9, allowed is"):
        model.sections(np.full(11, 9.0))
    blade = model.blade
    perturbed = blade.untested(space(), [0.01] * 4, AffineChange())
    with pytest.raises(PerturbationError, match="make the model of the baseline"):
        bg.ParametricBlade(perturbed, space())
    with pytest.raises(PerturbationError, match="is a mirror image"):
        bg.ParametricBlade(blade.mirror_image(), space())
    odd = blade.with_trailing_edge(lambda profiles, chord: profiles)
    with pytest.raises(PerturbationError, match="derivatives are known of MinimumThickness"):
        bg.ParametricBlade(odd, space()).jacobian(np.zeros(4))


def test_numbers_with_names_are_taken_by_name():
    """A Series or a table in another order was taken by place, and a mapping was refused."""
    pandas = pytest.importorskip("pandas")
    model = bg.ParametricBlade(blade_of("iea15mw"), space(), ("pga", "chord"), eta=[0.6])
    x = model.baseline + np.array([0.01, -0.02, 0.005, 0.0, 0.03])
    wanted, along = model.sections(x), model.jvp(x, x)
    series = pandas.Series(x, index=model.names)[::-1]
    table = pandas.DataFrame([x, x], columns=["t1", "t2", "t3", "t4", "chord"]).iloc[:, ::-1]
    for given_ in (series, series.to_dict(), pandas.Series(x)):
        assert_array_equal(model.sections(given_), wanted)
        assert_array_equal(model.jvp(x, given_), along)
    assert_array_equal(model.sections(table), np.stack([wanted, wanted]))
    for given_, said in (
        ({"chord": 1.0}, r"x: has no 'pga\[0\]'; names must be pga\[0\], .*, chord, in any order"),
        (table.drop(columns="t2"), r"x: has no 'pga\[1\]'"),
        (table.assign(volume=1.0), "x: has 'volume', which is no parameter"),
    ):
        with pytest.raises(PerturbationError, match=said):
            model.quantities(given_)


def test_compiling_is_said_once(monkeypatch):
    """The first Jacobian on a machine took 40 s without a word."""
    from bladegen.support import compiled

    monkeypatch.setattr(compiled, "is_kept", lambda function: False)
    compiled.announced.cache_clear()
    model = bg.ParametricBlade(blade_of("iea15mw"), space(), ("pga",), eta=[0.6])
    with pytest.warns(UserWarning, match="compiles its loops, once on this machine"):
        model.jacobian(model.baseline)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        model.jacobian(model.baseline + 0.01)


@given(st.floats(0.21, 4.9))
def test_the_width_of_edges_has_the_slope_that_it_says(chord):
    edge = MinimumThickness(0.002, 0.004)
    step = 1e-6
    beside = (edge.width(np.array(chord + step)) - edge.width(np.array(chord - step))) / (2 * step)
    if abs(0.002 / chord - 0.004) > 1e-5:
        assert_allclose(edge.width_slope(np.array(chord)), beside, rtol=1e-5, atol=1e-12)
