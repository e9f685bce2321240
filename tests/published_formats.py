"""Published figures in the layouts of other tools, as files that these tools would read."""

import csv
from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator

from bladegen.support.arrays import Array

GOLDEN = Path(__file__).parent / "golden"


def rows(table: str) -> list[dict[str, str]]:
    """The rows of a golden table, as printed."""
    with (GOLDEN / f"{table}.csv").open(newline="") as stream:
        return list(csv.DictReader(stream))


def column(table: str, name: str) -> Array:
    """A column of a golden table."""
    return np.array([float(row[name]) for row in rows(table)])


def openfast(folder: Path) -> Path:
    """The IEA 15 MW's AeroDyn blade file, and a main input that lists its airfoils.

    The coordinate files hold the airfoil of the nearest station inboard, and as reference point
    the aerodynamic centre that the turbine's own tools put there: PCHIP of the airfoils' own.
    """
    blade = rows("iea15mw/openfast_blade")
    centre = {row["airfoil"]: row["aerodynamic_center_xc"] for row in rows("iea15mw/airfoil_list")}
    schedule = rows("iea15mw/airfoil_schedule")
    at = np.array([float(row["span_fraction"]) for row in schedule])
    own = np.array([float(centre[row["airfoil"]]) for row in schedule])
    span = column("iea15mw/openfast_blade", "bl_spn_m")
    eta = span / span[-1]
    references = PchipInterpolator(at, own)(eta)
    airfoils = folder / "Airfoils"
    airfoils.mkdir()
    for k, (place, x) in enumerate(zip(eta.tolist(), references.tolist(), strict=True)):
        name = schedule[max(int(np.searchsorted(at, place, side="right")) - 1, 0)]["airfoil"]
        points = rows(f"iea15mw/airfoils/{name}")
        lines = [f"{len(points) + 1} NumCoords ! and the reference", "! x/c y/c", f"{x!r} 0"]
        lines += ["! shape", *(f" {row['x']} {row['y']}" for row in points)]
        (airfoils / f"AF{k:02d}_Coords.txt").write_text("\n".join(lines))
        polar = [f'@"AF{k:02d}_Coords.txt"  NumCoords ! file of coordinates', "1 NumTabs"]
        (airfoils / f"Polar_{k:02d}.dat").write_text("\n".join(polar))
    names = [f'"Airfoils/Polar_{k:02d}.dat"' for k in range(len(blade))]
    main = ["------ AERODYN INPUT FILE ------", f"{len(names)} NumAFfiles", f"{names[0]} AFNames"]
    main += [*names[1:], "True UseBlCm", '"blade.dat" ADBlFile(1)', '"blade.dat" ADBlFile(2)']
    (folder / "AeroDyn15.dat").write_text("\n".join(main))
    table = [" ".join(row.values()) for row in blade]
    head = ["--- AERODYN v15.00.* BLADE DEFINITION INPUT FILE ---", "IEA 15 MW", "== Properties =="]
    head += [f"{len(blade)} NumBlNds - Number of blade nodes used in the analysis (-)"]
    head += [
        "BlSpn BlCrvAC BlSwpAC BlCrvAng BlTwist BlChord BlAFID",
        "(m) (m) (m) (deg) (deg) (m) (-)",
    ]
    (folder / "blade.dat").write_text("\n".join([*head, *table]))
    return folder / "blade.dat"


