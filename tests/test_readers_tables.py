"""Readers of spanwise tables, workbooks, NuMAD, OpenFAST and HAWC2: what users' files are like."""

import gc
import zipfile
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from openpyxl import Workbook
from refusals import findings, problems

import bladegen as bg
from bladegen.errors import FileError
from bladegen.formats.common import workbook
from bladegen.formats.common.text_file import natural, number, referred
from strategies import circle, naca

TABLE = """Spanwise position [r/R],Span [m],Chord (m),Twist [deg],Thickness [%],Airfoil name,Mass
0,0,1000e-3,12,100,circle,9
0.5,10,1.5,6,,,9
1,20,0.5,0,18,naca,9
"""


PROFILE = [
    "Spanwise position [r/R]",
    "Chord [m]",
    "Twist [rad]",
    "Pitch axis [x/c]",
    "Span [m]",
    "Prebend [m]",
    "Sweep [m]",
]


def airfoils(folder: Path) -> Path:
    """Two Selig files, a circle and an airfoil."""
    folder.mkdir(exist_ok=True)
    for name, points in (("circle", circle()), ("naca", naca(0.18, 0.02, 0.0))):
        rows = "\n".join(f"{x:.9f} {y:.9f}" for x, y in points)
        (folder / f"{name}.dat").write_text(f"{name}\n{rows}\n")
    return folder


def table(folder: Path, text: str, name: str = "blade.csv") -> Path:
    airfoils(folder / "airfoils")
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_damaged_workbooks_are_closed_at_once(tmp_path):
    whole, cut = tmp_path / "whole.xlsx", tmp_path / "cut.xlsx"
    bg.write(bg.read(table(tmp_path, TABLE)), whole)
    with zipfile.ZipFile(whole) as source:
        members = {name: source.read(name) for name in source.namelist()}
    still_open = []
    gc.disable()  # which would close some of what is left open, and warn of it
    try:
        for damaged in members:
            with zipfile.ZipFile(cut, "w") as target:
                for name, content in members.items():
                    target.writestr(
                        name, content if name != damaged else content[: len(content) // 2]
                    )
            with suppress(FileError):
                bg.read(cut)
            opened = [
                file.readlink() for file in Path("/proc/self/fd").iterdir() if file.is_symlink()
            ]
            still_open += [damaged] * (cut in opened)
    finally:
        gc.enable()
    assert not still_open


def test_a_plain_table_with_usual_headers_is_read(tmp_path):
    made = bg.read(table(tmp_path, TABLE))
    assert made.format == "spanwise table"
    assert_allclose(made.chord([0, 0.5, 1]), [1.0, 1.5, 0.5])
    assert_allclose(np.degrees(made.twist([0, 0.5, 1])), [12, 6, 0])
    assert_allclose(made.relative_thickness.values, [1.0, 0.18])
    assert [(s.eta, s.airfoil.name) for s in made.stations] == [(0, "circle"), (1, "naca")]
    said = findings(made)
    for part in ("passed over: Mass", "prebend: is not given", "sweep: is not given"):
        assert part in said
    assert "pitch_axis: is not given; taken as 0.25" in said
    assert made.pitch_axis is not None
    bg.Blade.from_definition(made).sections([0.0, 0.5, 1.0])


def test_european_tables_radii_and_millimetres_are_understood(tmp_path):
    text = (
        "# number_of_blades: 2\n"
        "Radius [m];Chord [mm];Twist;t/c;Prebend [m];Pitch axis [x/c];Airfoil\n"
        "1,5;1000;12;1;0;0,5;circle\n11,5;1500;6;0,5;0,1;0,4;circle\n21,5;500;0;0,18;0,4;0,3;naca\n"
    )
    made = bg.read(table(tmp_path, text))
    assert made.length == 20.0
    assert made.rotor.hub_radius == 1.5
    assert made.rotor.blades == 2
    assert made.chord(0.5) == 1.5
    said = findings(made)
    assert "decimal commas" in said
    assert "taken as the hub radius" in said
    assert "'Twist' names no unit; taken as deg" in said
    assert "bends the tip 0.4 m downwind" in said


def test_airfoils_are_placed_by_thickness_where_a_table_names_none(tmp_path):
    text = (
        "eta,z_m,chord_m,twist_rad,thickness_m\n0,0,1,0.2,1\n0.2,4,1.5,0.1,1.2\n1,20,0.5,0,0.09\n"
    )
    made = bg.read(table(tmp_path, text))
    assert [s.airfoil.name for s in made.stations] == ["circle", "naca"]
    assert made.twist(0.0) == 0.2
    assert_allclose(made.relative_thickness.values, [1.0, 0.8, 0.18])


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("1.5,6", "-1.5,6", r"row 3, Chord \(m\): got '-1.5', allowed is above 0 to 100 m"),
        ("1.5,6", "wide,6", "row 3, Chord .m.: got 'wide', must be a number"),
        ("0.5,10", "0,10", "row 3, eta: got 0 after 0, must increase"),
        ("0.5,10", ",10", "row 3, eta: is empty"),
        ("Chord (m)", "Width", "no table: must have a header with span and chord"),
        ("Twist [deg]", "Pitch", "columns: twist missing"),
        ("naca", "nasa", "airfoil 'nasa': airfoils holds circle, naca"),
        ("1,20", "1,5", "z must increase"),
        (",12,", ",,", "twist: 1 values, at least 2"),
        ("Thickness [%]", "Thickness [stone]", "no names and no relative"),
    ],
)
def test_every_problem_is_named_with_its_place(tmp_path, old, new, said):
    text = TABLE.replace(old, new)
    if "twist: 1" in said:
        text = text.replace("1.5,6,", "1.5,,")
    if "stone" in new:
        text = text.replace("Airfoil name", "Remark")
    path = table(tmp_path, text.replace("Chord", "chord"))
    text = path.read_text()
    path.write_text(text.replace("chord", "Chord") if "Width" not in new else text + "chord\n")
    with pytest.raises(FileError, match=said):
        bg.read(path)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            "2,3,3,9,0,30,circle",
            "row 3: has 7 cells, the names above are 6: is there a decimal comma",
        ),
        ("2,3.3,9,0,30,circle", None),
        ("2,3.3,9,0,30,circle,,", None),
    ],
)
def test_a_decimal_comma_among_commas_is_asked_about(tmp_path, line, said):
    names = "r [m],chord [m],twist [deg],prebend [m],t/c [%],airfoil"
    path = table(tmp_path, f"{names}\n0,2,14,0,100,circle\n{line}\n20,1,0,0,18,naca\n")
    if said is None:
        assert bg.read(path).chord.values[1] == 3.3
    else:
        assert said in problems(path)


