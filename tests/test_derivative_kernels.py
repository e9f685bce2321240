"""The kernels of derivatives as plain Python give what they give compiled."""

import sys
from dataclasses import replace
from functools import cache

import numba
import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_kernels import loaded

import bladegen as bg
from bladegen import parametric
from bladegen.airfoils import characteristics
from bladegen.airfoils.landmarks import landmarks, uniform
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.blade.edges import MinimumThickness, Sharp
from bladegen.blade.variants import nose_measures, section_measures, sizes
from bladegen.curves import plane_maps
from bladegen.parametric import coefficient_kernels, edge_slopes, kernels, section_slopes
from bladegen.support import compiled
from strategies import box, ellipse

CHAIN = (
    compiled,
    plane_maps,
    characteristics,
    section_measures,
    nose_measures,
    sizes,
    section_slopes,
    edge_slopes,
    coefficient_kernels,
    kernels,
)


@cache
def plain():
    """The last two of the chain, loaded with all before them as plain Python."""
    known = {module.__name__: module for module in CHAIN}
    numba.config.DISABLE_JIT = True
    fresh = {}
    try:
        for module in CHAIN:
            fresh[module.__name__] = loaded(module, **fresh)
    finally:
        numba.config.DISABLE_JIT = False
        sys.modules.update(known)
    return fresh[coefficient_kernels.__name__], fresh[kernels.__name__]


@pytest.mark.parametrize("edge", [MinimumThickness(0.01), Sharp()])
def test_plain_and_compiled_kernels_agree(edge, monkeypatch):
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=41).with_trailing_edge(edge)
    eta = [0.1, 0.4]
    model = bg.ParametricBlade(blade, bg.ShapeSpace.bundled(), ("pga", "chord"), eta, bounds={})
    x = np.array([0.03, -0.02, 0.01, 0.02, 1.05])
    g = np.random.default_rng(1).normal(size=(2, 41, 3))
    found = model.jacobian(x), model.vjp(x, g), model.sections(x)
    monkeypatch.setattr(parametric, "coefficient_kernels", plain()[0])
    monkeypatch.setattr(parametric, "kernels", plain()[1])
    again = model.jacobian(x), model.vjp(x, g), model._linear(x)[0].sections()[0]
    for one, other in zip(found, again, strict=True):
        assert_allclose(other, one, rtol=1e-9, atol=1e-9)


def test_where_the_baseline_has_two_noses_its_chord_lines_move_with_the_thickness(monkeypatch):
    definition = bg.read("nrel5mw")
    square = bg.Airfoil("square", box(201, np.array([0.02]))[0] * [1.0, 0.6])
    stations = tuple(
        replace(one, airfoil=square) if one.eta < 0.2 else one for one in definition.stations
    )
    definition = replace(definition, stations=stations, relative_thickness=None)
    blade = bg.Blade.from_definition(definition)
    space = bg.ShapeSpace.bundled()
    model = bg.ParametricBlade(blade, space, ("pga", "thickness"), [0.05, 0.1], window=bg.Window())
    assert not model._batch.standing.alone.any()
    x, step = np.array([0.01, 0.02, -0.01, 0.005, 1.05]), np.array([0, 0, 0, 0, 1e-4])
    found = (model.sections(x + step) - model.sections(x - step)) / 2e-4
    exact = model.jacobian(x)
    assert_allclose(exact[..., 4], found, rtol=0, atol=1e-5 * np.abs(exact).max())
    g = np.random.default_rng(1).normal(size=found.shape)
    monkeypatch.setattr(parametric, "coefficient_kernels", plain()[0])
    assert_allclose(model.jacobian(x), exact, rtol=0, atol=1e-7 * np.abs(exact).max())
    assert_allclose(model.vjp(x, g)[4], np.sum(g * exact[..., 4]), rtol=1e-6)


@pytest.mark.parametrize(
    ("points", "low", "high"),
    [
        (box(201, np.array([0.0]))[0], 1.0, 1.0),
        (box(201, np.array([2e-3]))[0], 1.0, 1.0),
        (landmarks(ellipse(1.168), 201, spacing=uniform), 0.5, 0.99),
        (landmarks(ellipse(1.16), 201, spacing=uniform), 0.05, 0.4),
        (landmarks(ellipse(0.4), 201, spacing=uniform), 0.0, 0.0),
    ],
)
def test_gradients_of_sections_with_round_noses_are_exact(points, low, high):
    """Whatever the share of the mean of many points; against differences of numpy's measures."""
    u = np.linspace(0.0, 1.0, 201)
    splines = SectionSplines(u)
    rng = np.random.default_rng(5)
    waves = np.stack([np.sin((k + 1) * np.pi * u) for k in range(2)])
    values = np.concatenate([points.T, waves, np.ones((1, 201))])
    slopes = np.ascontiguousarray(splines.values(u, 1) @ values.T)
    c = np.concatenate([np.eye(2), 1e-4 * rng.normal(size=(2, 2)), [[0.1, 0.2]]])

    def measures(c):
        curve = splines.fit((values.T @ c)[None])
        return np.array([*curve.leading_edge[0], curve.chord[0], curve.thickness[0]])

    assert low <= splines.fit((values.T @ c)[None]).shares[0] <= high
    rows, spare = np.empty((4, 5, 2)), np.empty((2, 4, 5, 2))
    section = section_measures.Section(u, slopes, c, np.ascontiguousarray((values.T @ c).T))
    section_slopes.gradients(section, values, np.empty(201), rows, spare)
    change, step = rng.normal(size=c.shape), 1e-6
    found = [measures(c + h * change) - measures(c - h * change) for h in (step, 2.0 * step)]
    wanted = (8.0 * found[0] - found[1]) / (12.0 * step)
    assert_allclose(np.einsum("qfj,fj->q", rows, change), wanted, rtol=1e-6, atol=2e-6)
