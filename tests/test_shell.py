"""Shell models of skin and webs: meshes that fit, laminates that weigh, files for CalculiX."""

import json
import re
import shutil
import subprocess
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from typer.testing import CliRunner

import bladegen as bg
from bladegen.blade.edges import MinimumThickness
from bladegen.blade.layup.shell.inp import FORCE, GRAVITY, inp_lines, nodal_thickness
from bladegen.blade.layup.shell.laminates import even, plane_stiffness
from bladegen.blade.layup.shell.model import shell_model
from bladegen.blade.layup.shell.quality import (
    ETA,
    XI,
    corner_normals,
    shapes,
    shared_normals,
    slopes,
    wall_jacobians,
)
from bladegen.blade.layup.shell.trailing_edge import WIDE, openness, panels
from bladegen.cli import commands
from bladegen.definition.structure.positions import Arc
from bladegen.errors import ExportError, GeometryError

constant = bg.Distribution.constant
GLASS = bg.Material("glass", 1900.0, (4e10, 1e10, 1e10), (4e9, 4e9, 3e9), (0.28, 0.3, 0.3),
                    orthotropic=True)  # fmt: skip
STEEL = bg.Material("steel", 7800.0, (2e11,) * 3, None, (0.3,) * 3)
RADIUS, LENGTH, WALL = 1.0, 40.0, 0.02  # m
PUBLISHED = 0.555, 0.642  # Hz, flap and edge; Gaertner et al., NREL/TP-5000-75698 (2020)


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("iea15mw"), landmarks=201)


@pytest.fixture(scope="module")
def model(blade):
    return shell_model(blade.layup, 2.0)


@pytest.fixture(scope="module")
def flat(blade):
    """The shell of a blade whose trailing edge is 8 % of the chord wide outside of its root."""
    thick = bg.Blade.from_definition(
        blade.definition, landmarks=101, trailing_edge=MinimumThickness(0.5, 0.08)
    )
    return shell_model(thick.layup, 4.0)


def tube(*layers):
    """The layup of a straight round tube with these layers (name, material, thickness, angle)."""
    angle = np.linspace(0.0, 2.0 * np.pi, 121)
    circle = np.stack([0.5 + 0.5 * np.cos(angle), 0.5 * np.sin(angle)], axis=-1)
    foil = bg.Airfoil("circle", circle, 1.0)
    zero = constant(0.0)
    ends = Arc(zero), Arc(constant(1.0))
    inside = bg.Structure(
        (GLASS, STEEL),
        (),
        tuple(
            bg.Layer(name, material.name, constant(thick), *ends, angle=constant(turn))
            for name, material, thick, turn in layers
        ),
    )
    definition = bg.BladeDefinition(
        name="tube",
        stations=(bg.Station(0.0, foil), bg.Station(1.0, foil)),
        chord=constant(2.0 * RADIUS),
        twist=zero,
        axis=bg.ReferenceAxis(zero, zero, bg.Distribution([0.0, 1.0], [0.0, LENGTH])),
        pitch_axis=constant(0.5),
        structure=inside,
    )
    return bg.Blade.from_definition(definition, landmarks=201).layup


def solved(model, folder, **options):
    """Frequencies [Hz], weight [N] and tip displacements (nodes, 3) [m] that CalculiX finds."""
    text = "\n".join(inp_lines(model, **options)) + "\n"
    (folder / "model.inp").write_text(text, encoding="ascii")
    solver = shutil.which("ccx")
    assert solver, "CalculiX is missing; ./scripts/setup.sh test installs it"
    done = subprocess.run(
        [solver, "model"], cwd=folder, capture_output=True, text=True, check=False
    )
    assert "Job finished" in done.stdout, done.stdout[-500:]
    found = (folder / "model.dat").read_text()
    modes = re.findall(r"^ +\d+ +\S+ +\S+ +(\S+) +0\.0000000E\+00", found, re.MULTILINE)
    force = re.search(r"total force.*set ROOT and time  0\.2.*\n\n +(\S+) +(\S+) +(\S+)", found)
    tip = found.split("set TIP and time  0.1000000E+01")[1].split("total")[0]
    moved = re.findall(r"^ +\d+ +(\S+) +(\S+) +(\S+)$", tip, re.MULTILINE)
    return [float(f) for f in modes], float(force[3]), np.array(moved, dtype=float)


