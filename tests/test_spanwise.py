import csv

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.curves.sides import sides
from bladegen.measures.properties import area_moments
from bladegen.measures.spanwise import spanwise, write_csv

ETA = np.linspace(0, 1, 41)


@pytest.mark.parametrize("name", bg.bundled())
def test_columns_are_those_of_the_blade(name):
    blade = bg.Blade.from_definition(bg.read(name))
    columns = spanwise(blade, ETA)
    chord = blade.chord(ETA)
    assert_allclose(columns["chord_m"], chord)
    assert_allclose(columns["relative_thickness"], blade.wanted_thickness(ETA), atol=1e-9)
    finished = blade.trailing_edge(blade.profiles(ETA), chord) * chord[:, None, None]
    area, moments = area_moments(blade.u, finished)
    assert_allclose(columns["area_m2"], area, rtol=2e-4)
    assert_allclose(columns["centroid_x_m"], moments[:, 0] / area, rtol=2e-4)
    assert np.all(columns["inertia_yy_m4"] > columns["inertia_xx_m4"] * 0.99)
    assert columns["edge_width_m"].min() >= 0.002 - 1e-9


def test_a_round_root_is_a_circle():
    blade = bg.Blade.from_definition(bg.read("iea15mw"))
    columns = spanwise(blade, np.zeros(1))
    radius = columns["chord_m"] / 2
    assert_allclose(columns["area_m2"], np.pi * radius**2, rtol=1e-3)
    assert_allclose(columns["inertia_xx_m4"], np.pi * radius**4 / 4, rtol=1e-3)
    assert_allclose(columns["perimeter_m"], 2 * np.pi * radius, rtol=1e-3)


def test_sides_of_an_ellipse():
    t = np.linspace(0, 2 * np.pi, 801)
    ellipse = np.stack([0.5 + 0.5 * np.cos(t), 0.1 * np.sin(t)], axis=-1)
    x = np.linspace(0.05, 0.95, 7)
    upper, lower = sides(np.stack([ellipse, 2 * ellipse + 1]), x)
    wanted = 0.1 * np.sqrt(1 - (2 * x - 1) ** 2)
    assert_allclose(upper, [wanted, wanted], atol=1e-4)
    assert_allclose(lower, [-wanted, -wanted], atol=1e-4)


def test_csv_holds_every_digit(tmp_path):
    columns = {"eta": np.array([0.0, 1 / 3]), "chord_m": np.array([np.pi, np.e])}
    write_csv(columns, tmp_path / "x.csv")
    with (tmp_path / "x.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert_allclose([float(row["chord_m"]) for row in rows], columns["chord_m"], rtol=1e-14)
