"""Cases of sections: laws of the mesh, files as OpenFOAM reads them, and OpenFOAM itself."""

import os
import re
import shutil
import subprocess
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from foam_reading import parsed
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from typer.testing import CliRunner

import bladegen as bg
from bladegen.blade.edges import Sharp
from bladegen.cli.commands import app
from bladegen.cli.nested import case as command
from bladegen.errors import ExportError, GeometryError
from bladegen.exports import marks
from bladegen.exports.cases.cell_measures import non_orthogonality
from bladegen.exports.cases.conditions import flow_at
from bladegen.exports.cases.marching import crossed, marched
from bladegen.exports.cases.poly_mesh import extruded
from bladegen.exports.cases.section import section_case
from bladegen.surface.wall_spacing import first_height
from strategies import by_day

SMALL = {"cells": 128, "y_plus": 30.0, "growth": 1.3, "radius": 20.0}
DEBIAN = "/usr/share/openfoam"


@cache
def blade(name="iea15mw"):
    return bg.Blade.from_definition(bg.read(name), landmarks=201)


def turned(points, angle):
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


def circle(n, radius=1.0):
    angle = -2.0 * np.pi * np.arange(n) / n
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


@given(n=st.integers(40, 200), growth=st.floats(1.05, 1.3), first=st.floats(1e-5, 1e-3))
def test_around_a_circle_layers_are_circles_of_the_heights_asked_for(n, growth, first):
    layers = marched(circle(n), first, growth, 3.0)
    radii = np.linalg.norm(layers, axis=2)
    assert_allclose(layers / radii[..., None], np.broadcast_to(circle(n), layers.shape), atol=1e-8)
    assert np.ptp(radii, axis=1).max() < 1e-8
    heights = np.diff(radii[:, 0])
    assert_allclose(heights[:5], first * growth ** np.arange(5), rtol=0.05)
    assert radii[-1, 0] >= 3.0 > radii[-2, 0]


@given(angle=st.floats(-3.0, 3.0), size=st.floats(0.01, 100.0))
def test_a_turned_and_enlarged_curve_has_a_turned_and_enlarged_mesh(angle, size):
    curve = circle(60) * [1.0, 0.2]
    plain = marched(curve, 1e-3, 1.2, 4.0)
    other = marched(size * turned(curve, angle), size * 1e-3, 1.2, size * 4.0)
    assert_allclose(other, size * turned(plain, angle), atol=1e-8 * size)


@pytest.mark.parametrize("name", by_day("iea15mw"))
@pytest.mark.parametrize("eta", [0.15, 0.3, 0.7, 0.99])
def test_cells_are_sound_along_the_blade(name, eta):
    made = section_case(blade(name), eta, alpha=0.05, cells=256, y_plus=1.0)
    layers, chord = made.layers, made.flow.chord
    assert crossed(layers[:-1], layers[1:]).min() > 0.0
    assert np.degrees(non_orthogonality(layers).max()) < 45.0
    assert np.linalg.norm(layers[-1] - [0.5 * chord, 0.0], axis=1).min() > 499.0 * chord
    height = 2.0 * first_height(made.flow.reynolds, chord, 1.0)
    first = np.linalg.norm(layers[1] - layers[0], axis=1) / height
    assert first.min() > 0.9
    assert first.max() < 1.6  # off a corner, the wall is as far as elsewhere
    assert_allclose(np.median(first), 1.0, atol=0.01)
    assert made.figures["growth_outward"] < 1.25
    assert made.figures["growth_around"] < 1.25


@pytest.mark.parametrize("name", ["iea15mw", "nrel5mw"])
def test_the_wall_is_the_blades_section_on_its_chord_line(name):
    made = section_case(blade(name), 0.5, alpha=0.05, cells=512)
    points, sides = made.outline.points, made.outline.sides
    assert sum(sides.values()) == len(points) == 512
    nose, edge = sides["pressure_side"], 512 - sides["trailing_edge"]
    assert_allclose(points[nose], 0.0, atol=1e-12)
    assert_allclose(0.5 * (points[0] + points[edge]), [made.flow.chord, 0.0], atol=1e-4)
    section = blade(name).sections([0.5])[0]
    width = np.linalg.norm(section[0] - section[-1])
    assert_allclose(np.linalg.norm(points[0] - points[edge]), width, rtol=1e-6)
    vector = 0.5 * np.cross(section, np.roll(section, -1, axis=0)).sum(axis=0)
    x, y = points.T
    area = 0.5 * np.sum(np.roll(x, -1) * y - x * np.roll(y, -1))  # clockwise
    assert_allclose(area, np.linalg.norm(vector), rtol=2e-4)
    assert y[nose : nose + sides["suction_side"]].mean() > 0.0 > y[:nose].mean()