@given(st.floats(-1, 1), st.floats(-1, 1), st.lists(st.floats(-5, 5), min_size=6, max_size=6))
def test_shape_functions_are_exact_for_what_is_quadratic(xi, eta, c):
    def field(x, y):
        return c[0] + c[1] * x + c[2] * y + c[3] * x * y + c[4] * x * x + c[5] * y * y

    found = slopes(np.array(xi), np.array(eta)) @ field(XI, ETA)
    wanted = [c[1] + c[3] * eta + 2 * c[4] * xi, c[2] + c[3] * xi + 2 * c[5] * eta]
    assert_allclose(found, wanted, atol=1e-12)
    assert_allclose(
        shapes(np.array([xi]), np.array([eta])) @ field(XI, ETA), field(xi, eta), atol=1e-12
    )


def bent(radius, angle):
    """An element on a cylinder about z, one unit high, and its unit normals outward."""
    turn = 0.5 * angle * XI
    outward = np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=-1)
    return radius * outward + 0.5 * ETA[:, None] * (0.0, 0.0, 1.0), outward


@pytest.mark.parametrize(("depth", "sound"), [(0.3, True), (0.9, True), (1.3, False)])
def test_a_wall_folds_where_it_is_thicker_than_its_radius(depth, sound):
    points, outward = bent(1.0, 0.5)
    least = wall_jacobians(points[None], depth * outward[None])
    assert (least[0] > 0.0) == sound
    flat, up = bent(1e3, 1e-3)
    assert_allclose(wall_jacobians(flat[None], 0.2 * up[None]), 0.25 * 0.2, rtol=1e-3)


@pytest.mark.parametrize(("angle", "one"), [(10.0, True), (60.0, False)])
def test_normals_are_shared_where_elements_look_nearly_the_same_way(angle, one):
    first, c, s = np.array([1.0, 0.0, 0.0]), np.cos(np.radians(angle)), np.sin(np.radians(angle))
    unit = np.stack([np.tile(first, (8, 1)), np.tile([c, s, 0.0], (8, 1))])
    quads = np.arange(16).reshape(2, 8)
    quads[1, [0, 3, 7]] = quads[0, [1, 2, 5]]
    found = shared_normals(unit, quads)
    half = np.radians(0.5 * angle)
    mean = np.array([np.cos(half), np.sin(half), 0.0])
    assert_allclose(found[0, [1, 2, 5]], np.tile(mean if one else first, (3, 1)), atol=1e-12)
    assert_allclose(found[1, [0, 3, 7]], np.tile(mean if one else unit[1, 0], (3, 1)), atol=1e-12)
    assert_allclose(found[0, [0, 3, 4, 6, 7]], np.tile(first, (5, 1)), atol=1e-12)


@given(st.floats(-3, 3), st.floats(1e-4, 0.1))
def test_one_layer_is_its_own_stand_in(angle, thickness):
    alone = even([(GLASS, thickness, 0.0)], thickness)
    assert_allclose([alone.along, alone.across, alone.shear], [4e10, 1e10, 4e9])
    assert_allclose([alone.poisson, alone.density], [0.28, 1900.0])
    assert_allclose(plane_stiffness(STEEL, angle), plane_stiffness(STEEL, 0.0), rtol=1e-9, atol=1.0)
    turned = plane_stiffness(GLASS, angle)
    assert_allclose(turned, turned.T, atol=1.0)
    trace = turned[0, 0] + turned[1, 1] + 2.0 * turned[0, 1]
    own = plane_stiffness(GLASS, 0.0)  # an invariant (Jones, eq. 2.95)
    assert_allclose(trace, own[0, 0] + own[1, 1] + 2.0 * own[0, 1], rtol=1e-9)
    other = even([(GLASS, thickness, np.pi / 2)], 2.0 * thickness)
    assert_allclose([other.along, other.across, other.density], [0.5e10, 2e10, 950.0])


