"""Plausibility: units and signs that files get wrong are findings, in every reader."""

from dataclasses import replace

import numpy as np
import pytest

import bladegen as bg
from bladegen.definition.blade_definition import Airfoil, Distribution
from bladegen.definition.plausibility import doubts


@pytest.fixture(scope="module")
def blade():
    return bg.read("iea15mw")


def scaled(quantity, factor):
    return replace(quantity, values=factor * quantity.values)


def flipped(definition):
    """The same with all airfoils upside down."""
    return tuple(
        replace(s, airfoil=Airfoil(s.airfoil.name, s.airfoil.coordinates * [1.0, -1.0]))
        for s in definition.stations
    )


CHANGES = {
    "radians": (
        lambda d: {"twist": scaled(d.twist, np.radians(1.0))},
        "twist: reaches 0.27 deg: degrees expected, are these radians (15.6 deg)?",
    ),
    "twist's sign": (
        lambda d: {"twist": scaled(d.twist, -1.0)},
        "twist: is -15.6 deg at the root and 1.89 deg",
    ),
    "large twist": (lambda d: {"twist": scaled(d.twist, 4.0)}, "twist: reaches 62.4 deg"),
    "prebend": (
        lambda d: {"axis": replace(d.axis, x=scaled(d.axis.x, -1.0))},
        "prebend: bends the tip 4 m downwind, toward the tower",
    ),
    "sweep": (
        lambda d: {"axis": replace(d.axis, y=scaled(d.axis.x, 0.5))},
        "sweep: sweeps the tip 2 m toward the leading edge",
    ),
    "offset in chords": (
        lambda d: {
            "section_offset_y": Distribution(
                d.chord.grid, d.offset_y(d.chord.grid) / d.chord.values
            )
        },
        "chord (eta = 0.25): are these fractions of the chord?",
    ),
    "pitch axis in metres": (
        lambda d: {
            "section_offset_y": None,
            "pitch_axis": Distribution(d.chord.grid, d.offset_y(d.chord.grid)),
        },
        ": are these metres?",
    ),
    "a round root off the pitch axis": (
        lambda d: {
            "section_offset_y": None,
            "pitch_axis": Distribution(np.array([0.0, 1.0]), np.array([0.25, 0.25])),
        },
        "pitch axis: 25 % of the chord at the round root puts its centre 1.3 m off the pitch axis",
    ),
    "chord": (
        lambda d: {"chord": scaled(d.chord, 10.0)},
        "chord: reaches 57.6 m on a blade of 117 m, 49 %",
    ),
    "thickness": (
        lambda d: {"relative_thickness": Distribution(np.array([0.0, 1.0]), np.array([0.2, 1.0]))},
        "relative thickness: grows outboard, from 0.2 to 1 at eta = 1",
    ),
    "cone": (
        lambda d: {"rotor": replace(d.rotor, cone=-0.07)},
        "cone: of -4.01 deg leans the tips downwind",
    ),
    "upside down": (lambda d: {"stations": flipped(d)}, "bends to the pressure side, by "),
}


@pytest.mark.parametrize("name", bg.bundled())
def test_published_blades_raise_no_doubt(name):
    assert doubts(bg.read(name)) == ()


@pytest.mark.parametrize("change", CHANGES)
def test_what_looks_odd_is_said_with_figures(blade, change):
    changes, said = CHANGES[change]
    found = " | ".join(map(str, doubts(replace(blade, **changes(blade)))))
    assert said in found


def test_files_in_radians_are_asked_another_question(blade):
    small = replace(blade, twist=scaled(blade.twist, np.radians(1.0)))
    assert "0.0048 rad in the file, was it converted twice?" in str(doubts(small, radians=True)[0])


@pytest.mark.parametrize("name", ["blade.yaml", "blade.csv", "blade.htc", "one.yaml"])
def test_every_reader_says_it_and_none_refuses(tmp_path, blade, name):
    wrong = replace(
        blade,
        twist=scaled(blade.twist, np.radians(1.0)),
        axis=replace(blade.axis, x=scaled(blade.axis.x, -1.0)),
    )
    bg.write(wrong, tmp_path / name, format="windio1" if name == "one.yaml" else None)
    said = [finding.where for finding in bg.read(tmp_path / name).findings]
    assert {"twist", "prebend"} <= set(said)
