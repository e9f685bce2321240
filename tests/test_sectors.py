"""Sections in sectors along the chord, and beam properties of them by WISDEM's PreComp."""

import csv
import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.blade.edges import MinimumThickness
from bladegen.blade.layup.sectors import sectors
from bladegen.definition.structure.positions import Arc, PlaneCut, Shifted

constant = bg.Distribution.constant
ETA = np.array([0.05, 0.2, 0.5, 0.8])
STEEL = bg.Material("steel", 7800.0, (2e11,) * 3, None, (0.3,) * 3)
RADIUS, LENGTH, WALL = 1.0, 40.0, 0.02  # m
GOLDEN = Path(__file__).parent / "golden" / "iea15mw" / "elastodyn_blade.csv"


def published():
    """ElastoDyn's table of the IEA 15 MW: span, pitch axis, twist, mass, flap, edge."""
    with GOLDEN.open(newline="") as stream:
        return np.array([[*map(float, row)] for row in [*csv.reader(stream)][1:]])


def tube():
    """A straight round tube of steel."""
    angle = np.linspace(0.0, 2.0 * np.pi, 121)
    circle = np.stack([0.5 + 0.5 * np.cos(angle), 0.5 * np.sin(angle)], axis=-1)
    foil, zero = bg.Airfoil("circle", circle, 1.0), constant(0.0)
    wall = bg.Layer("wall", "steel", constant(WALL), Arc(zero), Arc(constant(1.0)))
    definition = bg.BladeDefinition(
        name="tube",
        stations=(bg.Station(0.0, foil), bg.Station(1.0, foil)),
        chord=constant(2.0 * RADIUS),
        twist=zero,
        axis=bg.ReferenceAxis(zero, zero, bg.Distribution([0.0, 1.0], [0.0, LENGTH])),
        pitch_axis=constant(0.5),
        structure=bg.Structure((STEEL,), (), (wall,)),
    )
    return bg.Blade.from_definition(definition, landmarks=201)


@pytest.fixture(scope="module")
def plain():
    return bg.Blade.from_definition(bg.read("iea15mw"), landmarks=201)


@pytest.fixture(scope="module")
def wrapped(plain):
    """A blade with a wide trailing edge, a layer around it, and a web."""
    wide = constant(0.8)
    ends = Shifted(Arc(constant(1.0)), wide, -0.5), Shifted(Arc(constant(0.0)), wide, 0.5)
    whole = Arc(constant(0.0)), Arc(constant(1.0))
    web = bg.Web("web", *(PlaneCut(side, constant(0.2)) for side in ("suction", "pressure")))
    layers = (
        bg.Layer("skin", "steel", constant(0.01), *whole),
        bg.Layer("edge", "steel", constant(0.02), *ends),
        bg.Layer("wall", "steel", constant(0.03), *whole, web="web"),
    )
    structure = bg.Structure((STEEL,), (web,), layers)
    return bg.Blade.from_definition(
        replace(plain.definition, structure=structure),
        landmarks=201,
        trailing_edge=MinimumThickness(0.5, 0.08),
    )


def lengths(outline, places):
    """Lengths of a side of an outline between places along the chord, by its points."""
    steps = np.linalg.norm(np.diff(outline, axis=0), axis=-1)
    along = np.append(0.0, np.cumsum(steps))
    return np.diff(np.interp(places, np.maximum.accumulate(outline[:, 0]), along))


@pytest.mark.parametrize("which", ["plain", "wrapped"])
def test_sectors_weigh_what_the_layers_weigh(which, request):
    layup = request.getfixturevalue(which).layup
    structure, laid = layup.structure, layup.at(ETA)
    density = [structure.by_name[layer.material].density for layer in structure.layers]
    for k, one in enumerate(sectors(layup, ETA)):
        front = int(np.argmin(one.outline[:, 0]))
        weight = 0.0
        sides = (one.outline[front::-1], one.upper), (one.outline[front:], one.lower)
        for outline, (places, stacks) in sides:
            assert (np.diff(places) > 0.0).all()
            assert (places[0], places[-1], len(stacks)) == (0.0, 1.0, len(places) - 1)
            for long, stack in zip(one.chord * lengths(outline, places), stacks, strict=True):
                weight += long * sum(density[i] * t for i, t, _ in stack)
        for place, stack in one.walls:
            ends = [np.interp(place, *side[0].T) for side in sides]
            weight += one.chord * (ends[0] - ends[1]) * sum(density[i] * t for i, t, _ in stack)
        assert_allclose(weight, laid.mass_per_length[k], rtol=0.01)
        assert_allclose(one.nose, np.interp(one.eta, *published()[:, :2].T), atol=0.01)