@pytest.mark.parametrize("shape", ["model", "flat"])
def test_elements_meet_side_by_side_and_webs_share_the_skin_s_nodes(shape, request):
    mesh = request.getfixturevalue(shape).mesh
    corners = mesh.quads[:, [0, 1, 2, 3, 0]]
    sides = [
        (min(a, b), max(a, b), int(mid))
        for quad, row in zip(mesh.quads, corners, strict=True)
        for a, b, mid in zip(row[:4], row[1:], quad[4:], strict=True)
    ]
    assert len({side[:2] for side in sides}) == len(set(sides))  # one middle node a side
    skin = mesh.part == 0
    ends = {*mesh.root.tolist(), *mesh.tip.tolist()}
    for (a, b, _), count in Counter(sides[: 4 * int(skin.sum())]).items():
        assert count == (1 if {a, b} <= ends else 2)  # the skin is closed but for its ends
    assert (mesh.part[:-1] <= mesh.part[1:]).all()
    own = set(mesh.quads[skin].ravel().tolist())
    for web in range(1, 3):
        quads = mesh.quads[mesh.part == web]
        rows = len(np.unique(mesh.bay[mesh.part == web]))
        assert len({*quads.ravel().tolist()} & own) == 2 * (2 * rows + 1)
    assert len(np.unique(mesh.points, axis=0)) == len(mesh.points)


@pytest.mark.parametrize("mirrored", [False, True])
def test_the_skin_looks_outward_and_no_element_folds(blade, model, mirrored):
    made = shell_model(blade.mirror_image().layup, 2.0) if mirrored else model
    mesh, quality = made.mesh, made.quality
    assert quality["smallest_jacobian"] > 0.01
    assert quality["warping_deg"] < 60.0  # 2 m around the nose
    assert quality == pytest.approx(model.quality)
    skin = mesh.quads[mesh.part == 0]
    normals = corner_normals(mesh.points, skin)[:, :4].mean(axis=1)
    middles = mesh.points[skin[:, :4]].mean(axis=1)
    volume = 4.0 / 3.0 * np.einsum("mi,mi->", middles, normals)  # the divergence theorem
    assert_allclose(volume, blade.volume, rtol=0.06)  # less what closing trailing edges takes
    assert_allclose(made.mass, model.mass, rtol=1e-9)
    assert (np.abs(np.einsum("mi,mi->m", *made.axes)) < 1e-9).all()


def test_a_wide_trailing_edge_is_a_panel_of_its_own(flat):
    mesh, laid = flat.mesh, flat.blade.layup.at(np.unique(flat.mesh.eta))
    on = flat.sets["TRAILING_EDGE"]
    assert_allclose(mesh.edge[on].sum(axis=1), 1.0)
    assert not {*on.tolist()} & {*flat.sets["SUCTION_SIDE"].tolist()}
    assert not {*on.tolist()} & {*flat.sets["PRESSURE_SIDE"].tolist()}
    ((low, high),) = mesh.panels
    eta = np.linspace(low, high, 501)
    corners = flat.blade.sections(eta)[:, [0, -1]]
    width = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=-1)
    middles = corners.mean(axis=1)
    run = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(middles, axis=0), axis=-1)))
    assert_allclose(flat.areas[on].sum(), np.trapezoid(width, run), rtol=0.05)  # less its ends
    outward = np.cross(*(flat.mesh.points[mesh.quads[on][:, [1, 3]]] - flat.mesh.points[
        mesh.quads[on][:, :1]]).swapaxes(0, 1))  # fmt: skip
    nose = flat.blade.sections(mesh.eta[on])[:, 50]
    behind = mesh.points[mesh.quads[on, 0]] - nose
    assert (np.einsum("mi,mi->m", outward, behind) > 0.0).all()
    along, across = flat.axes
    assert (along[on, 2] > 0.9).all()
    assert_allclose(np.einsum("mi,mi->m", along[on], across[on]), 0.0, atol=1e-9)
    row = np.searchsorted(laid.eta, mesh.eta[on])
    for i, own in enumerate(flat.thickness[:, on]):
        covered = (laid.edge[i, row] * mesh.edge[on]).sum(axis=-1)
        assert_allclose(own, covered * laid.thickness[i, row], atol=1e-12)
    assert_allclose(flat.mass, flat.blade.layup.mass, rtol=0.02)
    assert flat.quality["smallest_jacobian"] > 0.0