@pytest.fixture(scope="module")
def mesh():
    made = section_case(blade(), 0.7, alpha=0.05, **SMALL)
    return made, extruded(made.layers, 0.1 * made.flow.chord, made.outline.sides)


def vectors(mesh):
    """Area vectors (f, 3) and middles of faces, by their corners."""
    a, b, c, d = mesh.points[mesh.faces].transpose(1, 0, 2)
    return 0.5 * np.cross(c - a, d - b), 0.25 * (a + b + c + d)


def test_cells_are_closed_and_have_the_volume_of_the_slab(mesh):
    made, mesh = mesh
    area, middle = vectors(mesh)
    count, inner = made.figures["cells"], len(mesh.neighbour)
    closed, volume = np.zeros((count, 3)), np.zeros(count)
    flux = np.sum(area * middle, axis=1) / 3.0
    np.add.at(closed, mesh.owner, area)
    np.subtract.at(closed, mesh.neighbour, area[:inner])
    np.add.at(volume, mesh.owner, flux)
    np.subtract.at(volume, mesh.neighbour, flux[:inner])
    assert np.abs(closed).max() < 1e-10
    assert volume.min() > 0.0

    def enclosed(points):
        x, y = points.T
        return 0.5 * abs(np.sum(np.roll(x, -1) * y - x * np.roll(y, -1)))

    ring = enclosed(made.layers[-1]) - enclosed(made.layers[0])
    assert_allclose(volume.sum(), 0.1 * made.flow.chord * ring, rtol=1e-10)


def test_faces_stand_in_openfoams_order_and_point_out_of_their_owner(mesh):
    made, mesh = mesh
    inner = len(mesh.neighbour)
    assert np.all(mesh.owner[:inner] < mesh.neighbour)
    pairs = list(zip(mesh.owner[:inner].tolist(), mesh.neighbour.tolist(), strict=True))
    assert pairs == sorted(set(pairs))
    _, middle = vectors(mesh)
    sums, faces = np.zeros((made.figures["cells"], 3)), np.zeros(made.figures["cells"])
    for cells, of in ((mesh.owner, middle), (mesh.neighbour, middle[:inner])):
        np.add.at(sums, cells, of)
        np.add.at(faces, cells, 1)
    assert set(faces) == {6}
    centre = sums / faces[:, None]
    area, _ = vectors(mesh)
    assert np.all(np.sum(area * (middle - centre[mesh.owner]), axis=1) > 0.0)
    assert np.array_equal(np.unique(mesh.faces), np.arange(len(mesh.points)))
    start = inner
    for _, first, size in mesh.patches.values():
        assert first == start
        start += size
    assert start == len(mesh.faces)
    for name, way in (("far_field", 1.0), ("suction_side", -1.0)):
        _, first, size = mesh.patches[name]
        out = np.sum(area[first : first + size, :2] * middle[first : first + size, :2], axis=1)
        assert way * np.median(out) > 0.0


@pytest.fixture(scope="module")
def written(tmp_path_factory, mesh):
    folder = tmp_path_factory.mktemp("cases") / "case"
    mesh[0].write(folder, command="bladegen case openfoam iea15mw")
    return folder


