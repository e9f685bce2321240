"""The measured deviation covers every face of a solid, and sees what is wrong with each."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from bladegen.airfoils.landmarks import landmark_parameters
from bladegen.blade.blade import Blade
from bladegen.blade.edges import Sharp
from bladegen.cad import solids
from bladegen.formats.reading import read
from bladegen.surface import deviation, ends, fitting
from bladegen.surface.tips import flat_tip, on_arcs, round_tip
from strategies import by_day, net_through

BLADE = Blade.from_definition(read("dtu10mw"), landmarks=101)
NET, DEVIATION = fitting.fitted(BLADE, 1e-3)
SHIFT = 2e-3


def moved(rows, columns, shift):
    """The net with some of its poles moved."""
    poles = NET.poles.copy()
    poles[rows, columns] += shift
    return replace(NET, poles=poles)


@pytest.mark.parametrize("tip", [flat_tip, round_tip])
@pytest.mark.parametrize("name", by_day("iea15mw"))
def test_every_face_of_a_solid_is_measured(name, tip):
    solid = solids.solid(Blade.from_definition(read(name), landmarks=201), tolerance=1e-3, tip=tip)
    assert list(solid.deviation.faces) == [face for face, _ in solid.faces]
    assert solid.deviation.maximum < 1e-3
    each = solid.deviation.faces.values()
    assert solid.deviation.maximum == max(one.maximum for one in each)
    assert solid.deviation.samples == sum(one.samples for one in each)


def test_a_trailing_edge_that_lies_too_far_aft_is_seen_on_its_strip():
    off = moved([0, -1], slice(None), np.array([0.0, SHIFT, 0.0]))
    before, after = DEVIATION.faces, deviation.deviation(off, BLADE).faces
    assert before["trailing edge"].maximum < 1e-3
    assert after["trailing edge"].maximum > 0.9 * SHIFT


def test_the_root_face_of_a_solid_lies_in_the_plane_of_the_flange():
    assert BLADE.definition.axis(0.0, 1)[0] != 0.0
    assert_allclose(NET.poles[:, 0, 2], 0.0, atol=1e-12)


@pytest.mark.parametrize(("face", "column"), [("root", 0), ("tip", -1)])
def test_an_end_that_lies_too_far_out_is_seen(face, column):
    normal = BLADE.planform.frames(np.array([0.0 if face == "root" else 1.0]))[0, 2]
    off = moved(slice(None), column, SHIFT * normal)
    for one, wanted in ((NET, 0.0), (off, SHIFT)):
        parts = {part.face: part for part in ends.measured(one, BLADE, flat_tip)}
        assert_allclose(parts[face].distances, wanted, atol=1e-9)


def test_a_round_tip_of_another_size_is_seen():
    def higher(*sides):
        poles = round_tip(*sides)
        poles[:, 1:-1] += SHIFT * BLADE.planform.frames(np.array([1.0]))[0, 2]
        return poles

    made = ends.rounded(NET, higher)
    u = np.unique(np.concatenate([[0.0], 0.5 * (NET.u[1:] + NET.u[:-1]), [0.5, 1.0]]))
    wanted = ends.arcs(BLADE, round_tip, u)
    tip, edge = ends._round(NET, made, wanted, u[: len(wanted)])
    assert 0.7 * SHIFT < tip.distances.max() < 0.8 * SHIFT  # 3/4 of the shift of inner poles
    assert edge.distances.max() < SHIFT
    good, _ = ends._round(NET, ends.rounded(NET, round_tip), wanted, u[: len(wanted)])
    assert good.distances.max() < 0.05 * SHIFT


def test_a_sharp_edge_has_no_strip():
    sharp = replace(BLADE, trailing_edge=Sharp())
    fitted, deviation = fitting.fitted(sharp, 1e-3, sections=40)
    assert "trailing edge" not in deviation.faces
    assert fitted.v[0] == 0.0


def drop(lean, edge):
    """A cylinder whose section is a drop that cubic splines hold exactly, leaning along its chord.

    With s = 2 u - 1: x = s^2, y = s - (1 - edge) s^3, half a thickness of `edge` where x = 1.
    """
    u, v = landmark_parameters(41), np.linspace(0.0, 1.0, 5)
    s = 2.0 * u - 1.0
    flat = np.stack([s**2, s - (1.0 - edge) * s**3, 0.0 * s], axis=-1)
    return net_through(flat + 2.0 * v[:, None, None] * np.array([lean, 0.0, 1.0]), u, v)


def twisted(*sides):
    """A tip whose sides lean fore and aft, so that no edge of it lies in a plane."""
    poles = round_tip(*sides)
    reach = np.linalg.norm(poles[:, 0] - poles[:, -1], axis=-1)[:, None]
    poles[:, 1] += reach * [0.2, 0.1, 0.3]
    poles[:, 2] -= reach * [0.1, -0.1, 0.1]
    return poles


@pytest.mark.parametrize("edge", [0.0, 0.2])
@pytest.mark.parametrize("lean", [0.0, 0.5])
def test_a_round_tip_has_the_volume_of_its_arcs(lean, edge):
    # A cubic arc of 180 degrees over 2 h encloses 8/5 h^2; here h = s - c s^3 and dx = 2 s ds.
    c = 1.0 - edge
    wanted = 3.2 * (1 / 4 - c / 3 + c**2 / 8) / np.hypot(1.0, lean)
    found = ends.tip_volume(drop(lean, edge), round_tip)
    assert_allclose(found, wanted, rtol=1e-12)
    assert ends.tip_volume(drop(lean, edge), flat_tip) == 0.0


def enclosed(*grids):
    """The volume that two triangles a cell of grids (m, n, 3) enclose."""
    cells = [(grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]) for grid in grids]
    return sum(np.sum(a * (np.cross(b, c) + np.cross(c, d))) / 6.0 for a, b, c, d in cells)


def test_a_twisted_tip_has_the_volume_of_its_triangles():
    made = drop(0.3, 0.2)
    u, w = np.linspace(0.0, 0.5, 201), np.linspace(0.0, 1.0, 201)
    side, other = (made.evaluate(places, np.ones(1))[0] for places in (u, 1.0 - u))
    along = np.broadcast_to([0.3, 0.0, 1.0], side.shape)
    poles = twisted(side, other, along, along)
    face = on_arcs(poles[:, None], np.broadcast_to(w, (len(u), len(w))))
    base = side[:, None] + w[:, None] * (other - side)[:, None]
    strip = base[0] + w[:, None, None] * (face[0] - base[0])
    fine, coarse = (
        enclosed(*(grid[::k, ::k] for grid in (face, base[::-1], strip))) for k in (1, 2)
    )
    found = ends.tip_volume(made, twisted)
    assert_allclose(found, abs(fine + (fine - coarse) / 3.0), rtol=1e-7)
    assert abs(found / ends.tip_volume(made, round_tip) - 1.0) > 0.1
