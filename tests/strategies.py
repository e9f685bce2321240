"""Hypothesis strategies: points and tangents of Gr(n, 2), rotations, airfoils, definitions."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from scipy.interpolate import make_interp_spline

from bladegen.definition.blade_definition import (
    Airfoil,
    BladeDefinition,
    Distribution,
    ReferenceAxis,
    Station,
)
from bladegen.formats.bundled import bundled
from bladegen.formats.reading import read
from bladegen.shapes import grassmann
from bladegen.support.arrays import Array, readonly
from bladegen.surface.net import SurfaceNet

STEADY = settings.default.max_examples < 20  # `make test`, as opposed to `make test-all`
SEEDS = st.integers(0, 2**32 - 1)
SIZES = st.integers(5, 40)
MODERATE = 1.2  # rad; principal angles stay below 90 degrees


def few(most: int) -> int:
    """How many examples to draw of what is slow: a third of the most in `make test`."""
    return max(1, most // 3) if STEADY else most


def by_day(*names: str) -> list:
    """The bundled blades for a test that is slow: these in `make test`, the others at night."""
    night = pytest.mark.nightly
    return [name if name in names else pytest.param(name, marks=night) for name in bundled()]


def random_points(rng: np.random.Generator, count: int, n: int) -> Array:
    """Points in general position."""
    return np.linalg.qr(rng.normal(size=(count, n, 2))).Q


def random_tangent(rng: np.random.Generator, X: Array, size: float) -> Array:
    """A tangent vector at X with a largest principal angle of `size`."""
    V = rng.normal(size=X.shape)
    D = V - X @ (X.mT @ V)
    return size * D / np.linalg.norm(D, ord=2, axis=(-2, -1), keepdims=True)


@st.composite
def points(draw: st.DrawFn, count: int = 1) -> Array:
    """(count, n, 2) points within 1.2 rad of the first, read-only."""
    rng = np.random.default_rng([1, draw(SEEDS)])  # never the stream of a test's own seed
    first = random_points(rng, 1, draw(SIZES))
    size = draw(st.floats(0.0, MODERATE))
    others = [grassmann.exp(first, random_tangent(rng, first, size)) for _ in range(count - 1)]
    turns = np.linalg.qr(rng.normal(size=(count, 2, 2))).Q
    return readonly(np.concatenate([first, *others]) @ turns)


@st.composite
def tangents(draw: st.DrawFn, X: Array, *, size: float = 1.0) -> Array:
    """A tangent vector at X, read-only."""
    return readonly(random_tangent(np.random.default_rng(draw(SEEDS)), X, size))


@st.composite
def rotations(draw: st.DrawFn, *, proper: bool = False) -> Array:
    """An orthogonal 2 x 2 matrix; a rotation if `proper`."""
    angle = draw(st.floats(-np.pi, np.pi))
    c, s = np.cos(angle), np.sin(angle)
    mirror = 1.0 if proper else draw(st.sampled_from([1.0, -1.0]))
    return readonly(np.array([[c, -s], [s, c]]) @ np.diag([1.0, mirror]))


@st.composite
def maps(draw: st.DrawFn) -> Array:
    """A linear map with positive determinant, not too thin."""
    angle, turn = draw(st.floats(-3.0, 3.0)), draw(st.floats(-3.0, 3.0))
    a, b = draw(st.floats(0.1, 10.0)), draw(st.floats(0.1, 10.0))
    first = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    second = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    return readonly(first @ np.diag([a, b]) @ second)


def four_digit(x: Array, thickness: float, camber: float) -> tuple[Array, Array]:
    """Half thickness and camber of a NACA four-digit section with a closed edge.

    Abbott & von Doenhoff, Theory of Wing Sections, sections 6.4 and 6.5; the last
    coefficient is the usual one for a closed trailing edge.
    """
    half = 5 * thickness * np.polyval([-0.1036, 0.2843, -0.3516, -0.1260, 0.0], x)
    half += 5 * thickness * 0.2969 * np.sqrt(x)
    return half, 4 * camber * x * (1 - x)


@st.composite
def airfoils(draw: st.DrawFn) -> Array:
    """(m, 2) airfoil coordinates: any density, order and trailing edge, read-only."""
    m = draw(st.integers(30, 150))
    thickness, camber = draw(st.floats(0.08, 0.5)), draw(st.floats(0.0, 0.06))
    gap = draw(st.sampled_from([0.0, 0.003, 0.03]))
    x = 0.5 * (1 - np.cos(np.linspace(0, np.pi, m)))
    half, middle = four_digit(x, thickness, camber)
    half = half + 0.5 * gap * x
    upper, lower = np.stack([x, middle + half], 1), np.stack([x, middle - half], 1)
    xy = np.concatenate([upper[::-1], lower[1:]])
    return readonly(xy[::-1] if draw(st.booleans()) else xy)


def circle(count: int = 101) -> Array:
    """(count, 2) points on the circle of unit chord, closed."""
    angle = np.linspace(0.0, 2 * np.pi, count)
    return np.stack([0.5 + 0.5 * np.cos(angle), 0.5 * np.sin(angle)], axis=1)


def ellipse(thickness: float, count: int = 201) -> Array:
    """(count, 2) points on an ellipse of unit chord, closed."""
    return circle(count) * [1.0, thickness]


def net_through(sections: Array, u: Array, v: Array) -> SurfaceNet:
    """The bicubic C2 net through sections (k, n, 3)."""
    across = make_interp_spline(u, sections, axis=1)
    along = make_interp_spline(v, np.moveaxis(across.c, 0, 1), axis=0)
    return SurfaceNet(np.moveaxis(along.c, 0, 1), across.t, along.t)


def box(count: int, higher: Array) -> Array:
    """(k, count, 2) blunt sections, suction sides `higher` (k,) than the pressure sides'.

    Each is farthest from its edge at two corners; landmarks stand at evenly spaced parameters.
    """
    angle = np.linspace(0.0, 2.0 * np.pi, count)
    x, y = np.cos(angle), np.sin(angle)
    x, y = 0.5 + 0.5 * np.sign(x) * np.abs(x) ** 0.6, 0.6 * np.sign(y) * np.abs(y) ** 0.6
    y = y * (1.0 + higher[:, None] * (y > 0))
    return np.stack([np.broadcast_to(x, y.shape), y], axis=-1)


def naca(thickness: float, camber: float, gap: float, m: int = 81) -> Array:
    """(2 m - 1, 2) four-digit airfoil with an open edge, suction side first."""
    x = 0.5 * (1 - np.cos(np.linspace(0, np.pi, m)))
    half, middle = four_digit(x, thickness, camber)
    half = half + 0.5 * gap * x
    upper, lower = np.stack([x, middle + half], 1), np.stack([x, middle - half], 1)
    return np.concatenate([upper[::-1], lower[1:]])


@st.composite
def definitions(draw: st.DrawFn, *, thickness: bool | None = None) -> BladeDefinition:
    """A small blade: a circle, its repetition, and two or three airfoils; own grids."""
    round_ = Airfoil("circle", circle())
    others = [
        Airfoil(f"foil{i}", naca(t, draw(st.floats(0.0, 0.05)), draw(st.sampled_from([0.0, 0.01]))))
        for i, t in enumerate((0.4, 0.25, 0.18)[: draw(st.integers(2, 3))])
    ]
    first = draw(st.floats(0.02, 0.1))
    places = np.linspace(0.25, 1.0, len(others))
    stations = [Station(0.0, round_), Station(first, round_)]
    stations += [Station(float(eta), foil) for eta, foil in zip(places, others, strict=True)]
    length, root = draw(st.floats(20.0, 120.0)), draw(st.floats(1.0, 5.0))

    def over(*values: float) -> Distribution:
        return Distribution(np.linspace(0.0, 1.0, len(values)), np.array(values))

    bend, sweep = draw(st.floats(-0.05, 0.05)), draw(st.floats(-0.05, 0.05))
    axis = ReferenceAxis(
        over(0.0, 0.2 * bend * length, bend * length),
        over(0.0, 0.1 * sweep * length, sweep * length),
        over(0.0, 0.4 * length, length),
    )
    with_thickness = draw(st.booleans()) if thickness is None else thickness
    ratios = np.array([1.0, 1.0, *(0.4, 0.25, 0.18)[: len(others)]])
    distribution = Distribution(np.array([s.eta for s in stations]), ratios)
    return BladeDefinition(
        name="drawn",
        stations=tuple(stations),
        chord=over(root, 1.2 * root, 0.9 * root, 0.5 * root, 0.2 * root),
        twist=over(draw(st.floats(-0.1, 0.3)), 0.1, draw(st.floats(-0.1, 0.1))),
        axis=axis,
        pitch_axis=over(0.5, 0.35, 0.3),
        relative_thickness=distribution if with_thickness else None,
    )


@cache
def tenth(name: str = "nrel5mw") -> BladeDefinition:
    """A bundled blade at a tenth of its size, all quantities on the grid of its stations.

    Its airfoils and their names are those of the whole blade; OpenFAST's files of it have 20
    nodes, not a hundred.
    """
    whole = read(name)
    grid = np.array([station.eta for station in whole.stations])

    def on(quantity: Distribution, factor: float = 0.1) -> Distribution:
        return Distribution(grid, factor * quantity(grid))

    thickness, behind = whole.relative_thickness, whole.section_offset_y
    return replace(
        whole,
        chord=on(whole.chord),
        twist=on(whole.twist, 1.0),
        axis=ReferenceAxis(on(whole.axis.x), on(whole.axis.y), on(whole.axis.z)),
        relative_thickness=None if thickness is None else on(thickness, 1.0),
        section_offset_y=None if behind is None else on(behind),
    )