def test_files_hold_the_mesh(written, mesh):
    mesh = mesh[1]
    home = written / "constant" / "polyMesh"

    def listed(name):
        head, _, rest = (home / name).read_text().partition("}")
        kind = re.search(r"class +(\w+);", head)[1]
        rows = [line for line in rest.split("\n") if line and not line.startswith("//")]
        assert (rows[1], rows[-1]) == ("(", ")")
        assert int(rows[0]) == len(rows) - 3
        return kind, [re.sub(r"4?\((.*)\)", r"\1", row).split() for row in rows[2:-1]]

    kinds = {"points": "vectorField", "faces": "faceList"}
    for name in ("points", "faces", "owner", "neighbour"):
        kind, rows = listed(name)
        assert kind == kinds.get(name, "labelList")
        wanted = getattr(mesh, name).reshape(len(rows), -1)
        assert_allclose(np.array(rows, dtype=float), wanted, rtol=1e-11, atol=1e-12)
    rest = (home / "boundary").read_text().partition("}")[2].strip()
    count, _, inner = rest.partition("(")
    patches = parsed(inner.rpartition(")")[0])
    assert int(count) == len(patches) == len(mesh.patches)
    for name, (kind, first, size) in mesh.patches.items():
        assert patches[name]["type"] == kind
        assert (patches[name]["startFace"], patches[name]["nFaces"]) == (first, size)
    walls = [name for name, patch in patches.items() if patch.get("inGroups") == ["blade"]]
    assert walls == ["pressure_side", "suction_side", "trailing_edge"]


def test_dictionaries_say_what_flows(written, mesh):
    flow = mesh[0].flow
    read = {
        str(path.relative_to(written)): parsed(path.read_text())
        for part in ("0", "constant", "system")
        for path in (written / part).iterdir()
        if path.is_file()
    }
    for name, held in read.items():
        assert held["FoamFile"]["object"] == name.rpartition("/")[2]
    nu = read["constant/transportProperties"]["nu"]
    forces = read["system/controlDict"]["functions"]["forces"]
    kind, stream = read["0/U"]["internalField"]
    assert kind == "uniform"
    assert_allclose(np.linalg.norm(stream), flow.speed, rtol=1e-8)
    assert_allclose(stream[1] / stream[0], np.tan(0.05), rtol=1e-8)
    assert_allclose(flow.speed * flow.chord / nu, flow.reynolds, rtol=1e-8)
    assert_allclose(np.dot(forces["dragDir"], stream), flow.speed, rtol=1e-8)
    assert_allclose(np.cross(forces["dragDir"], forces["liftDir"]), [0, 0, 1], atol=1e-8)
    points = np.loadtxt(
        [
            r[1:-1]
            for r in (written / "constant/polyMesh/points").read_text().split("\n")
            if r[:1] == "(" < r
        ]
    )
    assert_allclose(forces["Aref"], np.ptp(points[:, 2]) * flow.chord, rtol=1e-8)
    for name in ("U", "p", "k", "omega", "nut"):
        assert set(read[f"0/{name}"]["boundaryField"]) == {"blade", "far_field", "front_and_back"}
    k, omega = (read[f"0/{name}"]["internalField"][1] for name in ("k", "omega"))
    assert_allclose(k / omega / nu, 0.01, rtol=1e-6)  # Menter: 1e-2 to 1e-5 of the viscosity


def test_the_case_says_what_it_is_made_from_and_how_it_is_run(written):
    made = marks.read(written / "README.md")
    assert (made.blade, made.command) == ("iea15mw", "bladegen case openfoam iea15mw")
    assert dict(made.settings)["y_plus"] == "30"
    assert os.access(written / "Allrun", os.X_OK)
    subprocess.run(["sh", "-n", str(written / "Allrun")], check=True)


@pytest.mark.parametrize(
    ("given", "others"),
    [
        (command.OfSection(), "--speed, --alpha"),
        (command.OfSection(speed=60.0), "--alpha"),
        (command.OfRotor(), "--wind, --tip-speed-ratio, --pitch"),
        (command.OfRotor(wind=8.0), "--tip-speed-ratio, --pitch"),
        (command.OfRotor(wind=8.0, rotor_speed=9.0), "--pitch"),
    ],
)
def test_what_was_taken_is_changed_by_options_that_were_not_given(given, others):
    assert command._others(given) == others