def test_the_rim_of_a_panel_is_among_the_nodes_of_the_tip(flat):
    mesh = flat.mesh
    points = mesh.points[mesh.tip]
    corners = flat.blade.sections([1.0])[0, [0, -1]]
    for place in (*corners, corners.mean(axis=0)):
        assert np.linalg.norm(points - place, axis=-1).min() < 1e-6


@given(
    st.lists(st.floats(0.0, 0.2), min_size=3, max_size=40),
    st.floats(0.02, 1.0),
)
def test_panels_keep_apart_and_close_within_the_blade(width, size):
    width = np.array(width)
    made = panels(width, np.ones(len(width)), size)
    at = 0
    for panel in made:
        low, high = panel.reach
        assert 0 <= low <= panel.first < panel.last <= high < len(width)
        assert at <= low
        at = high
        assert (width[low + panel.closes[0] : high + 1 - panel.closes[1]] > WIDE).all()
    fine = np.interp(np.arange(2 * len(width) - 1) / 2, np.arange(len(width)), width)
    opened = openness(made, fine)
    for panel in made:
        assert (opened[2 * panel.first : 2 * panel.last + 1] == 1.0).all()
    covered = sum(np.isin(np.arange(len(width)), np.arange(p.reach[0] + p.closes[0], p.reach[1] + 1
                  - p.closes[1])) for p in made)  # fmt: skip
    assert ((opened[::2] > 0.0) == covered).all()


def test_a_trailing_edge_that_is_closed_is_said_with_its_place(model, flat):
    def place(of):
        (said,) = (one.message for one in of.findings if one.where == "shell: trailing edges")
        width, share, eta = map(float, re.findall(r"to (\d+) mm, (\d+) % .*? = (\d\.\d+)", said)[0])
        ends = of.blade.sections([eta])[0, [0, -1]]
        found = np.linalg.norm(ends[0] - ends[1])
        assert_allclose(found, 1e-3 * width, rtol=0, atol=1e-3)
        assert_allclose(found / of.blade.chord(eta), 0.01 * share, rtol=0, atol=0.005)
        return said

    assert "panel" not in place(model)
    corners = flat.blade.sections([0.5])[0, [0, -1]]
    wide = {"gap": float(np.linalg.norm(corners[1] - corners[0])), "widest": 0.5}
    said = place(replace(flat, mesh=replace(flat.mesh, **wide)))
    assert "too few rows of elements there for a panel" in said
    assert re.search(r"; they are panels of their own at eta = 0\.\d+ to 1\.000$", said)


def test_the_model_weighs_what_the_layers_weigh(blade, model):
    finer = shell_model(blade.layup, 1.0)
    assert_allclose(model.mass, blade.layup.mass, rtol=0.02)
    assert_allclose(finer.mass, blade.layup.mass, rtol=0.005)
    for i, layer in enumerate(model.structure.layers):
        density = model.structure.by_name[layer.material].density
        mass = density * finer.thickness[i] @ finer.areas
        assert_allclose(mass, blade.layup.layer_masses[layer.name], rtol=0.05, atol=5.0)


def read_inp(text):
    """Nodes, elements, sets and sections of a file, by a reader that shares no code with it."""
    blocks = re.split(r"^(?=\*[A-Z])", text, flags=re.MULTILINE)
    nodes, quads, sets, sections, density, name = {}, {}, {}, [], {}, ""
    for block in blocks:
        head, *rows = [line for line in block.splitlines() if not line.startswith("**")] or [""]
        options = dict(p.strip().split("=") for p in head.split(",")[1:] if "=" in p)
        if head.startswith("*NODE,"):
            nodes = {int(r.split(",")[0]): [float(x) for x in r.split(",")[1:]] for r in rows}
        elif head.startswith("*ELEMENT"):
            quads = {int(r.split(",")[0]): [int(x) for x in r.split(",")[1:]] for r in rows}
        elif head.startswith(("*ELSET", "*NSET")):
            own = [int(x) for r in rows for x in r.split(",") if x]
            sets[options.get("ELSET") or options["NSET"]] = own
        elif head.startswith("*MATERIAL"):
            name = options["NAME"]
        elif head.startswith("*DENSITY"):
            density[name] = float(rows[0])
        elif head.startswith("*SHELL SECTION"):
            sections.append((options, [r.split(",") for r in rows]))
    return nodes, quads, sets, sections, density


