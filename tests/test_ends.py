"""The measured deviation covers every face of a solid, and sees what is wrong with each."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from bladegen import cad, ends, net
from bladegen.blade import Blade
from bladegen.edges import Sharp
from bladegen.readers import bundled, read
from bladegen.tips import flat_tip, round_tip

BLADE = Blade.from_definition(read("dtu10mw"), landmarks=101)
NET, DEVIATION = net.fitted(BLADE, 1e-3)
SHIFT = 2e-3


def moved(rows, columns, shift):
    """The net with some of its poles moved."""
    poles = NET.poles.copy()
    poles[rows, columns] += shift
    return replace(NET, poles=poles)


@pytest.mark.parametrize("tip", [flat_tip, round_tip])
@pytest.mark.parametrize("name", bundled())
def test_every_face_of_a_solid_is_measured(name, tip):
    solid = cad.solid(Blade.from_definition(read(name), landmarks=201), tolerance=1e-3, tip=tip)
    assert list(solid.deviation.faces) == [face for face, _ in solid.faces]
    assert solid.deviation.maximum < 1e-3
    each = solid.deviation.faces.values()
    assert solid.deviation.maximum == max(one.maximum for one in each)
    assert solid.deviation.samples == sum(one.samples for one in each)


def test_a_trailing_edge_that_lies_too_far_aft_is_seen_on_its_strip():
    off = moved([0, -1], slice(None), np.array([0.0, SHIFT, 0.0]))
    before, after = DEVIATION.faces, net.deviation(off, BLADE).faces
    assert before["trailing edge"].maximum < 1e-3
    assert after["trailing edge"].maximum > 0.9 * SHIFT


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
    fitted, deviation = net.fitted(sharp, 1e-3, sections=40)
    assert "trailing edge" not in deviation.faces
    assert fitted.v[0] == 0.0