def test_fractions_that_are_per_cents_are_asked_about(tmp_path):
    names = "r [m],chord [m],twist [deg],t/c,airfoil"
    told = "are these per cent? name the column 't/c [%]'"
    path = table(tmp_path, f"{names}\n0,2,14,100,circle\n20,1,0,18,naca\n")
    assert problems(path).count(told) == 1
    path = table(tmp_path, f"{names}\n0,2,14,1,circle\n20,1,0,1800,naca\n")
    assert told not in problems(path)
    path = table(
        tmp_path, f"{names.replace('t/c', 't/c [%]')}\n0,2,14,100,circle\n20,1,0,18,naca\n"
    )
    assert_allclose(bg.read(path).relative_thickness.values, [1.0, 0.18])


def test_findings_tell_of_units_and_signs_that_look_odd(tmp_path):
    text = (
        TABLE.replace(",12,", ",-12,")
        .replace("Mass", "Chord [m]")
        .replace("Thickness [%]", "t/c [stone]")
    )
    said = findings(bg.read(table(tmp_path, text)))
    assert "is -12 deg at the root" in said
    assert "stands twice; the first one is taken" in said
    assert "unit 'stone' is not known" in said
    text = TABLE.replace("Mass", "Twist [m]").replace("0,0,1000e-3", "0,0,1")
    assert "no quantity in 'm'" in findings(bg.read(table(tmp_path, text)))


def test_stations_are_held_to_the_ends_and_must_increase(tmp_path):
    text = TABLE.replace("circle", "").replace("0.5,10,1.5,6,,", "0.5,10,1.5,6,,circle")
    said = findings(bg.read(table(tmp_path, text)))
    assert "circle at 0.5 is held to the root" in said
    text = TABLE.replace("naca", "").replace("0.5,10,1.5,6,,", "0.5,10,1.5,6,,naca")
    assert "naca at 0.5 is held to the tip" in findings(bg.read(table(tmp_path, text)))


def test_offsets_in_metres_win_over_a_pitch_axis(tmp_path):
    text = TABLE.replace("Mass", "section_offset_y_m").replace(",9\n", ",0.3\n")
    text = (
        text.replace("Thickness [%]", "pitch_axis")
        .replace(",100,", ",0.5,")
        .replace(",18,", ",0.3,")
    )
    made = bg.read(table(tmp_path, text))
    assert made.pitch_axis is None
    assert "passed over, since section_offset_y" in findings(made)


def test_facts_on_the_rotor_are_checked(tmp_path):
    path = table(tmp_path, "# hub_radius_m: far\n" + TABLE)
    assert "hub_radius_m: got 'far', allowed is 0 to 500 m" in problems(path)


def test_a_file_beside_those_of_an_index_is_an_airfoil_too(tmp_path):
    path = tmp_path / "blade.csv"
    bg.write(bg.read("nrel5mw"), path)
    folder = tmp_path / "blade_csv_airfoils"
    np.savetxt(folder / "mine.dat", naca(0.2, 0.02, 0.0), header="mine", comments="")
    path.write_text(path.read_text().replace("NACA64_A17", "mine"))
    made = bg.read(path)
    assert made.stations[-1].airfoil.name == "mine"
    assert np.ptp(made.stations[-1].airfoil.coordinates[:, 1]) == pytest.approx(0.2, abs=0.01)
    path.write_text(path.read_text().replace("mine", "yours"))
    assert problems(path).startswith("airfoil 'yours': blade_csv_airfoils holds mine, Cylinder")


