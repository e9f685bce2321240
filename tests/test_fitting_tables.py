"""Tables of points and of sections: columns, units, order, and what is wrong with them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.errors import BladegenError, FileError, GeometryError
from bladegen.fitting import measuring, sources
from bladegen.fitting.sections.cutting import Cutter
from bladegen.fitting.tables.lofting import surface_of_sections
from bladegen.fitting.tables.reading import table_of
from bladegen.measures import surfaces

SPANS = np.array([0.12, 0.3, 0.5, 0.75, 0.9])
LENGTH = 20.0


def chord(eta):
    return 2.0 - 1.2 * eta


def outlines(count=30, points=121):
    """Sections (count, points, 3) of a straight blade of plain formulas, trailing edge first."""
    t = np.linspace(-1.0, 1.0, points)
    x = 0.5 * (1.0 + np.cos(np.pi * (1.0 - np.abs(t))))
    y = -np.sign(t) * (0.3 * np.sqrt(x) * (1.0 - x) + 0.01 * x) + 0.2 * x * (1.0 - x)
    eta = np.linspace(0.0, 1.0, count)
    c = chord(eta)[:, None]
    z = np.broadcast_to(LENGTH * eta[:, None], (count, points))
    return eta, np.stack([c * y, c * (x - 0.3), z], axis=-1)


def lines(rows, header=(), mark=","):
    return "\n".join([*header, *(mark.join(f"{v:.9g}" for v in row) for row in rows)]) + "\n"


def flat(sections, *, first=None):
    rows = sections.reshape(-1, 3)
    if first is None:
        return rows
    return np.column_stack([np.repeat(first, sections.shape[1]), rows])


def form(name):
    """A table's text, and the length that has to be said with it."""
    eta, own = outlines()
    number = np.arange(len(eta))
    if name == "section, x, y, z in mm":
        return lines(flat(1e3 * own, first=number), ["section,x [mm],y [mm],z [mm]"]), None
    if name == "units below":
        return lines(flat(1e3 * own, first=number), ["station;x;y;z", "-;mm;mm;mm"], ";"), None
    if name == "eta, x, y":
        return lines(flat(own, first=eta)[:, :3], ["eta,x_m,y_m"]), LENGTH
    if name == "span, x, y":
        return lines(flat(own, first=LENGTH * eta)[:, :3], ["span (m),x (m),y (m)"]), None
    if name == "names of columns in another order":
        return lines(flat(own)[:, [2, 1, 0]], ["z_m\ty_m\tx_m"], "\t"), None
    if name == "no header":
        return lines(flat(own), mark=" "), None
    if name == "no header, index first":
        return lines(flat(own, first=number), mark=" "), None
    if name == "blank lines":
        return "\n".join(lines(one, mark=" ") for one in own), None
    if name == "one side and then the other":
        half = own.shape[1] // 2
        own = np.concatenate([own[:, half::-1], own[:, half:]], axis=1)
        return lines(flat(own), ["x,y,z"]), None
    raise AssertionError(name)


FORMS = (
    "section, x, y, z in mm", "units below", "eta, x, y", "span, x, y", "no header",
    "names of columns in another order", "no header, index first", "blank lines",
    "one side and then the other",
)  # fmt: skip


@pytest.mark.parametrize("name", FORMS)
def test_sections_in_a_table_become_the_surface_through_them(tmp_path, name):
    path = tmp_path / "blade.csv"
    text, length = form(name)
    path.write_text(text)
    side, cloud, noise = sources.source_of(path, length, None)
    assert cloud is None
    assert noise == 0.0
    assert "30 sections" in side.remarks[0]
    axis = measuring.axis_of(np.array([0.0, 1.0]), np.zeros(2), LENGTH)
    made = measuring.measured(Cutter(side.surface).cuts, axis, SPANS, name="table")
    assert_allclose(made.chord, chord(SPANS), atol=2e-3)
    assert_allclose(made.twist, 0.0, atol=2e-3)
    width = (made.airfoils[:, 0] - made.airfoils[:, -1])[:, 1] * made.chord
    assert_allclose(width, 0.02 * chord(SPANS), atol=1e-3)