def hawc2(folder: Path, turbine: str) -> Path:
    """A turbine's c2_def in an htc file of the usual folders, its ae file beside in data/."""
    (folder / "htc").mkdir()
    (folder / "data").mkdir()
    sections = [
        f"      sec {k + 1} {row['x_m']} {row['y_m']} {row['z_m']} {twist} ;"
        for k, row in enumerate(rows(f"{turbine}/hawc2_c2_def"))
        for twist in [row.get("twist_deg") or row.get("theta_z_deg")]
    ]
    hub = ["begin main_body;", "name hub1 ;", "begin c2_def;", "nsec 2;", "sec 1 0.0 0.0 0.0 0.0 ;"]
    hub += ["sec 2 0.0 0.0 3.97 0.0 ; x,y,z,twist", "end c2_def;", "end main_body;"]
    blade = [
        "begin main_body; the blade",
        "name blade1 ;",
        "begin c2_def;",
        f"nsec {len(sections)} ;",
    ]
    blade += [*sections, "end c2_def;", "end main_body;"]
    aero = [
        "begin aero ;",
        "nblades 3;",
        "link 1 mbdy_c2_def blade1;",
        "ae_filename ./data/ae.dat ;",
    ]
    aero += ["ae_sets 1 1 1;", "end aero ;"]
    (folder / "htc" / "parts.htc").write_text("\n".join([*hub, *blade, "exit; back"]))
    main = ["; a turbine", "continue_in_file ./htc/parts.htc ;", *aero, "exit;"]
    (folder / "htc" / "turbine.htc").write_text("\n".join(main))
    ae = [
        f" {row['r_m']} {row['chord_m']} {row['rthick_percent']} 1"
        for row in rows(f"{turbine}/hawc2_ae")
    ]
    (folder / "data" / "ae.dat").write_text("\n".join(["1 HAWC_AE data", f"1 {len(ae)} r,c", *ae]))
    return folder / "htc" / "turbine.htc"


def windio(path: Path, version: int) -> Path:
    """The IEA 15 MW's blade as the published files of windIO 1 or 2 state it, digit by digit."""
    golden, two = "iea15mw", version == 2

    def curve(table: str, name: str) -> str:
        pairs = [(row["span_fraction"], row[name]) for row in rows(f"{golden}/{table}")]
        grid, values = (", ".join(part) for part in zip(*pairs, strict=True))
        return f"{{grid: [{grid}], values: [{values}]}}"

    axis = [
        f"        {key}: {curve(table, name)}"
        for key, table, name in (
            ("x", "prebend", "prebend_x_m"),
            ("y", "sweep", "sweep_y_m"),
            ("z", "reference_axis_z", "z_m"),
        )
    ]
    schedule = rows(f"{golden}/airfoil_schedule")
    shape = [f"      chord: {curve('chord', 'chord_m')}"]
    if two:
        shape += [f"      twist: {curve('windio2_twist', 'twist_deg')}"]
        offset = curve("windio2_section_offset_y", "section_offset_y_m")
        shape += [f"      section_offset_y: {offset}"]
        shape += [f"      rthick: {curve('rthick', 'relative_thickness')}", "      airfoils:"]
        shape += [
            f"      - {{name: {row['airfoil']}, spanwise_position: {row['span_fraction']}}}"
            for row in schedule
        ]
        blade = ["    reference_axis:", *axis, "    outer_shape:", *shape]
    else:
        shape += [f"      twist: {curve('twist', 'twist_rad')}"]
        shape += [f"      pitch_axis: {curve('pitch_axis', 'pitch_axis_xc')}"]
        shape += [
            "      airfoil_position:",
            f"        grid: [{', '.join(row['span_fraction'] for row in schedule)}]",
            f"        labels: [{', '.join(row['airfoil'] for row in schedule)}]",
        ]
        blade = ["    outer_shape_bem:", *shape, "      reference_axis:", *axis]
    foils = []
    for row in rows(f"{golden}/airfoil_list"):
        points = rows(f"{golden}/airfoils/{row['airfoil']}")
        foils += [
            f"- name: {row['airfoil']}",
            f"  {'rthick' if two else 'relative_thickness'}: {row['nominal_relative_thickness']}",
            f"  aerodynamic_center: {row['aerodynamic_center_xc']}",
            f"  coordinates: {{x: [{', '.join(point['x'] for point in points)}],",
            f"    y: [{', '.join(point['y'] for point in points)}]}}",
        ]
    lines = [f"windIO_version: '{version}.0'", "components:", "  blade:", *blade]
    path.write_text("\n".join([*lines, "airfoils:", *foils]), encoding="utf-8")
    return path