def test_a_file_without_a_blade_names_those_beside_it_that_hold_one(tmp_path):
    other = tmp_path / "ElastoDyn.dat"
    other.write_text("------- ELASTODYN INPUT FILE\n")
    assert "beside it" not in problems(other)
    for name in ("one.dat", "two.htc"):
        bg.write(bg.read("nrel5mw"), tmp_path / name)
    assert problems(other).endswith("; beside it there is one in one.dat, two.htc")


def test_airfoil_folders_tell_what_is_wrong(tmp_path):
    path = table(tmp_path, TABLE)
    assert "is no folder" in problems(path, airfoils=tmp_path / "nowhere")
    folder = tmp_path / "blade_csv_airfoils"
    folder.mkdir()
    assert "airfoil 'circle': blade_csv_airfoils holds none" in problems(path)
    index = folder / "index.csv"
    index.write_text("airfoil,file,relative_thickness\ncircle,../airfoils/circle.dat,1\n")
    assert "line 2, file: got '../airfoils/circle.dat', must be a file of" in problems(path)
    (folder / "c.dat").write_text("nothing\n")
    index.write_text("airfoil,file\ncircle,c.dat\nnaca,c.dat\n")
    assert "c.dat: holds no coordinates (0 points)" in problems(path)


UNITS_BELOW = """Span,Chord,Twist,Pitch Axis,PreBend,t/c,Airfoil,Mass
UNITS
0,1000,12,50,0,100,circle,3
10,1500,6,40,-20,,,2
20,500,0,30,-100,18,naca,1
"""


@pytest.mark.parametrize(
    "units",
    [
        "[m],[mm],[deg],[% chord],[mm],[%],[-],[kg/m]",
        "(m),(mm),(deg),(%c),(mm),(%),(-),(kg/m)",
        "m,mm,°,% of chord,mm,%,-,kg/m",
        "m,mm,degrees,%,mm,percent,,kg/m",
        "[ m ],[MM],[Deg.],[%],[mm],[%],,",
    ],
)
@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_units_stand_in_a_row_below_the_names(tmp_path, units, delimiter):
    text = UNITS_BELOW.replace("UNITS", units).replace(",", delimiter)
    made = bg.read(table(tmp_path, text))
    assert_allclose(made.axis.z.values, [0, 10, 20])
    assert_allclose(made.chord.values, [1.0, 1.5, 0.5], rtol=1e-15)
    assert_allclose(np.degrees(made.twist.values), [12, 6, 0])
    assert_allclose(made.pitch_axis.values, [0.5, 0.4, 0.3], rtol=1e-15)
    assert_allclose(made.axis.x.values, [0, -0.02, -0.1], rtol=1e-15)
    assert_allclose(made.relative_thickness.values, [1.0, 0.18])
    assert "names no unit" not in findings(made)


@pytest.mark.parametrize(
    ("title", "factor"),
    [
        ("chord_mm", 1e-3),
        ("Chord [mm]", 1e-3),
        ("Chord (cm)", 1e-2),
        ("chord in mm", 1e-3),
        ("Chord, ft", 0.3048),
        ("Chord [in]", 0.0254),
        ("Chord [metres]", 1.0),
    ],
)
def test_units_of_a_name(tmp_path, title, factor):
    rows = [f"z_m;{title};twist_deg;t/c %;airfoil", "0;10;2;100;circle", "9;5;0;18;naca"]
    made = bg.read(table(tmp_path, "\n".join(rows)))
    assert_allclose(made.chord.values, [10 * factor, 5 * factor], rtol=1e-15)
    assert_allclose(made.relative_thickness.values, [1.0, 0.18], rtol=1e-15)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("blank", ["", ";;;;", "   "])
def test_tables_of_spreadsheets_are_read(tmp_path, encoding, blank):
    """Semicolons, decimal commas, a title, blank rows between rows, and a sum behind them."""
    lines = ["Mein Blatt", blank, "Radius [m];Chord [m];Twist [deg];t/c [%];Airfoil"]
    for row in ("1,5;1,0;1,2D+01;100;circle", "11,5;1,5;6;50;", "21,5;0,5;0;18;naca"):
        lines += [blank, row]
    path = table(tmp_path, "")
    path.write_text("\r\n".join([*lines, blank, "0;7;8;9;sum", ""]), encoding=encoding)
    made = bg.read(path)
    assert_allclose(made.axis.z.values, [0, 10, 20])
    assert_allclose(made.chord.values, [1.0, 1.5, 0.5])
    assert_allclose(np.degrees(made.twist.values), [12, 6, 0])
    assert "1 rows behind a table passed over" in findings(made)