def test_a_file_holds_sets_and_laminates_that_weigh_the_same(model):
    text = "\n".join(inp_lines(model, laminates=True))
    nodes, quads, sets, sections, density = read_inp(text)
    weighed, held = 0.0, []
    for options, rows in sections:
        heavy = sum(float(t) * density[material.strip()] for t, _, material, _ in rows)
        for number in sets[options["ELSET"]]:
            a, b, c, d, *middles = (np.array(nodes[i]) for i in quads[number])
            ring = np.array([a, middles[0], b, middles[1], c, middles[2], d, middles[3]])
            out = ring - ring.mean(axis=0)
            fan = np.cross(out, np.roll(out, -1, axis=0))
            weighed += heavy * 0.5 * np.linalg.norm(fan, axis=-1).sum()
        held += sets[options["ELSET"]]
        assert options["OFFSET"] == ("0" if "_web" in options["ELSET"] else "0.5")
    assert_allclose(weighed, model.mass, rtol=5e-3)  # flat triangles there
    assert sorted(held) == sorted(quads)  # each element once
    assert {"ROOT", "TIP", "SKIN", "WEB_web0", "LAYER_Spar_Cap_SS", "PRESSURE_SIDE"} <= set(sets)
    assert_allclose([nodes[i][2] for i in sets["ROOT"]], 0.0, atol=1e-9)
    cap = [quads[i] for i in sets["LAYER_Spar_Cap_SS"]]
    assert set(sets["LAYER_Spar_Cap_SS"]) <= set(sets["SUCTION_SIDE"])
    assert len(cap) >= len(np.unique(model.mesh.bay))
    even_text = "\n".join(inp_lines(model))
    assert "COMPOSITE" not in even_text
    assert read_inp(even_text)[:2] == (nodes, quads)


def test_long_names_stay_apart_and_lines_short(flat):
    long = "w" * 150
    webs = tuple(replace(web, name=long + web.name) for web in flat.structure.webs)
    layers = tuple(
        replace(one, name=long + one.name, web=long + one.web if one.web else "")
        for one in flat.structure.layers
    )
    again = replace(flat, structure=replace(flat.structure, webs=webs, layers=layers))
    for laminates in (False, True):
        lines = [*inp_lines(again, laminates=laminates)]
        assert max(map(len, lines)) <= 256
        assert max(map(len, re.findall(r"\w+", "\n".join(lines)))) <= 80
        heads = [line for line in lines if line.startswith("*ELSET")]
        assert len(set(heads)) == len(heads)


def test_walls_of_even_material_weigh_what_their_laminates_do(model):
    """CalculiX gives a wall the thickness between nodes that its shape functions have."""
    text = "\n".join(inp_lines(model))
    nodal = np.zeros(len(model.mesh.points))
    said = text.split("*NODAL THICKNESS\n")[1].split("\n*")[0]
    for line in said.splitlines():
        node, thickness = line.split(", ")
        nodal[int(node) - 1] = float(thickness)
    densities = [float(one) for one in re.findall(r"\*DENSITY\n(\S+)", text)]
    nodes, weights = np.polynomial.legendre.leggauss(4)
    xi, eta = (one.reshape(-1) for one in np.meshgrid(nodes, nodes))
    corners = model.mesh.points[model.mesh.quads]
    tangents = slopes(xi, eta) @ corners[:, None]
    sizes = np.linalg.norm(np.cross(tangents[..., 0, :], tangents[..., 1, :]), axis=-1)
    thick = nodal[model.mesh.quads] @ shapes(xi, eta).T
    walls = (sizes * thick) @ np.outer(weights, weights).reshape(-1)
    materials = model.structure.by_name
    sections = [one for one in model.sections if one.layers]
    assert len(sections) > 300
    for section, density in zip(sections, densities, strict=True):
        if section.skin:
            area = sum(
                t * materials[model.structure.layers[i].material].density for i, t in section.layers
            )
            wanted = area * model.areas[section.elements].sum()
            assert_allclose(density * walls[section.elements].sum(), wanted, rtol=1e-4)


