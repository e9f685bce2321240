"""Solids in pieces: the same surface, names, and the volume that CAD systems find by default."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from scipy.interpolate import BSpline

import bladegen as bg
from bladegen.blade.edges import Sharp
from bladegen.cad import exchange, pieces, shapes, solids
from bladegen.measures.checks import solid_figures
from bladegen.surface.tips import flat_tip, round_tip
from strategies import SEEDS

TIPS = pytest.mark.parametrize("tip", [flat_tip, round_tip])


def default_volume(shape):
    """The volume [m3] that OCCT, and so FreeCAD, says when nothing is asked of its accuracy."""
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties)
    return properties.Mass() / 1e9


@given(SEEDS, st.integers(4, 40), st.integers(1, 9))
def test_pieces_are_the_surface_and_share_their_rims(seed, count, most):
    rng = np.random.default_rng(seed)
    inner = np.sort(rng.uniform(0.01, 0.99, count))
    crease = inner[count // 2]
    v_knots = np.sort(np.concatenate([[0.0] * 4, inner, [crease] * 2, [1.0] * 4]))
    u_knots = np.array([0.0, 0.0, 0.5, 1.0, 1.0])
    whole = pieces.Patch(rng.normal(size=(3, len(v_knots) - 4, 3)), u_knots, v_knots)
    v = pieces.cuts(v_knots, most)
    assert crease in v
    rows = pieces.cut(whole, np.array([0.5]), v)
    assert [len(row) for row in rows] == [2] * (len(v) + 1)
    for (low, _), (high, _) in pairwise(rows):
        assert np.array_equal(low.poles[:, -1], high.poles[:, 0])
    for row in rows:
        assert np.array_equal(row[0].poles[-1], row[1].poles[0])
        for piece in row:
            assert len(np.unique(piece.v_knots)) - 1 <= most
            x = rng.uniform(*piece.v_knots[[0, -1]], 5)
            ours = BSpline(piece.v_knots, piece.poles, 3, axis=1)(x)
            (row_of,) = (slice(0, 2),) if piece.u_knots[0] == 0 else (slice(1, 3),)
            theirs = BSpline(v_knots, whole.poles, 3, axis=1)(x)[row_of]
            assert_allclose(ours, theirs, atol=1e-12)


@pytest.mark.parametrize(
    ("name", "tip"),
    [  # each tip on every run, the other pairs at night
        ("dtu10mw", round_tip),
        ("nrel5mw", flat_tip),
        pytest.param("iea15mw", round_tip, marks=pytest.mark.nightly),
        pytest.param("iea15mw", flat_tip, marks=pytest.mark.nightly),
        pytest.param("nrel5mw", round_tip, marks=pytest.mark.nightly),
        pytest.param("dtu10mw", flat_tip, marks=pytest.mark.nightly),
    ],
)
def test_occt_s_default_volume_is_the_exact_one(name, tip):
    blade = bg.Blade.from_definition(bg.read(name))
    made = solids.solid(blade, tolerance=1e-3, tip=tip, split=True)
    assert_allclose(default_volume(made.shape), made.volume, rtol=1e-5)


@TIPS
def test_the_file_is_one_solid_with_numbered_faces(tip, tmp_path):
    blade = bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=101)
    options = {"sections": 40, "tip": tip}
    made, whole = solids.solid(blade, split=True, **options), solids.solid(blade, **options)
    exchange.write_step(made, tmp_path / "a.step")
    figures = solid_figures(exchange.read(tmp_path / "a.step"), quick=True)
    assert figures["one_solid"]
    assert figures["valid"]
    assert figures["closed"]
    assert figures["faces"] == len(made.faces)
    names = [name for name, _ in made.faces]
    assert names[:4] == [f"suction side {k}" for k in range(1, 5)]
    assert {name.rstrip(" 0123456789") for name in names} == {name for name, _ in whole.faces}
    assert made.deviation.maximum == whole.deviation.maximum
    assert made.volume == whole.volume
    assert_allclose(shapes.area(made.shape), shapes.area(whole.shape), rtol=1e-5)


def test_a_sharp_edge_is_sewn_in_pieces_too():
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101, trailing_edge=Sharp())
    made = solids.solid(blade, sections=40, split=True)
    assert solid_figures(made.shape, quick=True)["closed"]
    assert "trailing edge 1" not in dict(made.faces)


def test_export_splits(tmp_path):
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=51)
    path = bg.export(blade, tmp_path / "a.step", sections=30, split=True)
    assert "ADVANCED_FACE('pressure side 3'" in path.read_text()
    assert "split=yes" in path.read_text()