def test_polars_beside_shapes_are_passed_over_and_reported(tmp_path):
    path = table(tmp_path, TABLE)
    folder = tmp_path / "airfoils"
    (folder / "naca_polar.dat").write_text("alpha cl cd\n-10 -0.5 0.02\n0 0.4 0.01\n10 1.2 0.02\n")
    (folder / "README.txt").write_text("Airfoils of a small blade\n")
    (folder / "naca.txt").write_text((folder / "naca.dat").read_text())
    placed = tmp_path / "placed.csv"
    placed.write_text(TABLE.replace("Airfoil name", "Remark"))
    for source in (path, placed):  # by name, and by thickness
        made = bg.read(source)
        assert [station.airfoil.name for station in made.stations] == ["circle", "naca"]
        said = findings(made)
        assert "naca_polar.dat: holds polars, not a shape; passed over" in said
        assert "README.txt: holds no coordinates, not a shape; passed over" in said
        assert "naca.txt: is a second file of naca; naca.dat is taken" in said


def test_a_file_of_polars_is_no_shape_of_its_name(tmp_path):
    path = table(tmp_path, TABLE)
    (tmp_path / "airfoils" / "naca.dat").write_text("alpha cl\n0 0.1\n1 0.2\n2 0.3\n")
    said = problems(path)
    assert "airfoil 'naca': airfoils holds circle; naca.dat holds polars, not a shape" in said


def test_files_of_aerodyn_hold_a_reference_point(tmp_path):
    path = table(tmp_path, TABLE)
    file = tmp_path / "airfoils" / "naca.dat"
    plain = bg.read(path).stations[-1].airfoil.coordinates
    points = file.read_text().splitlines()[1:]
    file.write_text("\n".join([f"{len(points) + 1} NumCoords", "0.25 0", *points]))
    made = bg.read(path)
    assert_allclose(made.stations[-1].airfoil.coordinates, plain)
    assert "naca.dat: its first point (0.25, 0) is what polars are about" in findings(made)


def sheets(path: Path, content: dict[str, list[list[object]]]) -> Path:
    """Write a workbook of given rows."""
    book = Workbook()
    book.remove(book.active)
    for title, rows in content.items():
        sheet = book.create_sheet(title)
        for row in rows:
            sheet.append(row)
    book.save(path)
    return path


def iea_layout() -> dict[str, list[list[object]]]:
    """A small blade as the IEA tabular files have it."""
    foil = [["x", "y"], *naca(0.18, 0.02, 0.0).tolist()]
    ring = [["x", "y"], *circle().tolist()]
    return {
        "Overview": [
            ["Parameter", "A turbine"],
            ["Hub diameter [m]", 3.0],
            ["Number of blades", 2.0],
        ],
        "Blade Geometry": [
            ["Spanwise position [r/R]", "Airfoil name"],
            [0, "circle"],
            [1, "naca"],
            [],
            ["Profile"],
            PROFILE,
            [0, 1.0, 0.2, 0.5, 0, 0.0, 0],
            [0.5, 1.5, 0.1, 0.4, 10, 0.1, 0],
            [1, 0.5, 0.0, 0.3, 20, 0.5, 0],
        ],
        "Airfoil circle": [
            ["name", "circle"],
            ["relative_thickness", 1],
            ["aerodynamic_center", 0.5],
            [],
            *ring,
        ],
        "Airfoil naca": [
            ["name", "naca"],
            ["relative_thickness", 0.18],
            [],
            [],
            *foil,
            [],
            ["Reynolds"],
        ],
    }


def test_the_layout_of_the_iea_tabular_files_is_read(tmp_path):
    made = bg.read(sheets(tmp_path / "t.xlsx", iea_layout()))
    assert made.format == "spanwise table"
    assert made.description == "A turbine"
    assert (made.rotor.hub_radius, made.rotor.blades) == (1.5, 2)
    assert_allclose(made.axis.x.values, [0.0, -0.1, -0.5])  # positive upwind there
    assert "positive upwind in this layout" in findings(made)
    assert_allclose(made.pitch_axis.values, [0.5, 0.4, 0.3])
    assert made.stations[1].airfoil.relative_thickness == 0.18
    assert len(made.stations[1].airfoil.coordinates) == 161