@pytest.mark.parametrize(
    ("count", "failing"), [("1", ""), ("3", ""), ("1", "checkMesh"), ("3", "decomposePar")]
)
def test_the_script_says_what_it_runs_and_where_it_failed(written, tmp_path, count, failing):
    """By programs that stand for OpenFOAM's."""
    case, programs = tmp_path / "case", tmp_path / "programs"
    shutil.copytree(written, case)
    programs.mkdir()
    names = ["foamListTimes", "checkMesh", "foamDictionary", "decomposePar", "simpleFoam"]
    for name in [*names, "mpirun", "reconstructPar"]:
        last = "postProcessing/forces/0"
        makes = f"mkdir -p {last}; echo '7 0.01 0 1.2 0 0' | tr ' ' '\\t' > {last}/coefficient.dat"
        ends = "echo FOAM FATAL ERROR >&2; exit 1" if name == failing else makes
        (programs / name).write_text(f'#!/bin/sh\necho {name} "$@"\n{ends}\n')
        (programs / name).chmod(0o755)
    path = f"{programs}:{os.environ['PATH']}"
    done = subprocess.run(
        [case / "Allrun", count],
        env={**os.environ, "PATH": path, "WM_PROJECT_DIR": "/nowhere"},
        capture_output=True,
        text=True,
        check=False,
    )
    steps = [line.split(maxsplit=1)[1] for line in done.stdout.splitlines() if line[2:3] == ":"]
    if failing:
        assert done.returncode == 1
        assert done.stderr.splitlines()[0] == f"Allrun: {failing} failed; the end of log.{failing}:"
        assert done.stderr.endswith("FOAM FATAL ERROR\n")
        assert steps[-1].startswith(failing)
        return
    assert done.returncode == 0
    solved = {
        "1": ["checkMesh", "simpleFoam"],
        "3": [
            "checkMesh",
            "decomposePar -force",
            "mpirun -np 3 simpleFoam -parallel",
            "reconstructPar -latestTime",
        ],
    }
    assert steps == solved[count]
    assert done.stdout.splitlines()[-1] == "7\t0.01\t0\t1.2"
    assert (case / "log.simpleFoam").is_file()


def test_the_stream_is_that_of_the_rotor():
    # E. Gaertner et al., NREL/TP-5000-75698 (2020), table ES-1: 95 m/s, tip speed ratio 9.0
    tip = flow_at(blade(), 1.0, alpha=0.0)
    wind = 95.0 / 9.0
    assert_allclose(tip.speed, np.hypot(95.0, wind * 2.0 / 3.0), rtol=0.01)
    angle = np.arctan2(wind * 2.0 / 3.0, 95.0)
    assert_allclose(flow_at(blade(), 1.0).alpha, angle - blade().twist(1.0), atol=1e-3)
    given = flow_at(blade(), 0.7, speed=50.0, reynolds=4e6, alpha=0.1)
    assert (given.speed, given.reynolds, given.alpha, given.told) == (50.0, 4e6, 0.1, "")
    assert_allclose(given.viscosity, 50.0 * blade().chord(0.7) / 4e6, rtol=1e-12)
    assert "assumed" in flow_at(blade("dtu10mw"), 0.7).told


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"speed": 0.0}, "speed: got 0, allowed is 0.01 to 150 m/s"),
        ({"reynolds": 1e3}, "reynolds: got 1000, allowed is 10000 to 1e\\+09"),
        ({"alpha": 1.0}, "alpha: got 57.2958, allowed is -25 to 25 degrees"),
        ({"alpha": float("nan")}, "alpha: got nan"),
        ({"y_plus": 0.0}, "y\\+: got 0, must be positive"),
        ({"cells": 10}, "cells: got 10, allowed is 128 to 2048"),
        ({"growth": 1.0}, "growth: got 1, allowed is 1.02 to 1.4"),
        ({"radius": 1.0}, "radius: got 1, allowed is 5 to 1000"),
        ({"end": 0}, "end: got 0, allowed is 1 to"),
    ],
)
def test_what_makes_no_case_is_refused(asked, said):
    with pytest.raises(GeometryError, match=said):
        section_case(blade(), 0.7, **asked)


def test_a_sharp_edge_and_a_folded_mesh_are_refused():
    with pytest.raises(GeometryError, match="such as --trailing-edge 2mm"):
        section_case(replace(blade(), trailing_edge=Sharp()), 0.7)
    with pytest.raises(GeometryError, match="folds in layer"):
        marched(circle(60)[::-1], 1e-3, 1.2, 4.0)
    with pytest.raises(GeometryError, match=r"alpha: at eta = 0 .* give one \(--alpha 4\)"):
        section_case(blade(), 0.0)


