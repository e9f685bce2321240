"""What airfoil files are like in the world: one shape, written in many ways, is one shape.

The reference is the plain file; areas are shoelace sums in numpy, which no reader has a hand in.
"""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from bladegen.errors import FileError
from bladegen.formats.airfoils.closing import ends
from bladegen.formats.airfoils.contours import ContourError, contour
from bladegen.formats.airfoils.reading import of_lines, read_contour, tabulates
from strategies import circle, naca

SHARP = np.round(naca(0.18, 0.02, 0.0, 61), 6)
BLUNT = np.round(naca(0.30, 0.02, 0.02, 61), 6)


def area(points):
    x, y = np.asarray(points).T
    return 0.5 * abs(float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)))


def rows(points, form="{0:.6f} {1:.6f}"):
    return [form.format(x, y) for x, y in points]


def fortran(value):
    return f"{value:.7e}".replace("e", "D")


def short(value):
    """As Fortran writes exponents of three digits: without their letter."""
    return f"{value:.7e}".replace("e-", "-0").replace("e+", "+0")


WAYS = {
    "a title": ["NACA 63-215", *rows(SHARP)],
    "a title and a count": ["NACA 0012", str(len(SHARP)), *rows(SHARP)],
    "no title": rows(SHARP),
    "remarks behind numbers": [
        r + " ! nose" if i % 7 == 0 else r for i, r in enumerate(rows(SHARP))
    ],
    "remarks of every kind": [
        f"{r} {('! a', '# b', '% c', '// d', '; e')[i % 5]}" for i, r in enumerate(rows(SHARP))
    ],
    "remarks between": [line for r in rows(SHARP) for line in ("# a remark 1.0 2.0", "", r)],
    "commas": ["x,y", *rows(SHARP, "{0:.6f},{1:.6f}")],
    "commas and blanks": rows(SHARP, "{0:.6f} , {1:.6f},"),
    "tabs": rows(SHARP, "\t{0:.6f}\t{1:.6f}"),
    "semicolons": rows(SHARP, "{0:.6f};{1:.6f}"),
    "quotes": rows(SHARP, '"{0:.6f}","{1:.6f}"'),
    "decimal commas and blanks": [r.replace(".", ",") for r in rows(SHARP)],
    "decimal commas and semicolons": [
        "x;y",
        *(r.replace(".", ",") for r in rows(SHARP, "{0:.6f};{1:.6f}")),
    ],
    "decimal commas, tabs and remarks": [
        r.replace(".", ",") + " ! a, b" for r in rows(SHARP, "{0:.6f}\t{1:.6f}")
    ],
    "Fortran's D": [f" {fortran(x)}  {fortran(y)}" for x, y in SHARP],
    "Fortran's d": [f" {fortran(x)}  {fortran(y)}".lower() for x, y in SHARP],
    "Fortran without the letter": [f" {short(x)}  {short(y)}" for x, y in SHARP],
    "a constant z": rows(SHARP, "{0:.6f} {1:.6f} 0.0"),
    "a constant z and a header": ["X Y Z", *rows(SHARP, "{0:.6f},{1:.6f},-2.5")],
    "text behind the points": [
        *rows(SHARP),
        "designed 28/12/2005",
        "28/12/2005 for 400,000 and more",
    ],
    "NuMAD": [
        "<reference>made 1 2</reference>",
        "<coords>",
        *rows(SHARP, "{0:.6f}\t{1:.6f}"),
        "</coords>",
    ],
    "Lednicer": [
        "A FOIL",
        f" {61}.  {61}.",
        "",
        *rows(SHARP[60::-1]),
        "",
        *rows(SHARP[60:]),
    ],
    "Lednicer without counts": ["A FOIL", *rows(SHARP[60::-1]), "", *rows(SHARP[60:])],
    "two sides from the edge": ["A FOIL", *rows(SHARP[:61]), "", *rows(SHARP[:59:-1])],
    "AeroDyn": [
        "! a comment",
        f"{len(SHARP) + 1}   NumCoords   ! number of coordinates",
        "! x-y of the reference point",
        "0.25 0.0",
        "! x-y of the shape",
        *rows(SHARP),
    ],
}


