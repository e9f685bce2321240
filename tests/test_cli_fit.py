"""`bladegen fit` as users call it."""

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cli import commands

RUN = CliRunner()


def run(*arguments):
    return RUN.invoke(commands.app, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def stl(tmp_path_factory):
    """A blade in millimetres, as files of unknown origin are."""
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=61)
    path = tmp_path_factory.mktemp("fit") / "unknown.stl"
    return bg.export(blade, path, stations=40, unit="mm")


def test_one_command_makes_a_definition_a_report_and_says_how_good_it_is(
    stl, tmp_path, foreign_here, monkeypatch
):
    from bladegen.fitting import fit as module

    plain, made = module.fit, []
    monkeypatch.setattr(module, "fit", lambda *a, **k: made.append(plain(*a, **k)) or made[0])
    target = tmp_path / "blade.yaml"
    result = run("fit", stl, "-o", target, "--tolerance", "30mm", "--name", "found")
    assert result.exit_code == 0, result.output
    assert "taken to be in mm" in result.output
    assert "nearest" in result.output
    definition, known = bg.read(target), bg.read("nrel5mw")
    eta = np.linspace(0.2, 0.95, 20)
    assert_allclose(definition.chord(eta), known.chord(eta), atol=0.01)
    report = json.loads((tmp_path / "blade.fit.json").read_text())
    assert report["held"] is True
    assert report["blade"] == "found"
    assert report["scale"] == 1e-3
    assert report["percentile_99_mm"] < 30.0
    assert len(report["airfoils"]) == report["stations"]
    assert "command=bladegen fit unknown.stl" in target.read_text()

    # a missed tolerance is said, and the files are there
    monkeypatch.setattr(module, "fit", lambda *_, **__: replace(made[0], tolerance=1e-4))
    target = tmp_path / "missed.yaml"
    result = run("fit", stl, "-o", target, "--json")
    assert result.exit_code == 1
    assert "allowed is 0.1 mm; it is worst at" in str(result.exception)
    assert json.loads(result.output)["held"] is False
    assert bg.read(target).length == pytest.approx(61.5, abs=0.01)


def test_a_noisy_scan_with_holes_becomes_a_file(tmp_path):
    """From points in a file to a definition, a mesh, and what lies between them and the blade."""
    import trimesh

    known = bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=101)
    rng = np.random.default_rng(4)
    points, _ = trimesh.sample.sample_surface(known.mesh(stations=60), 60_000, seed=4)
    whole = len(points)
    points = points + 0.003 * rng.normal(size=points.shape)
    while len(points) > 0.8 * whole:  # a fifth is missing in patches
        centre = points[rng.integers(len(points))]
        points = points[np.linalg.norm(points - centre, axis=1) > 1.0]
    scan, target = tmp_path / "scan.xyz", tmp_path / "blade.yaml"
    np.savetxt(scan, rng.permutation(points), fmt="%.4f")
    result = run("fit", scan, "-o", target, "--tolerance", "50mm")
    assert result.exit_code == 0, result.output
    assert "points, smoothed; they scatter by" in result.output
    report = json.loads((tmp_path / "blade.fit.json").read_text())
    assert report["noise_mm"] == pytest.approx(3.0, rel=0.5)
    definition, eta = bg.read(target), np.linspace(0.15, 0.9, 30)
    assert definition.length == pytest.approx(known.definition.length, abs=0.3)
    assert_allclose(definition.chord(eta), known.chord(eta), atol=0.1)
    assert_allclose(definition.twist(eta), known.twist(eta), atol=np.radians(2.0))
    made = bg.Blade.from_definition(definition)
    bg.export(made, tmp_path / "again.stl")
    assert trimesh.load(tmp_path / "again.stl").is_watertight
