"""What labels are called in a dataset, their dimensions, units and axes."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bladegen.blade.aero.performance import RATIOS

__all__ = ["ALPHA", "FIGURES", "LABELS", "REYNOLDS", "STORED", "Figure", "axes", "polar_places"]

ALPHA = np.linspace(-20.0, 20.0, 41)  # deg
REYNOLDS = np.array([1e6, 3e6, 1e7])
POLAR_SECTIONS = 20  # at most, of those that a family stores
ONE = "1"


@dataclass(frozen=True)
class Figure:
    """One figure of a label: its name, dimensions after the variant, meaning and units (CF)."""

    name: str
    long_name: str
    units: str
    dims: tuple[str, ...] = ()


ROTOR = (
    Figure("rotor_power_coefficient", "largest power coefficient over speed ratio and pitch", ONE),
    Figure("rotor_optimum_ratio", "tip speed ratio of the largest power coefficient", ONE),
    Figure("rotor_optimum_pitch", "pitch of the largest power coefficient", "degree"),
    Figure("rotor_thrust_coefficient", "thrust coefficient at that optimum", ONE),
    Figure("rotor_moment_coefficient", "root bending moment coefficient at that optimum", ONE),
    Figure(
        "rotor_rated_wind",
        "wind speed of the rated power, else of the largest tip speed",
        "m s-1",
    ),
    Figure("rotor_root_moment", "root bending moment of one blade in that wind", "N m"),
    Figure("rotor_annual_energy", "energy of a year in the stated Weibull wind", "GW h"),
    Figure("rotor_least_confidence", "NeuralFoil's least confidence between stalls", ONE),
    *(
        Figure(
            f"rotor_{what}_curve",
            f"{what} coefficient over tip speed ratio at the optimum pitch",
            ONE,
            ("tip_speed_ratio",),
        )
        for what in ("power", "thrust", "moment")
    ),
)
MASS = (
    Figure("mass", "mass of the layers", "kg"),
    Figure("mass_centre", "distance of the layers' centre of mass from the root, along z", "m"),
    Figure("mass_per_length", "mass of the layers per length", "kg m-1", ("span",)),
)
POLARS = tuple(
    Figure(f"polar_{name}", said, ONE, ("polar_span", "reynolds", "alpha"))
    for name, said in (
        ("cl", "lift coefficient of the section"),
        ("cd", "drag coefficient of the section"),
        ("cm", "moment coefficient of the section about its quarter chord, nose up"),
        ("confidence", "NeuralFoil's confidence in these coefficients, 0 to 1"),
    )
)
FIGURES = {"polars": POLARS, "rotor": ROTOR, "mass": MASS}
LABELS = tuple(FIGURES)
STORED = tuple(one.name for one in POLARS)  # arrays of the store that no manifest holds


def polar_places(spans: int) -> Any:
    """Return which of so many sections have polars: evenly among them, root and tip included."""
    count = min(spans, POLAR_SECTIONS)
    return np.unique(np.round(np.linspace(0.0, spans - 1.0, count)).astype(np.int64))


def axes(labels: Sequence[str], eta: Any) -> dict[str, tuple[str, Any, str, str]]:
    """Return the axes of labels: by name their dimension, values, meaning and units.

    Parameters
    ----------
    labels : sequence of str
        Those that a dataset has.
    eta : (k,) array
        Span fractions of its sections.
    """
    found: dict[str, tuple[str, Any, str, str]] = {}
    if "rotor" in labels:
        ratio = "tip_speed_ratio"
        found[ratio] = (ratio, RATIOS, "speed of the tip over that of the wind", ONE)
    if "polars" in labels:
        places = polar_places(len(eta))
        found |= {
            "polar_span": ("polar_span", places, "place along span of the section", ONE),
            "polar_eta": ("polar_span", np.asarray(eta)[places], "span fraction", ONE),
            "reynolds": ("reynolds", REYNOLDS, "Reynolds number of the chord", ONE),
            "alpha": ("alpha", ALPHA, "angle of attack, from the chord line", "degree"),
        }
    return found
