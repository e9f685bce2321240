"""Figures as rows of text: what the command line and notebooks show of a blade."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from bladegen.definition.blade_definition import Airfoil, BladeDefinition, Distribution
from bladegen.support.arrays import Array

if TYPE_CHECKING:
    from bladegen.blade.layup.layup import Layup
    from bladegen.shapes.shape_space import ShapeSpace

__all__ = [
    "definition_figures",
    "digits",
    "layer_rows",
    "layup_figures",
    "megabytes",
    "report_rows",
    "shown",
    "space_figures",
    "space_rows",
    "station_rows",
    "volume_rows",
]


SHOWN_DIRECTIONS = 12
SKEWED, STEEP = 4.0, 70.0  # OpenFOAM's checkMesh: skewness, and degrees, that it remarks on
LEAST_DIGITS = 4  # of a figure that is not zero


def digits(value: float, decimals: int) -> str:
    """Return a figure with so many decimals, and more where it would lose its digits.

    >>> digits(64.2421, 2), digits(0.0072, 2), digits(1.3731e-5, 4), digits(0.0, 2)
    ('64.24', '0.007200', '1.373e-05', '0.00')
    """
    if value == 0.0 or abs(value) >= 10.0 ** (LEAST_DIGITS - 1 - decimals):
        return f"{value:.{decimals}f}"
    return f"{value:#.{LEAST_DIGITS}g}"


def megabytes(size: int) -> str:
    """Return a file's size: MB, or kB where that is less than a tenth of one.

    >>> megabytes(1_850_000), megabytes(14_200), megabytes(80)
    ('1.9 MB', '14.2 kB', '0.1 kB')
    """
    return f"{size / 1e6:.1f} MB" if size >= 1e5 else f"{max(size, 50) / 1e3:.1f} kB"


def definition_figures(definition: BladeDefinition) -> dict[str, Any]:
    """Return what a definition holds, in metres and degrees.

    Taken at the definition's own grid points, between which monotone splines do not rise
    above or fall below them; nothing is interpolated, so this is quick.
    """
    chord, twist, axis = definition.chord, definition.twist, definition.axis
    thickest = int(np.argmax(chord.values))
    rotor = definition.rotor
    return {
        "blade": definition.name,
        "description": definition.description,
        "source": definition.source,
        "length_m": float(axis.z.values[-1] - axis.z.values[0]),
        "root_chord_m": float(chord.values[0]),
        "largest_chord_m": float(chord.values[thickest]),
        "largest_chord_at_eta": float(chord.grid[thickest]),
        "tip_chord_m": float(chord.values[-1]),
        "root_twist_deg": float(np.degrees(twist.values[0])),
        "tip_twist_deg": float(np.degrees(twist.values[-1])),
        "tip_prebend_m": float(axis.x.values[-1]),
        "tip_sweep_m": float(axis.y.values[-1]),
        "thickness_distribution": definition.relative_thickness is not None,
        "hub_radius_m": rotor.hub_radius,
        "rotor_diameter_m": rotor.diameter,
        "blades": rotor.blades,
        "cone_deg": None if rotor.cone is None else float(np.degrees(rotor.cone)),
        "tilt_deg": None if rotor.tilt is None else float(np.degrees(rotor.tilt)),
        "stations": [
            {"eta": station.eta, "airfoil": station.airfoil.name} for station in definition.stations
        ],
        "findings": [str(finding) for finding in definition.findings],
    }


def station_rows(
    definition: BladeDefinition, own: Callable[[Airfoil], float] | None = None
) -> list[list[str]]:
    """Return a row a station: eta, z, airfoil, chord, twist, thickness, if none is given `own`."""
    eta = np.array([station.eta for station in definition.stations])
    z, chord = _between(definition.axis.z, eta), _between(definition.chord, eta)
    twist = np.degrees(_between(definition.twist, eta))
    thickness = definition.relative_thickness
    if thickness is not None:
        ratios = _between(thickness, eta)
    else:
        ratios = np.array([np.nan if own is None else own(s.airfoil) for s in definition.stations])
    return [
        [
            f"{station.eta:.4f}",
            digits(round(z[i], 9) + 0.0, 2),
            station.airfoil.name,
            digits(chord[i], 3),
            f"{twist[i]:.2f}",
            "" if np.isnan(ratios[i]) else f"{ratios[i]:.3f}",
        ]
        for i, station in enumerate(definition.stations)
    ]


def _between(quantity: Distribution, eta: Array) -> Array:
    """Interpolate linearly: enough for three digits on the screen, without loading scipy."""
    return np.interp(eta, quantity.grid, quantity.values)


def layup_figures(layup: "Layup") -> dict[str, Any]:
    """Return what lies inside the skin, and what it weighs by its layers alone."""
    structure, masses = layup.structure, layup.layer_masses
    return {
        "structure_mass_kg": layup.mass,
        "structure_centre_z_m": float(layup.centre[2]),
        "webs": [web.name for web in structure.webs],
        "materials": [
            {"name": name, "mass_kg": mass} for name, mass in layup.material_masses.items()
        ],
        "layers": [
            {
                "name": layer.name,
                "material": layer.material,
                "web": layer.web,
                "thickest_mm": 1e3 * float(layer.thickness.values.max()),
                "from_eta": layer.extent[0],
                "to_eta": layer.extent[1],
                "mass_kg": masses[layer.name],
            }
            for layer in structure.layers
        ],
    }


def layer_rows(figures: dict[str, Any]) -> list[list[str]]:
    """Return a row a layer of `layup_figures`: name, material, where, span, thickness, mass."""
    return [
        [
            layer["name"],
            layer["material"],
            layer["web"] or "skin",
            f"{layer['from_eta']:.3g} to {layer['to_eta']:.3g}",
            digits(layer["thickest_mm"], 1),
            f"{layer['mass_kg']:.0f}",
        ]
        for layer in figures["layers"]
    ]


def report_rows(report: dict[str, Any]) -> list[list[str]]:
    """Return the main figures of a build report."""
    figures = report["figures"]
    mass = figures.get("structure_mass_kg")
    mirrored = report["settings"].get("mirrored", False)
    rows = [
        *([["mirror image", "yes, its trailing edge lies at -y"]] if mirrored else []),
        ["length", f"{digits(figures['length_m'], 3)} m"],
        ["volume by its sections", f"{digits(figures['volume_m3'], 4)} m3"],
        *([] if mass is None else [["mass of all layers", f"{mass:.0f} kg"]]),
        ["stations missed by", f"{figures['stations_missed_by_chord']:.1e} chord"],
        ["airfoils off their points by", f"{figures['airfoils_moved_by_chord']:.1e} chord"],
        ["chord off its spline by", f"{figures['chord_error_relative']:.1e}"],
        ["twist off its spline by", f"{figures['twist_error_deg']:.1e} deg"],
    ]
    if figures["thickness_error"] is not None:
        rows.append(["thickness off its spline by", f"{figures['thickness_error']:.1e} chord"])
    if figures["edge_adds_volume"]:
        added = f"{digits(100 * figures['edge_adds_volume'], 3)} % of the volume"
        rows.append(["trailing edge adds", added])
    if figures["crease_at_eta"] is not None:
        crease = f"{figures['crease_deg']:.2f} deg at eta = {figures['crease_at_eta']:.3f}"
        rows.append(["largest crease", crease])
    if "solid" in report:
        solid = report["solid"]
        deviation = solid["deviation_mm"]
        sound = "valid" if solid["valid"] else "invalid"
        closed = "closed" if solid["closed"] else "open"
        rows += [
            ["solid", f"{solid['solids']} {sound}, {closed}, {solid['faces']} faces"],
            [
                "solid off the blade by",
                f"{digits(deviation['maximum'], 3)} mm at most, on the {deviation['on_face']}",
            ],
            ["", f"{digits(deviation['rms'], 4)} mm RMS"],
            ["solid's volume", f"{digits(solid['volume_m3'], 4)} m3"],
        ]
        tip = solid["tip_volume_m3"]
        if tip:
            rows.append(["of it in its tip", f"{digits(tip, 4)} m3"])
        off = f"{solid['volume_against_sections']:.1e}"
        rows += [
            ["without its tip off by" if tip else "off its sections' by", off],
            ["volume change on reading", f"{solid['volume_change_on_reading']:.1e}"],
        ]
    for suffix, figures_ in report.get("meshes", {}).items():
        sound = "watertight" if figures_["watertight"] else "not watertight"
        rows.append([f"{suffix} mesh", f"{figures_['triangles']} triangles, {sound}"])
    if "grid" in report:
        grid = report["grid"]
        gap = grid["interface_gap_m"]
        matches = "match point to point" if gap == 0 else f"are {gap:.1e} m apart"
        rows += [
            ["grid", f"{grid['cells']} cells in {grid['blocks']} blocks, which {matches}"],
            ["grid's worst skewness", f"{grid['worst_skewness']:.2f} of 1"],
            ["grid's folded cells", str(grid["folded_cells"])],
            ["grid's smallest scaled Jacobian", f"{grid['smallest_scaled_jacobian']:.2f} of 1"],
            ["grid's largest stretching", f"{grid['largest_stretching']:.2f} from cell to cell"],
            [
                "grid's largest jump",
                f"{grid['largest_jump']:.3g} across blocks' edges, "
                f"median {grid['median_jump']:.3g}",
            ],
            ["grid's smallest cell", f"{grid['smallest_cell_m2'] * 1e6:.3g} mm2"],
        ]
    if "volume" in report:
        rows += volume_rows(report["volume"])
    rows.append(["time", f"{sum(report['seconds'].values()):.1f} s"])
    return rows


def volume_rows(volume: dict[str, Any]) -> list[list[str]]:
    """Return the main figures of a volume: cells, heights, and quality as checkMesh has it."""
    away, first = volume["distance_m"], volume["first_height_m"][0]
    number = volume.get("reynolds")
    by = "" if number is None else f", by y+ at a Reynolds number of {number:.3g}"
    skewed, leaning = volume["largest_skewness"], volume["largest_non_orthogonality_deg"]
    where = "{:.2g} m off {}".format(*volume["largest_skewness_at"])
    beyond = f", above the {SKEWED:g} that checkMesh allows, {where}" if skewed > SKEWED else ""
    return [
        ["volume", f"{volume['cells']} cells in {volume['layers']} layers"],
        ["volume's first cells", f"{digits(1e3 * first, 3)} mm high{by}"],
        ["volume reaches", f"{away['least']:.3g} to {away['largest']:.3g} m off the wall"],
        ["volume's folded cells", str(volume["cells_not_positive"])],
        [
            "volume's smallest scaled Jacobian",
            f"{volume['smallest_scaled_jacobian']:.2f} of 1, less than "
            f"{volume['scaled_jacobian_of_a_thousandth']:.2f} in a thousandth of cells",
        ],
        [
            "volume's non-orthogonality",
            f"{volume['mean_non_orthogonality_deg']:.1f} deg in the mean, {leaning:.1f} at most, "
            f"above {STEEP:g} at {volume['faces_over_70_deg']} faces",
        ],
        ["volume's largest skewness", f"{skewed:.1f}{beyond}"],
        ["volume's largest growth", f"{volume['largest_growth']:.2f} from layer to layer"],
    ]


def shown(value: Any) -> str:
    """Return a figure as text: six digits, yes or no, lists on one line."""
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list):
        parts = (f"({shown(item)})" if isinstance(item, list) else shown(item) for item in value)
        return ", ".join(parts)
    return str(value)


def space_figures(space: "ShapeSpace") -> dict[str, Any]:
    """Return what a shape space holds."""
    return {
        "about": space.about,
        "shapes": len(space.coordinates),
        "landmarks": len(space.u),
        "modes": space.dimension,
        "variance_ratio": [float(value) for value in space.variance_ratio[:SHOWN_DIRECTIONS]],
        "lower": space.lower.tolist(),
        "upper": space.upper.tolist(),
    }


def space_rows(space: "ShapeSpace") -> list[list[str]]:
    """Return a row a principal direction: variance, and the range of the modes kept."""
    ratio = 100.0 * space.variance_ratio[:SHOWN_DIRECTIONS]
    kept = space.dimension
    return [
        [
            str(k + 1),
            f"{ratio[k]:.2f}",
            f"{ratio[: k + 1].sum():.2f}",
            f"{space.lower[k]:.4f}" if k < kept else "",
            f"{space.upper[k]:.4f}" if k < kept else "",
        ]
        for k in range(len(ratio))
    ]
