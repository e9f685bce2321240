"""Figures of README.md and docs/ that no other test holds, each at its own figure.

Tables are read from the pages themselves, so that a page and the program cannot part.  What takes
long runs at night; times, and what needs other programs, is measured by `make bench`.
"""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import brentq

import bladegen as bg
from bladegen.airfoils.fairing import fair
from bladegen.airfoils.landmarks import landmarks, oriented
from bladegen.blade.edges import MinimumThickness, Sharp
from bladegen.cad import solids
from bladegen.formats.baselines import baselines
from bladegen.measures import properties
from bladegen.measures.fairness import fairness
from bladegen.measures.inflections import inflections
from bladegen.measures.smoothness import creases, edge_bulges, edge_widths
from bladegen.shapes import affine, cst
from bladegen.surface.grids import grid, grid_quality
from bladegen.surface.tips import flat_tip, round_tip
from bladegen.views.plots import combs

PAGES = Path(__file__).parents[1] / "docs"
NAMES = {"DTU 10 MW": "dtu10mw", "IEA 15 MW": "iea15mw", "NREL 5 MW": "nrel5mw"}
ROUNDING = 0.51  # of the last digit that a page shows


def table(page, head):
    """The cells of the table of a page whose first line begins with `head`, without its two heads.

    An empty first cell repeats the one above.
    """
    lines = (PAGES / page).read_text().splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith(head)) + 2
    rows = []
    for line in lines[start:]:
        if not line.startswith("|"):
            break
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        rows.append([cells[0] or rows[-1][0], *cells[1:]])
    return rows


def blade(said, path="geodesic", **how):
    """The bundled blade that a row names; others are not bundled."""
    return bg.Blade.from_definition(bg.read(NAMES[said]), path=path, **how)


def digit(said):
    """The size of the last digit of a figure that a page shows, and the figure."""
    mantissa, _, power = said.replace(",", "").partition("e")
    return 10.0 ** (int(power or 0) - len(mantissa.partition(".")[2])), float(said.replace(",", ""))


def assert_shown(value, said):
    """A figure is what a page says, to the digits that it shows."""
    size, figure = digit(said)
    assert abs(value - figure) < ROUNDING * size, (value, said)


@pytest.mark.parametrize("name", bg.bundled())
def test_sections_are_as_exact_as_the_readme_says(name):
    made = bg.Blade.from_definition(bg.read(name))
    airfoils = affine.restore(made.representatives, made.M, made.b)
    wanted = made.wanted_thickness(made.eta)
    sized = affine.restore(airfoils, *made.splines.normalising(airfoils, wanted))
    assert np.abs(made.profiles(made.eta) - sized).max() < 1e-13
    eta = np.linspace(0.0, 1.0, 33)
    curves = made.splines.fit(made.profiles(eta))
    chord = np.linalg.norm(curves.trailing_edge - curves.leading_edge, axis=-1)
    assert np.abs(chord - 1.0).max() < 1e-14
    assert np.abs(curves.relative_thickness - made.definition.relative_thickness(eta)).max() < 1e-14


def test_cst_fits_the_baselines_as_the_guide_says():
    missed = {name: cst.fit(landmarks(xy))[1] for name, xy in baselines().items()}
    assert min(missed, key=missed.get).endswith("ffaw3301")
    assert max(missed, key=missed.get).endswith("SNL-FFA-W3-500")
    assert_allclose(sorted(missed.values())[:: len(missed) - 1], [5e-5, 1.1e-3], rtol=0.1)