def stood(lines):
    return of_lines(lines, "foil.dat")


@pytest.mark.parametrize("way", WAYS)
def test_a_shape_is_the_same_however_it_is_written(way):
    points = stood(WAYS[way]).points
    assert_allclose(points, SHARP, rtol=0, atol=1e-12)
    assert area(points) == pytest.approx(area(SHARP), rel=1e-12)


@pytest.mark.parametrize(
    ("factor", "said"), [(100.0, "in per cent"), (1000.0, "in thousandths"), (2.5, "scaled by 0.4")]
)
def test_other_units_are_brought_to_chords_and_said(factor, said):
    read = stood(rows(factor * BLUNT, "{0:.8f} {1:.8f}"))
    assert_allclose(read.points, BLUNT, rtol=0, atol=1e-9)
    assert [remark for remark in read.said if said in remark and f"{factor:g}" in remark]


@pytest.mark.parametrize("shift", [(-0.25, 0.0), (0.3, 0.0), (0.0, 0.2), (-0.5, -0.1)])
def test_a_contour_that_stands_elsewhere_is_shifted_and_said(shift):
    read = stood(rows(SHARP + shift))
    assert_allclose(read.points, SHARP, rtol=0, atol=1e-6)
    assert "shifted to 0" in "; ".join(read.said)
    counted = ["122 NumCoords", f"{0.25 + shift[0]} {shift[1]}", *rows(SHARP + shift)]
    assert_allclose(stood(counted).reference, (0.25, 0.0), rtol=0, atol=1e-6)


@pytest.mark.parametrize("repeated", [True, False])
@pytest.mark.parametrize("foil", [SHARP, BLUNT, circle(81)], ids=["sharp", "blunt", "circle"])
@pytest.mark.parametrize("way", [1, -1])
def test_a_contour_from_the_nose_is_turned_and_said(foil, repeated, way):
    middle = len(foil) // 2
    closed = np.all(foil[0] == foil[-1])
    ring = np.roll(foil[:-1] if closed else foil, -middle, axis=0)[::way]
    if way < 0:
        ring = np.roll(ring, 1, axis=0)
    listed = np.concatenate([ring, ring[:1]]) if repeated else ring
    read = stood(rows(listed, "{0:.9f} {1:.9f}"))
    assert_allclose(read.points[::way], foil, rtol=0, atol=1e-8)
    assert "turned to start there" in "; ".join(read.said)


@pytest.mark.parametrize("foil", [SHARP, circle(81), circle(37)], ids=["sharp", "circle", "coarse"])
@pytest.mark.parametrize("side", ["first", "last"])
def test_an_edge_point_that_is_listed_once_is_listed_again(foil, side):
    once = foil[:-1] if side == "first" else foil[1:]
    read = stood(rows(once, "{0:.9f} {1:.9f}"))
    assert_allclose(read.points, foil, rtol=0, atol=1e-8)
    assert "is listed once" in "; ".join(read.said)


@pytest.mark.parametrize("gap", [1e-4, 0.002, 0.02, 0.08, 0.39])
@pytest.mark.parametrize("slant", [-0.25, 0.0, 0.25])
@pytest.mark.parametrize("count", [21, 61, 200])
def test_an_open_edge_stays_open_with_its_gap(gap, slant, count):
    foil = naca(max(0.18, gap + 0.05), 0.02, gap, count)
    wedge = foil[:, 0] - foil[:, 0].min()
    foil[:, 0] += slant * foil[:, 1] * wedge**8  # cut as far as 14 degrees from upright
    read = stood(rows(foil, "{0:.12f} {1:.12f}"))
    assert_allclose(read.points, foil, rtol=0, atol=1e-11)
    assert "listed once" not in "; ".join(read.said)