def test_the_iea_15_mw_comes_from_its_published_table(tmp_path):
    """The published figures in the published layout, entry by entry."""
    from published_formats import column, rows

    grid = column("iea15mw/twist", "span_fraction")
    chords = dict(
        zip(
            column("iea15mw/chord", "span_fraction"),
            column("iea15mw/chord", "chord_m"),
            strict=False,
        )
    )
    columns = [grid, [chords[at] for at in grid], column("iea15mw/twist", "twist_rad")]
    columns += [
        column("iea15mw/pitch_axis", "pitch_axis_xc"),
        column("iea15mw/reference_axis_z", "z_m"),
    ]
    columns += [-column("iea15mw/prebend", "prebend_x_m"), 0.0 * grid]
    content = iea_layout()
    schedule = rows("iea15mw/airfoil_schedule")
    geometry = [content["Blade Geometry"][0]]
    geometry += [[float(row["span_fraction"]), row["airfoil"]] for row in schedule]
    geometry += [[], ["Profile"], content["Blade Geometry"][5], *np.stack(columns, 1).tolist()]
    book = {"Blade Geometry": geometry}
    for name in dict.fromkeys(row["airfoil"] for row in schedule):
        points = [[float(row["x"]), float(row["y"])] for row in rows(f"iea15mw/airfoils/{name}")]
        book[f"Airfoil {name}"] = [["name", name], [], [], [], ["x", "y"], *points]
    made, bundled = bg.read(sheets(tmp_path / "t.xlsx", book)), bg.read("iea15mw")
    for name in ("chord", "twist"):
        assert_allclose(getattr(made, name)(grid), getattr(bundled, name)(grid), rtol=0, atol=1e-14)
    assert_allclose(made.axis(grid), bundled.axis(grid), rtol=0, atol=5e-14)
    assert_allclose(made.offset_y(grid), bundled.offset_y(grid), rtol=0, atol=1e-14)
    for mine, own in zip(made.stations, bundled.stations, strict=True):
        assert mine.airfoil.name == own.airfoil.name
        assert mine.eta == pytest.approx(own.eta, abs=1e-15)  # openpyxl writes 16 digits


@pytest.mark.parametrize(
    ("sheet", "row", "cells", "said"),
    [
        ("Blade Geometry", 8, [1, "wide", 0.0, 0.3, 20], r"Chord \[m\]: got 'wide', must be"),
        ("Blade Geometry", 2, [1, "nasa"], "airfoil 'nasa': has no sheet Airfoil nasa"),
        ("Airfoil naca", 4, ["points"], "Airfoil naca.coordinates.x: has 0 entries"),
        ("Blade Geometry", 2, [0, "naca"], "naca at 0 follows 0, must increase"),
    ],
)
def test_workbooks_tell_what_is_wrong(tmp_path, sheet, row, cells, said):
    content = iea_layout()
    content[sheet][row] = cells
    with pytest.raises(FileError, match=said):
        bg.read(sheets(tmp_path / "t.xlsx", content))


def test_workbooks_that_harm_are_refused(tmp_path, monkeypatch):
    path = tmp_path / "t.xlsx"
    path.write_bytes(b"PK no zip")
    assert "holds no blade" in problems(path)
    with pytest.raises(FileError, match="is no workbook"):
        workbook.sheets(path)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("xl/workbook.xml", '<!DOCTYPE a [<!ENTITY b "c">]><a/>')
    with pytest.raises(FileError, match="declares entities"):
        workbook.sheets(path)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("xl/workbook.xml", "<a/>")
    with pytest.raises(FileError, match="is no workbook that can be read"):
        workbook.sheets(path)
    sheets(path, iea_layout())
    monkeypatch.setattr(workbook, "MAX_BYTES", 1000)
    with pytest.raises(FileError, match="unpacks to"):
        workbook.sheets(path)
    with pytest.raises(FileError, match="cannot be read"):
        workbook.sheets(tmp_path / "none.xlsx")


def numad() -> list[list[object]]:
    """A small NuMAD blade: switches, then the data from row 7 on."""
    none = [None] * 11
    row = {0: [0, 12, 1.0, 100, 0.5, 0.5, None, 0, "circle"]}
    row[1] = [5, None, 1.5, None, 0.4, 0.25, None, 5, "circle"]
    row[2] = [20, 0, 0.5, 18, 0.3, 0.25, None, 20, "naca"]
    return [
        ["NuMAD blade"],
        ["natural offset", "F"],
        ["rotor spin", "CW"],
        ["swept twist", "F"],
        none,
        ["Span", "Twist", "Chord", "Thickness", "Offset", "AC", None, "Span", "Airfoil"],
        row[0],
        row[1],
        row[2],
        [],
        ["remarks", 3],
    ]


def test_numad_workbooks_are_read(tmp_path):
    airfoils(tmp_path / "airfoils")
    made = bg.read(sheets(tmp_path / "b.xlsx", {"Geometry": numad(), "Components": []}))
    assert made.format == "NuMAD"
    assert_allclose(np.degrees(made.twist.values), [12, 0])
    assert_allclose(made.chord([0, 0.25, 1]), [1.0, 1.5, 0.5])
    assert_allclose(made.pitch_axis.values, [0.5, 0.4, 0.3])
    assert_allclose(made.axis([0, 0.25, 1]), [[0, 0, 0], [0, 0, 5], [0, 0, 20]])
    assert [(s.eta, s.airfoil.name) for s in made.stations] == [
        (0, "circle"),
        (0.25, "circle"),
        (1, "naca"),
    ]