def test_a_layer_around_the_trailing_edge_is_behind_on_both_sides_and_on_it(wrapped):
    for one in sectors(wrapped.layup, ETA):
        for places, stacks in (one.upper, one.lower):
            assert [i for i, *_ in stacks[-1]] == [0, 1]
            assert [i for i, *_ in stacks[0]] == [0]
            assert places[-2] < 1.0
        (_, web), (behind, edge) = one.walls
        assert [i for i, *_ in web] == [2]
        assert behind == 1.0
        assert edge == ((0, 0.01, 0.0), (1, 0.02, 0.0))


def test_without_wisdem_the_adapter_says_what_to_install():
    code = "import sys; sys.modules['wisdem'] = None; import bladegen.wisdem"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert "this needs wisdem" in told.stderr
    assert "pip install 'bladegen[wisdem]'" in told.stderr


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """What PreComp finds, in an environment that has WISDEM without its hundred packages."""
    folder = tmp_path_factory.mktemp("precomp")
    subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    (own,) = folder.glob("lib/python3*/site-packages")
    ours = [str(Path(bg.__file__).parent.parent), *(p for p in sys.path if "site-packages" in p)]
    own.joinpath("ours.pth").write_text("\n".join(ours))
    python = folder / "bin" / "python"
    pip = [python, "-m", "pip", "install", "--quiet", "--no-deps", "wisdem==4.2.9"]
    subprocess.run(pip, check=True)
    script = [python, Path(__file__).with_name("precomp.py")]
    told = subprocess.run(script, capture_output=True, text=True, check=True).stdout
    return json.loads(told)


@pytest.mark.nightly
def test_a_tube_is_the_beam_that_it_is(found):
    made = {name: np.array(values) for name, values in found["tube"].items() if name[0] not in "e"}
    middle = RADIUS - 0.5 * WALL
    area, second = 2.0 * np.pi * middle * WALL, np.pi * middle**3 * WALL
    assert_allclose(made["mass"], 7800.0 * area, rtol=0.02)
    assert_allclose(made["axial"], 2e11 * area, rtol=0.02)
    assert_allclose([made["flap"], found["tube"]["edge"]], 2e11 * second, rtol=0.03)
    assert_allclose(made["torsion"], 2e11 / 2.6 * 2.0 * second, rtol=0.03)
    stiffness = made["stiffness"]
    assert_allclose(stiffness, np.swapaxes(stiffness, 1, 2), rtol=1e-9, atol=1.0)
    assert_allclose(stiffness[:, 2:, 2:][:, [0, 0, 1], [1, 2, 2]], 0.0, atol=0.01 * 2e11 * second)


@pytest.mark.nightly
def test_the_iea_15_mw_is_the_published_beam(found, plain):
    """ElastoDyn's table was made by PreComp of an older WISDEM, on sections of its own."""
    made = {name: np.array(found["iea15mw"][name]) for name in ("eta", "mass", "flap", "edge")}
    laid = plain.layup.at(made["eta"])
    assert_allclose(made["mass"], laid.mass_per_length, rtol=0.005)
    rows, inner = published(), slice(1, -1)
    for name, column, near in (("mass", 3, 0.05), ("flap", 4, 0.16), ("edge", 5, 0.08)):
        wanted = np.interp(made["eta"], rows[:, 0], rows[:, column])
        assert_allclose(made[name][inner], wanted[inner], rtol=near, err_msg=name)
        assert_allclose(np.median(made[name] / wanted), 1.0, atol=0.03)
    table = found["iea15mw"]["elastodyn"].splitlines()[2:]
    again = np.array([[*map(float, row.split())] for row in table])
    assert_allclose(again[:, 3], made["mass"], rtol=1e-8)
    figures = [float(word) for word in found["iea15mw"]["beamdyn"].split()]
    assert len(figures) == 73 * len(made["eta"])
    matrices = np.array(figures).reshape(-1, 73)
    assert_allclose(matrices[:, 37], made["mass"], rtol=1e-8)  # its first entry of inertia