def test_fairing_leaves_points_of_full_digits():
    angle = np.linspace(0.0, 2.0 * np.pi, 391)
    points = oriented(0.5 + 0.5 * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    assert np.abs(fair(points, 1e-5) - points).max() < 1e-12


def test_the_nrel_5_mw_s_root_is_a_circle_to_fewer_digits_than_the_tolerance_has():
    x, y = next(s.airfoil.coordinates for s in bg.read("nrel5mw").stations).T
    fit = np.linalg.lstsq(np.stack([x, y, np.ones_like(x)], axis=1), x**2 + y**2, rcond=None)[0]
    radius = np.sqrt(fit[2] + (fit[:2] ** 2).sum() / 4)
    scatter = np.abs(np.hypot(x - fit[0] / 2, y - fit[1] / 2) - radius).max()
    assert_allclose(scatter, 4.3e-5, rtol=0.02)
    faired = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101, fairing=1e-4)
    assert_shown(combs.figures(faired)[0]["roughness_faired"], "348")


@pytest.mark.parametrize(
    ("name", "at", "share"), [("iea15mw", 0.22, 1.2e-3), ("nrel5mw", 0.14, 6.8e-4)]
)
def test_smooth_paths_overshoot_widths_as_the_page_says(name, at, share):
    made = bg.Blade.from_definition(bg.read(name), path="spline")
    ((eta, excess),) = edge_bulges(replace(made, edge_width=None))
    assert_allclose(eta, at, atol=0.005)
    assert_allclose(excess, share, rtol=0.05)


@pytest.mark.parametrize("path", ["geodesic", "spline"])
@pytest.mark.parametrize("name", bg.bundled())
def test_edges_bend_by_0_08_degrees_at_most_where_the_minimum_begins(name, path):
    made = bg.Blade.from_definition(bg.read(name), path=path, trailing_edge=MinimumThickness(0.002))

    def excess(eta):
        at = np.atleast_1d(eta)
        return edge_widths(made, at) * made.chord(at) - 0.002

    spans = np.linspace(0.0, 1.0, 201)
    over = excess(spans)
    for k in np.flatnonzero(over[:-1] * over[1:] < 0):
        at = brentq(lambda eta: excess(eta)[0], spans[k], spans[k + 1], xtol=1e-13)
        if np.abs(made.eta - at).min() < 1e-6:
            continue
        edges = made.sections(at + 1e-6 * np.array([-1.0, -0.5, 0.0, 0.5, 1.0]))[:, [0, -1]]
        before, after = edges[2] - edges[1], edges[3] - edges[2]
        both = np.linalg.norm(before, axis=-1) * np.linalg.norm(after, axis=-1)
        bend = np.arccos(np.clip(np.sum(before * after, axis=-1) / both, -1.0, 1.0))
        assert np.degrees(bend).max() < 0.08


@pytest.mark.nightly
@pytest.mark.parametrize(
    "row", table("guide.md", "| | largest crease, geodesic |"), ids=lambda row: row[0]
)
def test_creases_and_paths_are_as_the_guide_says(row):
    paths = [blade(row[0], path) for path in ("geodesic", "spline")]
    for made, said in zip(paths, row[1:3], strict=True):
        assert_shown(np.degrees(creases(made)[1].max()), said.removesuffix(" deg"))
    far, place = row[3].split(" mm, at eta ")
    eta = np.linspace(0.0, 1.0, 801)
    apart = np.linalg.norm(paths[1].sections(eta) - paths[0].sections(eta), axis=-1)
    assert_shown(1e3 * apart.max(), far)
    assert eta[np.argmax(apart.max(axis=1))] == pytest.approx(float(place), abs=2e-3)
    assert_shown(1e3 * np.sqrt(np.mean(apart**2)), row[4].removesuffix(" mm"))


@pytest.mark.nightly
@pytest.mark.parametrize(
    "row", table("smoothness.md", "| airfoil | as given"), ids=lambda row: row[0]
)
def test_airfoils_are_as_rough_as_the_page_says(row):
    turbine, airfoil = row[0].split(", ")
    figures = next(f for f in combs.figures(blade(turbine)) if f["airfoil"] == airfoil)
    assert_shown(figures["roughness_given"], row[1])
    assert_shown(figures["roughness_faired"], row[2])


def bundled_rows(page, head):
    return [pytest.param(row, id=" ".join(row[:3])) for row in table(page, head) if row[0] in NAMES]


