"""How thick walls are between and across the edges of layers."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_sectors import LENGTH, RADIUS, constant, tube

import bladegen as bg
from bladegen.blade.layup.outlines import Outlines
from bladegen.blade.layup.walls import BLEND, RAMP, Walls
from bladegen.definition.structure.positions import Arc, Shifted

U = np.linspace(0.0, 1.0, 4001)
ETA = np.array([0.0, 0.11, 0.5, 0.83, 1.0])


@pytest.fixture(scope="module")
def pipe():
    return tube()


def walls(blade, *layers):
    """Walls of layers, each by thickness, start, end, and what else it is."""
    made = [
        bg.Layer(
            str(i),
            "steel",
            thick if isinstance(thick, bg.Distribution) else constant(thick),
            *(Arc(constant(end)) if isinstance(end, float) else end for end in ends),
            **(more[0] if more else {}),
        )
        for i, (thick, ends, *more) in enumerate(layers)
    ]
    structure = replace(blade.definition.structure, layers=tuple(made))
    return Walls(replace(blade, definition=replace(blade.definition, structure=structure)).layup)


def integral(found, eta):
    """Integrals (k,) of thickness along the arc [m2], and how long arcs are at U."""
    outlines = Outlines.of(found.layup.blade, eta)
    at = np.array([np.interp(U, found.layup.blade.u, row) for row in outlines.fractions])
    along = at * outlines.length[:, None]
    return np.trapezoid(found.thickness(eta, U), along, axis=1), along


def test_layers_all_around_add_up(pipe):
    found = walls(pipe, (0.02, (0.0, 1.0)), (0.005, (0.0, 1.0)))
    assert_allclose(found.thickness(ETA, U), 0.025, rtol=1e-12)


def test_a_step_runs_out_over_its_ramp_and_nowhere_else(pipe):
    found = walls(pipe, (0.02, (0.0, 1.0)), (0.01, (0.3, 0.6)))
    thick = found.thickness(ETA, U)
    along = integral(found, ETA)[1]
    from_edge = along - 0.3 * along[:, -1:]
    half = 0.5 * RAMP * 2.0 * RADIUS
    near_end = np.abs(along - 0.6 * along[:, -1:]) < half
    assert_allclose(thick[(from_edge < -half) | (along > 0.7 * along[:, -1:])], 0.02, rtol=1e-12)
    assert_allclose(thick[(from_edge > half) & (along < 0.55 * along[:, -1:])], 0.03, rtol=1e-12)
    assert np.all(np.diff(thick[(from_edge > -half) & (from_edge < half)].reshape(5, -1)) > 0.0)
    assert np.all(np.diff(thick[near_end].reshape(5, -1)) < 0.0)
    row = np.array([np.interp(0.0, here, own) for here, own in zip(from_edge, thick, strict=True)])
    assert_allclose(row, 0.025, rtol=1e-4)


@pytest.mark.parametrize("ends", [(0.3, 0.6), (0.0, 0.4), (0.004, 0.3), (0.995, 1.0), (0.49, 0.5)])
def test_ramps_keep_the_area_of_layers(pipe, ends):
    """Narrow ones and those that end beside the trailing edge among them."""
    area, along = integral(walls(pipe, (0.01, ends)), ETA)
    assert_allclose(area, 0.01 * (ends[1] - ends[0]) * along[:, -1], rtol=2e-3)


def test_a_layer_around_the_trailing_edge_is_on_both_sides(pipe):
    wide = constant(1.0)
    ends = Shifted(Arc(constant(1.0)), wide, -0.5), Shifted(Arc(constant(0.0)), wide, 0.5)
    found = walls(pipe, (0.01, ends))
    thick = found.thickness(ETA, U)
    assert_allclose(thick, thick[:, ::-1], atol=1e-9)
    assert_allclose(thick[:, [0, -1]], 0.01, rtol=1e-9)
    assert_allclose(integral(found, ETA)[0], 0.01, rtol=2e-3)


def test_a_layer_that_ends_at_once_runs_out_along_the_span(pipe):
    found = walls(pipe, (0.02, (0.0, 1.0)), (0.01, (0.0, 1.0), {"extent": (0.25, 0.6)}))
    eta = np.linspace(0.0, 1.0, 8001)
    thick = found.thickness(eta, np.array([0.2]))[:, 0]
    far = np.minimum(np.abs(eta - 0.25), np.abs(eta - 0.6)) > BLEND
    inside = (eta > 0.25) & (eta < 0.6)
    assert_allclose(thick[far & inside], 0.03, rtol=1e-12)
    assert_allclose(thick[far & ~inside], 0.02, rtol=1e-12)
    steepest = np.abs(np.diff(thick)).max() / np.diff(eta)[0]
    assert 0.01 / BLEND < steepest < 0.01 / BLEND * 3.0
    assert_allclose(np.trapezoid(thick, eta), 0.02 + 0.01 * 0.35, rtol=2e-3)


def test_even_changes_along_the_span_stay_as_they_are(pipe):
    found = walls(pipe, (bg.Distribution([0.0, 1.0], [0.04, 0.01]), (0.0, 1.0)))
    eta = np.linspace(0.0, 1.0, 777)
    wanted = np.broadcast_to(0.04 - 0.03 * eta[:, None], (777, 3))
    assert_allclose(found.thickness(eta, U[:3]), wanted, atol=1e-12)
    assert LENGTH * BLEND < 1.0  # m, of which a step here takes


@pytest.mark.parametrize("name", ["iea15mw", "nrel5mw"])
def test_walls_of_a_blade_have_the_area_of_its_layers(name):
    """Against widths that know of no ramps; the trailing edge's base is none of the outline."""
    blade = bg.Blade.from_definition(bg.read(name), landmarks=101)
    found, eta = Walls(blade.layup), np.linspace(0.0, 1.0, 301)
    laid, outlines = blade.layup.at(eta), Outlines.of(blade, eta)
    skin = [not layer.web for layer in blade.layup.structure.layers]
    base = laid.edge[skin].sum(axis=-1) * outlines.half_edge
    own = np.sum(laid.thickness[skin] * (laid.width[skin] - base), axis=0)
    area = integral(found, eta)[0]
    assert_allclose(np.median(np.abs(area / own - 1.0)), 0.0, atol=3e-4)
    assert_allclose(area, own, rtol=0.015)  # where thickness bends along the span
    assert_allclose(np.trapezoid(area, eta), np.trapezoid(own, eta), rtol=3e-4)


def test_a_mirror_image_has_the_same_walls():
    blade = bg.Blade.from_definition(bg.read("iea15mw"), landmarks=101)
    u = np.linspace(0.0, 1.0, 57) ** 1.3
    there = Walls(blade.mirror_image().layup).thickness(ETA, u)
    assert_allclose(there, Walls(blade.layup).thickness(ETA, 1.0 - u[::-1])[:, ::-1], atol=1e-12)
    assert not np.allclose(there, there[:, ::-1], atol=1e-3)