def test_numad_counts_a_natural_offset_from_the_greatest_thickness(tmp_path):
    airfoils(tmp_path / "airfoils")
    rows = numad()
    rows[1][1], rows[2][1], rows[3][1] = "T", "CCW", "T"
    for row in rows[6:9]:
        row[4] = 0.0
    made = bg.read(sheets(tmp_path / "b.xlsx", {"Geometry": rows}))
    assert_allclose(made.pitch_axis.values, [0.5, 0.5, 0.3], atol=0.02)
    said = findings(made)
    assert "CCW: read as CW" in said


@pytest.mark.parametrize(
    ("row", "column", "value", "said"),
    [
        (1, 1, "maybe", "Geometry!B2: got 'maybe', allowed are T and F"),
        (7, 2, -1, "row 8, chord: got -1"),
        (7, 7, 50, "airfoil span: got 50"),
        (7, 0, 0, "row 8, z: got 0 after 0, must increase"),
        (6, 8, "nasa", "airfoil 'nasa'"),
        (6, 0, None, "Geometry!A7: holds no span"),
        (6, 7, None, "Geometry!H7: holds no airfoils"),
    ],
)
def test_numad_workbooks_tell_what_is_wrong(tmp_path, row, column, value, said):
    airfoils(tmp_path / "airfoils")
    rows = numad()
    rows[row][column] = value
    assert said in problems(sheets(tmp_path / "b.xlsx", {"Geometry": rows}))


def test_references_stay_below_their_folder(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "x.dat").write_text("x")
    (tmp_path / "secret").write_text("x")
    (tmp_path / "a" / "link").symlink_to(tmp_path / "secret")
    bases = [tmp_path / "a"]
    assert referred('"x.dat"', bases) == (tmp_path / "a" / "x.dat").resolve()
    assert referred(".\\x.dat", bases) == (tmp_path / "a" / "x.dat").resolve()
    for name in ("../secret", str(tmp_path / "secret"), "link", "", "none", "a\0b", "x" * 5000):
        assert referred(name, bases) is None


def test_numbers_of_fortran_and_names_with_numbers():
    assert number("1.5D+01") == 15.0
    assert number("1.5e1") == 15.0
    assert number("word") is None
    names = [Path("AF10.dat"), Path("AF2.dat"), Path("af1.dat")]
    assert [path.name for path in sorted(names, key=natural)] == ["af1.dat", "AF2.dat", "AF10.dat"]


def test_tables_without_a_span_or_with_few_cells_are_refused(tmp_path):
    text = "chord_m,twist_deg\n1,2\n1,1\n"
    assert "no span, must have eta (0 to 1) or z_m" in problems(table(tmp_path, text))
    text = "z_m,chord_m,twist_deg,airfoil\n5,1,2,circle\n5,1,1,naca\n"
    assert "row 3, z: got 5 after 5, must increase" in problems(table(tmp_path, text))
    text = "z_m,chord_m,twist_deg,airfoil\n0,1,2,circle\n,1,1,circle\n5,1,1,naca\n"
    assert "row 3, z: is empty" in problems(table(tmp_path, text))
    text = "eta,z_m,chord_m,twist_deg,airfoil\n0,0,1,2,circle\n0.5,,1,1,\n0.9,5,1,1,naca\n"
    said = findings(bg.read(table(tmp_path, text)))
    assert "chord: runs from 0 to 0.9; beyond it the end value is held" in said


@pytest.mark.parametrize(
    ("member", "old", "new"),
    [
        ("xl/worksheets/sheet1.xml", b"<row r=", b'<row r="a" x='),
        ("xl/worksheets/sheet1.xml", b"</row>", b"</rows>"),
        ("xl/workbook.xml", b"</sheets>", b""),
    ],
)
def test_workbooks_whose_sheets_are_no_xml_are_refused(tmp_path, member, old, new):
    path = sheets(tmp_path / "b.xlsx", {"Geometry": numad(), "Components": []})
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    assert old in members[member]
    members[member] = members[member].replace(old, new)
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    assert problems(path)


def test_a_workbook_with_a_broken_directory_is_refused(tmp_path):
    path = sheets(tmp_path / "b.xlsx", {"Geometry": numad(), "Components": []})
    content = bytearray(path.read_bytes())
    content[-6:-2] = (2**32 - 9).to_bytes(4, "little")  # where the directory begins
    path.write_bytes(content)
    assert problems(path)


def numad_stations() -> dict[str, list[list[object]]]:
    """A small blade in the layout of the older NuMAD workbooks."""
    titles = ["Sta.#", "Blade span (m)", "Airfoil Shape File", "TE Type", "Twist (deg)", "Chord"]
    titles += ["xoffset", "aero center", "Section Label", "GELCOAT"]
    return {
        "Materials": [["x"]],
        "Geometry": [
            ["mini", None, None, None, "# Shear webs ->", 1],
            [None, None, None, None, None, None, "# of segments ->", 2],
            titles,
            [1, 0, "circular", "round", 9, 0.8, 0.5, 0.5, "root", 1],
            [2, 1.5, "interp", "round", 8, None, None, None, None, None],
            [3, 4, "naca", "sharp", 6, 1.1, 0.35, 0.25, "max chord", None],
            [4, 12, "naca.txt", "flat", 0, 0.4, 0.3, 0.25, "tip", None],
            [None, None, "a remark"],
        ],
    }


