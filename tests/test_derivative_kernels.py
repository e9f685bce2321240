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
from bladegen.blade.edges import MinimumThickness, Sharp
from bladegen.curves import plane_maps
from bladegen.parametric import coefficient_kernels, edge_slopes, kernels, section_slopes
from bladegen.support import compiled
from bladegen.variants import section_measures, sizes
from strategies import box

CHAIN = (
    compiled,
    plane_maps,
    characteristics,
    section_measures,
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
    assert not model._batch.alone.any()
    x, step = np.array([0.01, 0.02, -0.01, 0.005, 1.05]), np.array([0, 0, 0, 0, 1e-4])
    found = (model.sections(x + step) - model.sections(x - step)) / 2e-4
    exact = model.jacobian(x)
    assert_allclose(exact[..., 4], found, rtol=0, atol=1e-5 * np.abs(exact).max())
    g = np.random.default_rng(1).normal(size=found.shape)
    monkeypatch.setattr(parametric, "coefficient_kernels", plain()[0])
    assert_allclose(model.jacobian(x), exact, rtol=0, atol=1e-7 * np.abs(exact).max())
    assert_allclose(model.vjp(x, g)[4], np.sum(g * exact[..., 4]), rtol=1e-6)