def test_a_cylinder_that_is_cut_is_open_and_its_chord_is_said():
    """As the DTU 10 MW's: cut at x = 0.998, 391 points."""
    angle = np.linspace(0.0785, 2 * np.pi - 0.0785, 391)
    foil = 0.5 + 0.5 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    foil[:, 1] -= 0.5
    read = contour(foil)
    assert_array_equal(read.points, foil)
    assert read.said == (
        "its chord is 0.9985, from x = 0.0000 to 0.9985; stretched by 1.0015 to a chord of 1",
    )


def test_a_base_whose_middle_is_listed_once_is_closed():
    """As NuMAD's interpolated shapes: (1, 0) first, then both corners of the base."""
    foil = np.concatenate([[[1.0, 0.0]], BLUNT])
    foil[1, 0] = foil[-1, 0] = 1.0
    foil[:, 1] -= 0.5 * (foil[1, 1] + foil[-1, 1]) * (np.arange(len(foil)) > 0)
    read = contour(foil)
    assert_array_equal(read.points[[0, -1]], [[1.0, 0.0], [1.0, 0.0]])


def test_a_thick_edge_of_coarse_points_is_open_without_a_word():
    """As FX 77-W-500 in the IEA 3.4 MW: steep sides, both ends at x = 1, no two points alike."""
    foil = naca(0.5, 0.0, 0.025, 34)
    foil[:, 1] += np.where(foil[:, 0] < 0.999, 0.02 * np.sign(foil[:, 1]), 0.0)
    foil = np.delete(foil, [1, 4, -6], axis=0)
    read = contour(foil)
    assert_array_equal(read.points, foil)
    assert "apart" not in "; ".join(read.said)


@pytest.mark.parametrize(("turned", "level"), [(0.0, False), (0.025, True), (0.3, False)])
def test_ends_in_doubt_are_open_and_said(turned, level):
    """A circle with points symmetric about neither end nor the gap; ends at one x are plain."""
    angle = np.concatenate([[0.0], np.linspace(0.12, 2 * np.pi - 0.05, 60)]) + turned
    foil = np.stack([0.5 + 0.5 * np.cos(angle), 0.5 * np.sin(angle)], axis=1)
    taken = ends(foil)
    assert not taken.closed
    assert (taken.said is None) == level


@pytest.mark.parametrize("end", [0.95, 0.999])
def test_a_contour_that_ends_early_is_said_with_both_figures(end):
    x = SHARP[:, 0]
    cut = SHARP[x <= end]
    read = contour(cut)
    assert_array_equal(read.points, cut)
    last = 0.5 * (cut[0, 0] + cut[-1, 0])
    assert f"to {last:.4f}; stretched by" in "; ".join(read.said)
    shorter = contour(SHARP[x <= 0.8], any_unit=True)
    assert "a chord of 1 is expected: the shape is scaled by 1.2" in "; ".join(shorter.said)


def test_an_inclined_chord_line_is_said():
    turn = np.radians(3.0)
    turned = SHARP @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    assert "inclined by 3.00 deg" in "; ".join(contour(turned).said)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("0.5 0.1x", "got '0.5 0.1x', must be x and y"),
        ("0.5", "got '0.5', must be x and y"),
        ("lower surface", "got 'lower surface', must be x and y"),
        ("0.5 0.1 nose", "got '0.5 0.1 nose', must be x and y"),
        ("0.5 0.1 0.2", "must hold 2 numbers as the first"),
        ("0.5 nan", "must be finite"),
        ("0.5 1e999", "must be finite"),
        ("0.5 0.1 0.2 0.3", "must be x and y"),
        ("0.5,,0.1", "must be x and y"),
        ("0.95-0.00123", "put a space between the two"),
        ("******** 0.05", "stars are what Fortran writes where a number is too wide"),
        ("0.5 ********", "stars are what"),
        ("0.5, ****", "stars are what"),
        ("  ****  -.05", "stars are what"),
        ("1_0 0", "must be x and y"),
    ],
)
@pytest.mark.parametrize("at", [1, 60, 119])
def test_no_line_between_points_is_passed_over(line, said, at):
    """At the second place, at the nose and at the last but one."""
    lines = ["A FOIL", *rows(SHARP)]
    lines[1 + at] = line
    with pytest.raises(FileError, match=f"foil.dat: line {2 + at}: ") as caught:
        stood(lines)
    assert said in str(caught.value)