def test_older_workbooks_of_numad_are_read(tmp_path):
    airfoils(tmp_path / "airfoils")
    made = bg.read(sheets(tmp_path / "b.xlsx", numad_stations()))
    assert made.format == "NuMAD"
    assert_allclose(made.axis([0, 1 / 3, 1]), [[0, 0, 0], [0, 0, 4], [0, 0, 12]], atol=1e-12)
    assert_allclose(np.degrees(made.twist.values), [9, 8, 6, 0])
    assert_allclose(made.chord.values, [0.8, 1.1, 0.4])
    assert_allclose(made.pitch_axis.values, [0.5, 0.35, 0.3])
    assert [(s.eta, s.airfoil.name) for s in made.stations] == [
        (0, "circular"),
        (1 / 3, "naca"),
        (1, "naca"),
    ]
    x, y = made.stations[0].airfoil.coordinates.T
    assert_allclose(np.hypot(x - 0.5, y), 0.5, atol=1e-15)
    said = findings(made)
    assert "circular: is not in airfoils; NuMAD's circle of that name is taken" in said
    assert "1 stations are interp" in said


def test_older_workbooks_may_have_their_header_elsewhere(tmp_path):
    airfoils(tmp_path / "airfoils")
    rows = numad_stations()["Geometry"]
    made = bg.read(sheets(tmp_path / "b.xlsx", {"geometry": rows[2:]}))
    assert_allclose(made.chord.values, [0.8, 1.1, 0.4])


def test_bend_and_sweep_of_older_workbooks_are_read(tmp_path):
    airfoils(tmp_path / "airfoils")
    content = numad_stations()
    content["Bend & Sweep"] = [
        ["Pre-Bend", "method ->", "shear", "Sweep", "method ->", "normal"],
        [None, "type ->", "poly", None, "type ->", "poly"],
        ["span", "disp", "slope", "span", "disp", "slope"],
        [0, 0, None, 0, 0, None],
        [12, -0.5, None, 12, 0.2, None],
    ]
    made = bg.read(sheets(tmp_path / "b.xlsx", content))
    assert_allclose(made.axis(1.0), [-0.5, 0.2, 12])
    assert "sections stand parallel (shear) there" in findings(made)


@pytest.mark.parametrize(
    ("row", "column", "value", "said"),
    [
        (4, 5, -1, "row 5, Chord: got -1"),
        (5, 1, 0, "row 6, Blade span (m): got 0 after 1.5, must increase"),
        (5, 2, "nasa", "airfoil 'nasa': airfoils holds"),
        (3, 1, None, "holds 0 stations with a span"),
    ],
)
def test_older_workbooks_of_numad_tell_what_is_wrong(tmp_path, row, column, value, said):
    airfoils(tmp_path / "airfoils")
    content = numad_stations()
    content["Geometry"][row][column] = value
    assert said in problems(sheets(tmp_path / "b.xlsx", content))


def project(**changes: str) -> str:
    """A small project of NuMAD: a circle listed without its last point, and an airfoil twice."""
    parts = {
        "rotation": "<rotation>cw</rotation>",
        "presweep": "<presweep>\n<method>normal</method>\n<table>\n0 0 0\n</table>\n</presweep>",
        "precurve": "<precurve>\n<method>shear</method>\n<table>\n"
        "0 0 NaN\n6 -0.1 NaN\n12 -0.5 NaN\n</table>\n<pptype>spline</pptype>\n</precurve>",
    } | changes
    stations = []
    shapes_ = {"circular": circle()[:-1], "foil": naca(0.18, 0.02, 0.0)[:-1]}
    for name, z, twist, chord in (
        ("circular", 0, 9, 0.8),
        ("foil", 4, 6, 1.1),
        ("foil", 12, 0, 0.4),
    ):
        rows = "\n".join(f" {x:.7f} {y:.7f}" for x, y in shapes_[name])
        stations.append(
            f"<station>\n<airfoilname>{name}</airfoilname>\n<tetype>round</tetype>\n"
            f"<degreestwist>{twist}</degreestwist>\n<locationz>{z}</locationz>\n"
            f"<xoffset>0.4</xoffset>\n<chord>{chord}</chord>\n<coords>\n{rows}\n</coords>\n"
            "<surfacematerial>\n**UNSPECIFIED**\n</surfacematerial>\n</station>"
        )
    return "\n".join(
        ['<numad release="v2.0.1">', "<blade>", *parts.values(), *stations, "</blade>", "</numad>"]
    )


