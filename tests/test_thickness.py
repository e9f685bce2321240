"""Shape between airfoils where no thickness is given, and the same blade in every format."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.interpolate import PchipInterpolator

import bladegen as bg
from bladegen.definition.blade_definition import Airfoil, BladeDefinition, Distribution, Station
from bladegen.definition.thickness import ruled
from strategies import naca

ETA = np.unique(np.concatenate([np.linspace(0.0, 1.0, 13), np.array([0.0875, 0.213, 0.61])]))
WHOLE = {"windio1": "a.yaml", "windio2": "b.yaml", "csv": "c.csv"}  # a grid for each quantity
ONE_GRID = {"xlsx": "d.xlsx", "hawc2": "e.htc"}


def bare(name: str = "nrel5mw") -> BladeDefinition:
    """A bundled blade without its thickness distribution."""
    return replace(bg.read(name), relative_thickness=None)


def small(*moves: tuple[float, float]) -> BladeDefinition:
    """The NREL 5 MW's planform with four airfoils, moved along their chords and scaled."""
    places = zip((0.0, 0.3, 0.6, 1.0), (0.9, 0.3, 0.2, 0.16), moves, strict=True)
    stations = [
        Station(eta, Airfoil(f"foil {eta}", naca(thick, 0.02, 0.0) * scale + [low, 0.0]))
        for eta, thick, (low, scale) in places
    ]
    return replace(bare(), stations=tuple(stations))


def sections(definition: BladeDefinition):
    return bg.Blade.from_definition(definition).sections(ETA)


PLAIN = (0.0, 1.0)
CENTRED = Distribution(np.array([0.0, 0.25, 1.0]), np.array([0.5, 0.35, 0.3]))
CASES = {
    "pitch axis": replace(small(*[PLAIN] * 4), pitch_axis=CENTRED, section_offset_y=None),
    "offset": small(*[PLAIN] * 4),
    "beyond the chord": small(PLAIN, (-0.004, 1.0), (0.002, 1.001), (-0.001, 1.0)),
}


def apart(one: BladeDefinition, other: BladeDefinition) -> float:
    """The largest distance of equal landmarks [m]."""
    return float(np.linalg.norm(sections(one) - sections(other), axis=-1).max())


def thickness(points) -> float:
    """Largest vertical distance between an airfoil's sides, by PCHIP in x: no code of ours."""
    nose = int(np.argmin(points[:, 0]))
    x = np.linspace(0.02, 0.98, 4_001)
    upper, lower = points[: nose + 1][::-1], points[nose:]
    sides = []
    for side in (upper, lower):
        kept = np.concatenate([[True], np.diff(side[:, 0]) > 0])
        sides.append(PchipInterpolator(*side[kept].T)(x))
    return float(np.max(np.abs(sides[0] - sides[1])))


@pytest.mark.parametrize("name", ["nrel5mw", "iea15mw"])
def test_thickness_is_that_of_the_airfoils_by_pchip(name):
    definition = bare(name)
    blade = bg.Blade.from_definition(definition)
    etas = [station.eta for station in definition.stations]
    own = [thickness(station.airfoil.coordinates) for station in definition.stations]
    wanted = PchipInterpolator(etas, own)(ETA)
    # measured across x, ours normal to the chord line, which differs on open trailing edges
    assert_allclose(blade.relative_thickness(ETA), wanted, rtol=0, atol=4e-3)
    assert np.ptp(wanted) > 0.5


def test_stations_keep_their_airfoils_exactly_at_any_number_of_landmarks():
    definition = bare()
    for landmarks in (101, 201):
        blade = bg.Blade.from_definition(definition, landmarks=landmarks, fairing=None)
        own = blade.representatives @ blade.M + blade.b[:, None]
        chords = blade.splines.fit(own).chord
        assert_allclose(blade.profiles(blade.eta), own / chords[:, None, None], rtol=0, atol=1e-9)


def test_a_rule_that_is_written_is_the_rule():
    definition = CASES["offset"]
    assert ruled(definition).relative_thickness is not None
    assert apart(definition, ruled(definition)) < 1e-9
    given = bg.read("nrel5mw")
    assert ruled(given) is given


@pytest.mark.parametrize("case", ["offset", pytest.param("pitch axis", marks=pytest.mark.nightly)])
def test_a_definition_is_the_same_blade_in_every_pair_of_formats(tmp_path, case):
    definition = CASES[case]
    wanted = sections(definition)
    for source, name in WHOLE.items():
        first, folder = tmp_path / name, tmp_path / source
        folder.mkdir()
        bg.write(definition, first, format=source)
        for target, other in WHOLE.items():
            bg.write(bg.read(first), folder / other, format=target)
            if "csv" in (source, target) and source != target:
                continue  # csv keeps the numbers; the others' way to it is their way to itself
            off = np.linalg.norm(sections(bg.read(folder / other)) - wanted, axis=-1)
            assert off.max() < 1e-6, (source, target)


def test_airfoils_that_windio_moves_stay_where_they_are(tmp_path):
    definition = CASES["beyond the chord"]
    for name, path in list(WHOLE.items())[:2]:
        bg.write(definition, tmp_path / path, format=name)
        made = bg.read(tmp_path / path)
        assert apart(made, definition) < 2e-4, name  # 4e-3 chord are 17 mm
        x = np.concatenate([station.airfoil.coordinates[:, 0] for station in made.stations])
        assert x.min() >= 0.0
        assert x.max() <= 1.0


@pytest.mark.parametrize("source", ONE_GRID)
def test_a_definition_of_one_grid_stays_the_same_blade(tmp_path, source):
    """What a format of one grid resamples once, it keeps from then on."""
    bg.write(CASES["offset"], tmp_path / ONE_GRID[source], format=source)
    first = bg.read(tmp_path / ONE_GRID[source])
    wanted = sections(first)
    for target, name in {**WHOLE, source: ONE_GRID[source]}.items():
        (tmp_path / target).mkdir()
        bg.write(first, tmp_path / target / name, format=target)
        off = np.linalg.norm(sections(bg.read(tmp_path / target / name)) - wanted, axis=-1).max()
        assert off < 1e-6, target
