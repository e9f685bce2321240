"""What a rotor does, as figures by name and as rows of text: a blade beside its baseline."""

from collections.abc import Sequence
from dataclasses import asdict

import numpy as np

from bladegen.blade.aero.energy import HOURS
from bladegen.blade.aero.evaluation import Evaluation, gigawatt_hours, sure
from bladegen.views.tables import digits

__all__ = [
    "conditions_rows",
    "curve_rows",
    "figure_rows",
    "notes_on",
    "rotor_curve",
    "rotor_figures",
]

SHOWN = {  # how a figure is called, and how many decimals it has
    "power_coefficient": ("largest power coefficient", 4),
    "tip_speed_ratio": ("at tip speed ratio", 2),
    "pitch_deg": ("at pitch, deg", 2),
    "thrust_coefficient": ("thrust coefficient there", 4),
    "root_moment_coefficient": ("root moment coefficient there", 4),
    "rated_wind_m_s": ("rated wind speed, m/s", 2),
    "tip_speed_wind_m_s": ("wind at the largest tip speed, m/s", 2),  # if no power is rated
    "root_moment_MNm": ("root moment there, MNm", 2),
    "annual_energy_GWh": ("annual energy, GWh", 2),
    "capacity_factor": ("capacity factor", 4),
    "tip_radius_m": ("tip radius, m", 2),
    "mass_t": ("mass of all layers, t", 3),
    "least_confidence": ("NeuralFoil's least confidence", 2),
}
IF_KNOWN = "rated_wind_m_s", "tip_speed_wind_m_s", "mass_t"  # rows that not every blade has
SPECIFIC_POWER = 50.0, 1000.0  # W/m2 of the disc; turbines in service have 150 to 600
WORKING = {  # how a condition is called, and the factor to what is shown
    "tip_speed": ("largest tip speed, m/s", 1.0),
    "rated_power": ("rated power, MW", 1e-6),
    "efficiency": ("efficiency of the drive train", 1.0),
    "mean_wind": ("mean wind speed, m/s", 1.0),
    "weibull_shape": ("Weibull shape", 1.0),
    "cut_in": ("cut-in, m/s", 1.0),
    "cut_out": ("cut-out, m/s", 1.0),
    "air_density": ("air density, kg/m3", 1.0),
}


def rotor_figures(
    found: Evaluation, row: int, mass: float | None = None
) -> dict[str, float | None]:
    """Return the figures of a rotor, units in their names; None for what is not known.

    `mass` is that of a blade's layers [kg].
    """
    best, rated = found.performance, found.conditions.rated_power
    power, thrust, moment = best.best[row]
    energy = float(found.energy[row])
    figures = {
        "power_coefficient": power,
        "tip_speed_ratio": best.ratio[row],
        "pitch_deg": np.degrees(best.pitch[row]),
        "thrust_coefficient": thrust,
        "root_moment_coefficient": moment,
        "rated_wind_m_s": np.nan if rated is None else found.rated_wind[row],
        "tip_speed_wind_m_s": found.rated_wind[row] if rated is None else np.nan,
        "root_moment_MNm": found.root_moment[row] / 1e6,
        "annual_energy_GWh": gigawatt_hours(found.energy)[row],
        "capacity_factor": np.nan if rated is None else energy / (rated * 3600.0 * HOURS),
        "tip_radius_m": found.elements.tip_radius[row],
        "mass_t": np.nan if mass is None else mass / 1e3,
        "least_confidence": sure(found)[row],
    }
    return {name: float(v) if np.isfinite(v) else None for name, v in figures.items()}


def rotor_curve(found: Evaluation, row: int) -> dict[str, list[float]]:
    """Return coefficients over tip speed ratio at the optimum pitch."""
    best = found.performance
    return {
        "tip_speed_ratio": best.ratios.tolist(),
        "power_coefficient": best.power[row].tolist(),
        "thrust_coefficient": best.thrust[row].tolist(),
        "root_moment_coefficient": best.moment[row].tolist(),
    }


def conditions_rows(found: Evaluation) -> list[list[str]]:
    """Return a row a condition."""
    values = asdict(found.conditions)
    return [
        [said, "not known" if values[field] is None else f"{factor * values[field]:.4g}"]
        for field, (said, factor) in WORKING.items()
    ]


def figure_rows(found: Evaluation, masses: Sequence[float | None]) -> list[list[str]]:
    """Return a row a figure: its name, the baseline's, then the variant's and the change.

    `masses` are those of the blades' layers [kg], None where a blade has none.
    """
    columns = [rotor_figures(found, row, mass) for row, mass in enumerate(masses)]
    absent = {name for name in IF_KNOWN if all(column[name] is None for column in columns)}
    if found.conditions.rated_power is not None:
        absent.discard("rated_wind_m_s")
    rows = []
    for name, (said, decimals) in SHOWN.items():
        if name in absent:
            continue
        values = [column[name] for column in columns]
        row = [said, *("-" if v is None else digits(v, decimals) for v in values)]
        if len(values) > 1:
            row.append(_change(values[0], values[1], name))
        rows.append(row)
    return rows


def notes_on(found: Evaluation) -> list[str]:
    """Return what is to be said of a rated power: that there is none, or that it looks odd."""
    rated, last = found.conditions.rated_power, found.conditions.cut_out
    if rated is None:
        return ["no rated power is known, so no annual energy; give one in MW: --rated-power 10"]
    radius = float(found.elements.tip_radius[0])
    specific = rated / (np.pi * radius**2)
    said = []
    if not SPECIFIC_POWER[0] <= specific <= SPECIFIC_POWER[1]:
        said.append(
            f"rated power: {rated:.4g} W on a rotor of {2.0 * radius:.4g} m are {specific:.3g} "
            "W/m2, turbines have 150 to 600: --rated-power is in MW, windIO's rated_power in W"
        )
    if np.isnan(found.rated_wind).any():
        said.append(f"rated power: is not reached up to the cut-out of {last:g} m/s")
    return said


def _change(before: float | None, after: float | None, name: str) -> str:
    """Return by how much a figure changed: in parts of itself, an angle in degrees."""
    if before is None or after is None:
        return ""
    if name == "pitch_deg":
        return f"{after - before:+.2f}"
    share = round(100.0 * (after / before - 1.0), 2) if before else 0.0
    return f"{share:+.2f} %" if share else "0"


def curve_rows(found: Evaluation) -> list[list[str]]:
    """Return a row a whole tip speed ratio: power and thrust coefficient of each rotor."""
    best = found.performance
    both = np.stack([best.power, best.thrust], axis=1).reshape(-1, len(best.ratios))
    return [
        [f"{ratio:g}", *(f"{value:.4f}" for value in both[:, i])]
        for i, ratio in enumerate(best.ratios)
        if ratio % 1.0 == 0.0
    ]