def test_projects_of_numad_are_read(tmp_path):
    path = tmp_path / "b.nmd"
    path.write_text(project())
    made = bg.read(path)
    assert made.format == "NuMAD"
    assert_allclose(made.axis([0, 1]), [[0, 0, 0], [-0.5, 0, 12]], atol=1e-15)
    assert_allclose(np.degrees(made.twist.values), [9, 6, 0])
    assert_allclose(made.chord.values, [0.8, 1.1, 0.4])
    assert_allclose(made.pitch_axis.values, 0.4)
    assert [s.airfoil.name for s in made.stations] == ["circular", "foil", "foil"]
    for station, points in zip(made.stations, (circle(), naca(0.18, 0.02, 0.0)), strict=False):
        assert_allclose(station.airfoil.coordinates, points, atol=1e-7)
    said = findings(made)
    assert "foil: the edge point (1, 0) is listed once" in said
    assert "sections stand parallel (shear) there; --planes z" in said


def test_projects_of_numad_tell_what_is_wrong(tmp_path):
    path = tmp_path / "b.nmd"
    path.write_text(project(rotation="<rotation>ccw</rotation>"))
    assert "ccw: read as cw" in findings(bg.read(path))
    text = project()
    line = text.splitlines().index(" 1.0000000 0.0000000")
    path.write_text(text.replace(" 1.0000000 0.0000000\n", " 1.0000000 0.0000000\n 0.9x 0.1\n", 1))
    assert f"circular: line {line + 2}: got '0.9x 0.1', must be x and y" in problems(path)
    for old, new, said in (
        ("<chord>1.1<", "<chord>wide<", "Chord: got 'wide'"),
        ("<locationz>4<", "<locationz>0<", "must increase"),
        ("<station>", "<part>", "<station>: 0 of them"),
        ("6 -0.1 NaN", "0 -0.1 NaN", "precurve: must hold rows of span, which increases"),
    ):
        path.write_text(text.replace(old, new))
        assert said in problems(path)


QBLADE = """-----------------QBlade Blade Definition File---------------
Generated with : QBlade
Archive Format: 310002

-----------------Object Name--------------------------------
A_small_blade              OBJECTNAME         - the name of the blade object

-----------------Parameters---------------------------------
HAWT                       ROTORTYPE          - the rotor type
2                          NUMBLADES          - number of blades

-----------------Blade Data---------------------------------
POS [m]    CHORD [m]   TWIST [deg]  OFFSET_X [m]  OFFSET_Y [m]  TAXIS [-]  POLAR_FILE
1.5        1.0         12.0         0.0           0.0           0.5        circle_Re3.plr
5.5        1.5         6.0          0.2           0.02          0.5        Polars/first.plr
21.5       0.5         0.0          0.1           -0.3          0.25       naca_MultiRePolar.plr

-----------------BDAMAGE Data-------------------------------
"""


@pytest.mark.parametrize("place", ["Airfoils", "."])
def test_blades_of_qblade_are_read(tmp_path, place):
    for file in airfoils(tmp_path / place).glob("*.dat"):
        file.rename(file.with_suffix(".afl"))
    (tmp_path / "Polars").mkdir()
    (tmp_path / "Polars" / "first.plr").write_text("Airfoils/naca.afl  FOILNAME - the airfoil\n")
    path = tmp_path / "b.bld"
    for old, new in ((" [", "_["), ("TAXIS", "P_AXIS"), ("x", "x")):  # as other releases name them
        path.write_text(QBLADE.replace(old, new))
        made = bg.read(path)
        assert made.format == "QBlade"
        assert made.description == "A small blade"
        assert (made.rotor.blades, made.rotor.hub_radius) == (2, 1.5)
        assert_allclose(made.axis.z.values, [0, 4, 20])
        assert_allclose(made.axis.y.values, [0, 0.2, 0.1])  # toward the trailing edge
        assert_allclose(made.axis.x.values, [0, 0.02, -0.3])  # downwind
        assert_allclose(np.degrees(made.twist.values), [12, 6, 0])
        assert_allclose(made.pitch_axis.values, [0.5, 0.5, 0.25])
        assert [s.airfoil.name for s in made.stations] == ["circle", "naca", "naca"]
        assert "taken as the hub radius" in findings(made)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("HAWT", "VAWT", "ROTORTYPE: got VAWT, allowed is HAWT"),
        ("1.5         6.0", "wide        6.0", "line 15, CHORD: got 'wide', must be a number"),
        ("5.5    ", "0.5    ", "z: got -1 after 0, must increase"),
        ("0.5        circle_Re3.plr", "", "line 14: must hold 7 entries"),
        ("circle_Re3.plr", "disk.plr", "airfoil 'disk': airfoils holds circle, naca"),
    ],
)
def test_blades_of_qblade_tell_what_is_wrong(tmp_path, old, new, said):
    airfoils(tmp_path / "airfoils")
    path = tmp_path / "b.bld"
    path.write_text(QBLADE.replace("Polars/first", "naca").replace(old, new))
    assert said in problems(path)