def test_walls_do_not_fold_inside(model):
    thick = nodal_thickness(model)
    mesh = model.mesh
    skin = mesh.quads[mesh.part == 0]
    normals = corner_normals(mesh.points, skin)
    unit = normals / np.linalg.norm(normals, axis=-1, keepdims=True)
    inner = (mesh.points[skin] - thick[skin][..., None] * unit).reshape(-1, 3)
    turned = corner_normals(inner, np.arange(len(inner)).reshape(-1, 8))
    assert (np.einsum("mni,mni->mn", turned, unit) > 0.0).all()


def test_a_tube_swings_and_bends_as_a_beam_does(tmp_path):
    """Euler and Bernoulli: f = 1.8751^2 / (2 pi L^2) sqrt(EI / m), tip F L^3 / (3 EI)."""
    model = shell_model(tube(("wall", STEEL, WALL, 0.0)), 0.8)
    frequencies, weight, moved = solved(model, tmp_path)
    middle = RADIUS - 0.5 * WALL
    area = 2.0 * np.pi * middle * WALL
    stiff = 2e11 * np.pi * middle**3 * WALL
    wanted = 1.8751**2 / (2.0 * np.pi * LENGTH**2) * np.sqrt(stiff / (7800.0 * area))
    assert_allclose(frequencies[:2], wanted, rtol=0.01)
    assert_allclose(weight, 7800.0 * area * LENGTH * GRAVITY, rtol=0.005)
    assert_allclose(moved[:, 0].mean(), FORCE * LENGTH**3 / (3.0 * stiff), rtol=0.01)


def test_laminates_of_one_thickness_swing_as_the_even_material_does(tmp_path):
    skins = [("out", GLASS, 0.01, 0.0), ("mid", GLASS, 0.02, 0.6), ("in", GLASS, 0.01, 0.0)]
    model = shell_model(tube(*skins), 2.0)
    found = []
    for laminates in (False, True):
        folder = tmp_path / str(laminates)
        folder.mkdir()
        found.append(solved(model, folder, laminates=laminates)[0][:2])
    assert_allclose(*found, rtol=0.03)


def test_the_iea_15_mw_swings_near_what_is_published(blade, tmp_path):
    frequencies, weight, _ = solved(shell_model(blade.layup, 3.0), tmp_path)
    assert_allclose(frequencies[:2], PUBLISHED, rtol=0.10)
    assert_allclose(weight / GRAVITY, blade.layup.mass, rtol=0.05)


def test_the_command_line_makes_one_and_reports_on_it(tmp_path):
    done = CliRunner().invoke(
        commands.app,
        ["build", "iea15mw", "-o", str(tmp_path), "--format", "inp", "--element", "4m"],
    )
    assert done.exit_code == 0, done.output
    report = json.loads((tmp_path / "iea15mw.report.json").read_text())
    nodes, quads, *_ = read_inp((tmp_path / "iea15mw.inp").read_text())
    assert report["shell"]["elements"] >= len(quads)
    assert report["shell"]["nodes"] == len(nodes)
    assert report["shell"]["smallest_jacobian"] > 0.0
    assert any("trailing edges: are closed" in said for said in report["remarks"])


def test_what_cannot_be_made_is_said(blade, tmp_path):
    with pytest.raises(ExportError, match="no webs and layers"):
        bg.export(bg.Blade.from_definition(bg.read("dtu10mw")), tmp_path / "a.inp")
    with pytest.raises(GeometryError, match=r"element: got 0.001 m, allowed is 0.02 to 20 m"):
        shell_model(blade.layup, 0.001)
    bare = replace(GLASS, E=None)
    with pytest.raises(ExportError, match="material glass: E and nu are needed"):
        plane_stiffness(bare, 0.0)