@given(st.integers(8, 40), st.integers(61, 161), st.booleans())
def test_how_many_points_and_which_way_round_does_not_matter(count, points, back):
    from bladegen.fitting.tables.reading import Table

    _, own = outlines(count, points)
    own = own[:, ::-1] if back else own
    rows = list(np.arange(count * points).reshape(count, points))
    columns = dict(zip("xyz", own.reshape(-1, 3).T, strict=True))
    mesh, said = surface_of_sections(Table("it", columns), rows, None)
    axis = measuring.axis_of(np.array([0.0, 1.0]), np.zeros(2), LENGTH)
    made = measuring.measured(Cutter(surfaces.of_mesh(mesh)).cuts, axis, SPANS, name="it")
    assert_allclose(made.chord, chord(SPANS), atol=4e-3)
    assert len(said) == 1


def broken(name):
    eta, own = outlines()
    number = np.arange(len(eta))
    if name == "no length":
        return lines(flat(own, first=eta)[:, :3], ["eta,x,y"])
    if name == "no place":
        return lines(flat(own, first=number)[:, :3], ["section,x,y"])
    if name == "airfoils":
        own = own / np.stack([chord(eta)] * 2 + [np.ones(30)], -1)[:, None]
        return lines(flat(own), ["x,y,z"])
    if name == "in no order":
        own = np.random.default_rng(2).permuted(own, axis=1)
        return lines(flat(own, first=number), ["section,x,y,z"])
    if name == "twice":
        return lines(flat(np.concatenate([own, own[:1]])), ["span [m],b,a"]).replace(
            "span [m],b,a", "x,y,span"
        )
    if name == "few":
        return lines(flat(own[:, ::20], first=number), ["section,x,y,z"])
    if name == "units":
        return lines(flat(own), ["x [mm],y [mm],z [m]"])
    if name == "no y":
        return lines(flat(own), ["x,z,chord"])
    raise AssertionError(name)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("no length", "how long is the blade"),
        ("no place", "no column z, span or eta"),
        ("airfoils", "they are airfoils, not sections of a blade"),
        ("in no order", "its points are in no order round it"),
        ("twice", "is in 2 places; put its rows together"),
        ("few", "30 sections, one of 7 points"),
        ("units", "has lengths in several units"),
        ("no y", "has no column y"),
    ],
)
def test_tables_that_are_ambiguous_end_in_one_line(tmp_path, name, said):
    path = tmp_path / "blade.csv"
    path.write_text(broken(name))
    with pytest.raises(FileError, match=said) as raised:
        sources.source_of(path, None, None)
    assert "\n" not in str(raised.value)


def test_a_unit_that_the_titles_contradict_and_a_length_for_nothing_are_refused(tmp_path):
    path = tmp_path / "blade.csv"
    path.write_text(form("section, x, y, z in mm")[0])
    with pytest.raises(FileError, match="--unit m another"):
        bg.fit(path, unit="m")
    with pytest.raises(BladegenError, match="length: is for tables of sections"):
        bg.fit(tmp_path / "a.stl", length=3.0)
    with pytest.raises(BladegenError, match="must be positive"):
        bg.fit(path, length=-1.0)


def test_points_in_no_sections_stay_a_cloud(tmp_path):
    path = tmp_path / "scan.csv"
    points = np.random.default_rng(3).normal(size=(50, 3))
    path.write_text(lines(np.column_stack([np.arange(50), points]), ["id,x,y,z"]))
    table = table_of(path)
    assert table.sections() is None
    assert_allclose(table.points, points, atol=1e-8)
    with pytest.raises(GeometryError, match="50 points, at least 2000 are needed"):
        bg.fit(path)