@pytest.mark.parametrize(
    "line", ["1.0 0.0x", "1.0 nan", "1.000O 0.0", "0.99,,0.1", "0.95-0.00123", "**** 0.0"]
)
@pytest.mark.parametrize("at", [1, len(SHARP)])
def test_a_damaged_first_or_last_point_is_no_title_and_no_text(line, at):
    lines = ["A FOIL", *rows(SHARP)]
    lines[at] = line
    with pytest.raises(FileError, match=f"line {1 + at}: "):
        stood(lines)


@pytest.mark.parametrize(
    "line", ["* 0.5 0.05", "* the nose", "********", "*** 2nd side ***", "** by hand"]
)
def test_remarks_may_begin_with_stars(line):
    lines = ["A FOIL", *rows(SHARP)]
    lines.insert(60, line)
    assert_array_equal(stood(lines).points, stood(["A FOIL", *rows(SHARP)]).points)


def test_what_is_passed_over_ahead_and_behind_is_said():
    lines = ["A FOIL", "-2.0 3.0 -2.5 3.5", *rows(SHARP), "by hand", "a", "b", "c"]
    said = "; ".join(stood(lines).said)
    assert "line 2 ('-2.0 3.0 -2.5 3.5') ahead of the points passed over" in said
    assert "line 124 ('by hand')" in said
    assert "and 1 more behind the points passed over" in said


def test_counts_that_are_wrong_are_said_or_refused():
    assert "counts 99 points, the file holds 121" in "; ".join(
        stood(["A FOIL", "99", *rows(SHARP)]).said
    )
    assert "NumCoords counts 99 points, the file holds 122" in "; ".join(
        stood(["99 NumCoords", "0.25 0", *rows(SHARP)]).said
    )
    wrong = ["A FOIL", "61. 60.", *rows(SHARP[60::-1]), *rows(SHARP[60:])]
    with pytest.raises(FileError, match="line 2: counts 61 and 60 points of the sides, 121 togeth"):
        stood(wrong)


@pytest.mark.parametrize(
    ("lines", "held"),
    [
        (["alpha cl cd", "-10 -0.5 0.02", "0 0.4 0.01", "10 1.2 0.02"], "polars"),
        (
            ["x", *(f"{a} 0.1 0.02 0.0" for a in range(-180, 181, 10)), "EOT"],
            "a table of 4 columns",
        ),
        (["Alpha;CL", *(f"{a};0.1" for a in range(-10, 10))], "polars"),
        (["! AirfoilInfo", '@"c.txt" NumCoords', "1 NumTabs"], "polars"),
        (["Read me", "these are my airfoils"], "no coordinates"),
        (WAYS["a title"], None),
        (WAYS["a constant z"], None),
        (WAYS["AeroDyn"], None),
        (WAYS["Lednicer"], None),
        (WAYS["decimal commas and semicolons"], None),
        (["a foil of one number", "1.0"], None),
        (["inf 0 0 0"] * 9, None),
    ],
)
def test_polars_and_texts_are_told_from_shapes(lines, held):
    assert tabulates(lines) == held


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_encodings_do_not_matter(tmp_path, encoding):
    path = tmp_path / "flügel.afl"
    path.write_text("\n".join(["Flügel", *rows(SHARP)]), encoding=encoding)
    assert_allclose(read_contour(path).points, SHARP, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("points", "said"),
    [
        (SHARP[:70], "does not run from trailing edge to trailing edge"),
        (np.roll(SHARP[:-1], 30, axis=0), "does not run from trailing edge to trailing edge"),
        (SHARP * [1e9, 1e9], "x spans 1e+09"),
        (SHARP * [1.0, 30.0], "y spans"),
        (SHARP * [1.0, 0.0], "the contour is 0 thick"),
        (SHARP[::40], "has 4 points"),
    ],
)
def test_what_is_no_airfoil_is_refused(points, said):
    with pytest.raises(ContourError) as caught:
        contour(points, any_unit=True)
    assert said in str(caught.value)