@pytest.mark.nightly
@pytest.mark.parametrize("row", bundled_rows("smoothness.md", "| | path | bulges"))
def test_bulges_and_inflections_are_as_many_as_the_page_says(row):
    own = blade(row[0], row[1])
    passing = replace(own, edge_width=None)
    found = [len(f(b)) for f in (edge_bulges, inflections) for b in (passing, own)]
    assert found == [int(re.match(r"\d+", cell)[0]) for cell in row[2:6]]


@pytest.mark.nightly
@pytest.mark.parametrize("row", bundled_rows("smoothness.md", "| | largest jump of spanwise"))
def test_planforms_are_as_fair_as_the_page_says(row):
    for how, jumps, varies in ((None, row[1], row[3]), (bg.PlanformFairing(), row[2], row[4])):
        found = fairness(blade(row[0], "spline", fair_planform=how))
        jump, eta = re.fullmatch(r"([\d.]+) \((?:eta = )?([\d.]+)\)", jumps).groups()
        assert_shown(found.jump[0], jump)
        assert_shown(found.jump[1], eta)
        assert_shown(found.spanwise, varies)


@pytest.mark.nightly
@pytest.mark.parametrize("row", bundled_rows("smoothness.md", "| | path | tolerance"))
def test_solids_are_as_the_page_says(row):
    for how, said in zip((None, 1e-5), row[3:5], strict=True):
        poles, _, off = said.split(", ")
        solid = solids.solid(
            blade(row[0], row[1], fairing=how), tolerance=1e-3 * float(row[2].split()[0])
        )
        assert float(f"{solid.net.poles.size / 3:.4g}") == float(poles.replace(",", ""))
        largest, rms = off.split(" / ")
        assert_shown(1e3 * solid.deviation.maximum, largest)
        assert_shown(1e3 * solid.deviation.rms, rms)


@pytest.mark.nightly
@pytest.mark.parametrize("row", bundled_rows("grids.md", "| blade | edge | tip | largest jump"))
def test_grids_are_as_good_as_the_page_says(row):
    made = bg.Blade.from_definition(bg.read(NAMES[row[0]]))  # as `bladegen build` does
    if row[1] == "sharp":
        made = made.with_trailing_edge(Sharp())
    tip = {"flat": flat_tip, "round": round_tip}[row[2]]
    figures = grid_quality.grid_figures(grid.from_blade(made, tip=tip))
    blocks = list(figures["by_block"].values())
    shown = [figures["largest_jump"], figures["median_jump"]]
    for name, worst in (("smallest_scaled_jacobian", min), ("largest_stretching", max)):
        shown += [worst(block[name] for block in part) for part in (blocks[:2], blocks[2:])]
    for value, said in zip(shown, row[3:], strict=True):
        assert_shown(value, said)


@pytest.mark.nightly
@pytest.mark.parametrize("said", NAMES)
def test_volumes_are_those_of_the_sections_as_the_guide_says(said):
    for tolerance in (0.05e-3, 1e-3):
        made = blade(said)
        solid = solids.solid(made, tolerance=tolerance)
        assert_allclose(solid.net.volume(), properties.volume(made), rtol=8e-6)


@pytest.mark.nightly
@pytest.mark.parametrize(("name", "share"), [("dtu10mw", 1.5e-3), ("nrel5mw", 2e-4)])
def test_modes_move_the_edge_s_width_by_no_more_than_the_page_says(name, share):
    made, space = bg.Blade.from_definition(bg.read(name), path="spline"), bg.ShapeSpace.bundled()
    eta = np.linspace(0.0, 1.0, 101)
    ends = 0.5 * np.stack([space.coordinates.min(axis=0), space.coordinates.max(axis=0)])
    anything = {"allow_extrapolation": True, "allow_odd": True}
    variants = [made.perturbed(space, t, **anything) for end in ends for t in np.diag(end)]
    moved = [np.abs(edge_widths(v, eta) - edge_widths(made, eta)).max() for v in variants]
    assert 0.9 * share < max(moved) < 1.025 * share