def test_neither_other_files_nor_results_are_overwritten(tmp_path, mesh, monkeypatch):
    made = mesh[0]
    (tmp_path / "README.md").write_text("of a bladegen user\n")
    with pytest.raises(ExportError, match="holds other files"):
        made.write(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["README.md"]
    made.write(tmp_path / "case")
    made.write(tmp_path / "case")
    assert {path.name for path in tmp_path.iterdir()} == {"README.md", "case"}
    (tmp_path / "case" / "postProcessing").mkdir()
    with pytest.raises(ExportError, match=r"holds the results of a run.* -o .*case2"):
        made.write(tmp_path / "case")
    monkeypatch.chdir(tmp_path / "case")
    with pytest.raises(ExportError, match=r"holds the results of a run.* -o case2"):
        made.write(Path())
    (tmp_path / "case" / "postProcessing").rmdir()
    made.write(Path())


def run(*words):
    return CliRunner().invoke(app, [str(word) for word in words])


def test_the_command_writes_a_case(tmp_path):
    small = ("--cells", 128, "--y-plus", 30, "--growth", 1.3, "--alpha", "4deg")
    done = run("case", "openfoam", "nrel5mw", "--section", 0.7, "-o", tmp_path / "a", *small)
    assert done.exit_code == 0, done.output
    assert "Allrun" in done.output
    said = marks.read(tmp_path / "a" / "README.md").command
    assert said.startswith("bladegen case openfoam nrel5mw --section 0.7")


def table(path):
    """The columns of a file that OpenFOAM wrote while it ran, words left out."""
    lines = path.read_text().splitlines()
    names = [line for line in lines if line.startswith("#")][-1].lstrip("# ").split()
    rows = [line.split() for line in lines if not line.startswith("#")]
    columns = dict(zip(names, zip(*rows, strict=True), strict=True))
    return {
        name: np.array(values, dtype=float)
        for name, values in columns.items()
        if values[0][:1] in "-0123456789"
    }


@pytest.mark.nightly
@pytest.mark.skipif(shutil.which("simpleFoam") is None, reason="OpenFOAM is not installed")
@pytest.mark.parametrize(("name", "eta"), [("iea15mw", 0.7), ("nrel5mw", 0.7), ("dtu10mw", 0.5)])
def test_openfoam_takes_the_mesh_and_its_lift_is_that_of_neuralfoil(tmp_path, name, eta):
    from bladegen.neuralfoil import coefficients

    made = section_case(blade(name), eta, alpha=np.radians(4.0), cells=384, y_plus=3.0)
    made.write(tmp_path / "case")
    (tmp_path / "case" / "2024-notes").touch()  # is no time of a run
    environment = {**os.environ, "WM_PROJECT_DIR": os.environ.get("WM_PROJECT_DIR", DEBIAN)}
    subprocess.run([tmp_path / "case" / "Allrun"], env=environment, check=True)
    assert (tmp_path / "case" / "2024-notes").is_file()
    assert "Mesh OK." in (tmp_path / "case" / "log.checkMesh").read_text()
    results = tmp_path / "case" / "postProcessing"
    history = table(results / "forces" / "0" / "coefficient.dat")
    drag, lift, moment = (history[name][-1] for name in ("Cd", "Cl", "CmPitch"))
    assert_allclose(history["Cl"][-20:], lift, rtol=2e-3)
    section = blade(name).profiles([eta])[0]
    wanted = coefficients(section, made.flow.alpha, made.flow.reynolds).values
    assert_allclose(lift, wanted[0], rtol=0.1)
    assert_allclose(moment, wanted[2], atol=0.03)
    assert wanted[1] < drag < 3.0 * wanted[1]  # turbulent from the nose on
    residuals = table(results / "residuals" / "0" / "solverInfo.dat")
    for residual in ("Ux_initial", "Uy_initial", "p_initial"):
        assert residuals[residual][-1] < 1e-5 * residuals[residual][0]
