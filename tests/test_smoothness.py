from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.measures.smoothness import creases


def blade(name, path, **options):
    return bg.Blade.from_definition(bg.read(name), path=path, **options)


@pytest.mark.parametrize("name", bg.bundled())
def test_geodesics_crease_at_stations_and_splines_do_not(name):
    eta, kinked = creases(blade(name, "geodesic"))
    assert np.degrees(kinked.max()) > 0.3
    assert_allclose(eta, blade(name, "geodesic").eta[1:-1])
    _, smooth = creases(blade(name, "spline"))
    assert np.degrees(smooth.max()) < 0.02


def test_a_kink_in_the_planform_is_measured():
    made = blade("dtu10mw", "spline", landmarks=101)
    place = float(made.eta[3])

    def bent(_grid, _values):
        def spline(eta, nu=0):
            return made.definition.twist(eta, nu) + (
                np.maximum(np.asarray(eta) - place, 0) if nu == 0 else np.asarray(eta) > place
            )

        return spline

    twist = replace(made.definition.twist, spline=bent)
    kinked = replace(made, definition=replace(made.definition, twist=twist))
    _, angle = creases(kinked)
    others = np.delete(angle, 2)
    assert angle[2] > 5 * others.max()
    # half a chord turns by d(twist)/dz out of its plane: the slope of a ruled surface
    reach = made.chord(place) * 0.8 / made.length
    assert 0.3 * reach < angle[2] < 1.5 * reach