@given(st.floats(0.1, 0.6), st.floats(0.0, 0.04), st.integers(15, 90), st.booleans())
def test_closing_is_decided_alike_from_both_sides(thick, camber, half, sharp):
    """A law: the contour run the other way round is closed or open as this one is."""
    foil = naca(thick, camber, 0.0 if sharp else 0.1 * thick, half)
    once = foil[:-1] if sharp else foil
    there, back = ends(once), ends(once[::-1])
    assert there.closed == back.closed == sharp
    assert_array_equal(there.points, back.points[::-1])


def columns(x):
    """Both sides of a cambered airfoil over the same x: upper and lower y."""
    half = 0.6 * (0.2969 * np.sqrt(x) - 0.126 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)
    camber = 0.08 * x * (1 - x)
    return camber + half, camber - half


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("title", [[], ["x/c,upper,lower"]])
@pytest.mark.parametrize("form", ["{:.8f} {:.8f} {:.8f}", "{:.8f},{:.8f},{:.8f}"])
def test_both_sides_in_columns_are_a_contour(way, swapped, title, form):
    x = 0.5 - 0.5 * np.cos(np.linspace(0, np.pi, 41))
    upper, lower = columns(x)
    table = np.stack([x, lower, upper] if swapped else [x, upper, lower], axis=1)[::way]
    lines = [*title, *(form.format(*row) for row in table)]
    assert tabulates(lines) is None
    read = of_lines(lines, "a.csv")
    wanted = np.concatenate([np.stack([x, upper], 1)[::-1], np.stack([x, lower], 1)[1:]])
    wanted = wanted[::-1] if swapped else wanted
    assert_allclose(read.points, wanted, atol=1e-8)
    assert any(
        "three columns are read as x, y of one side and y of the other" in s for s in read.said
    )


X = np.linspace(0.0, 1.0, 21)
THREE = {  # what three columns may be else, and the line that is named
    "camber and thickness": (np.stack([X, 0.1 * X * (1 - X), 0.12 * np.sqrt(X)], 1), 2),
    "sides that cross": (np.stack([X, 0.1 * (0.5 - X), -0.1 * (0.5 - X)], 1), 2),
    "x that turns": (np.stack([4 * X * (1 - X), *columns(X)], 1), 2),
    "x to 0.7": (np.stack([0.7 * X, *columns(X)], 1), 2),
    "sides apart at the nose": (np.stack([X, 0.1 + 0 * X, -0.1 * (1 - X)], 1), 2),
    "lift and drag": (np.stack([X, 0.1 + 5 * X, 0.01 + X**2], 1), 2),
}


@pytest.mark.parametrize("name", THREE)
def test_other_columns_are_one_error_with_file_and_line(name):
    table, line = THREE[name]
    lines = [" ".join(f"{value:.6f}" for value in row) for row in table]
    with pytest.raises(FileError) as caught:
        of_lines(lines, "a.dat")
    said = str(caught.value)
    assert said.startswith(f"a.dat: line {line}: got ")
    assert "y of one side and y of the other" in said
    assert "\n" not in said
