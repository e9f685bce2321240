from dataclasses import replace

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose
from PIL import Image
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cad.rotor import rotor_of, write_glb
from bladegen.cli import commands
from bladegen.cli.options.perturbing import Changes
from bladegen.cli.view import What
from bladegen.errors import BladegenError
from bladegen.surface.mesh import from_blade
from bladegen.views import preview, sweep
from bladegen.views.plots.blade_plots import PLOTS
from bladegen.views.plots.figures import figure
from bladegen.views.rendering import keys

pytestmark = pytest.mark.usefixtures("foreign_here")


def run(*words):
    return CliRunner().invoke(commands.app, [str(word) for word in words])


@pytest.fixture
def small(monkeypatch):
    """Sweeps in small pictures."""
    original = sweep.frames
    monkeypatch.setattr(
        sweep, "frames", lambda motion, **options: original(motion, size=(320, 180), **options)
    )


@pytest.mark.parametrize("edge", ["given", "sharp"])
def test_preview_writes_pictures_and_pages(edge, tmp_path):
    png, html = tmp_path / "a.png", tmp_path / "a.html"
    result = run(
        "preview", "nrel5mw", "--screenshot", png, "--html", html, "--landmarks", 101,
        "--trailing-edge", edge, "--colour", "curvature",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    assert result.output.split() == ["wrote", str(png), "wrote", str(html)]
    assert png.stat().st_size > 10_000
    assert '"colour": "curvature"' in html.read_text(encoding="utf-8")


def test_preview_opens_a_window_of_a_perturbed_blade(monkeypatch):
    shown = []
    monkeypatch.setattr(preview, "require_window", lambda: None)
    monkeypatch.setattr(preview, "show", lambda scene, **options: shown.append((scene, options)))
    assert run("preview", "nrel5mw", "--landmarks", 51).exit_code == 0
    assert run("preview", "nrel5mw", "--landmarks", 51, "--twist", 2).exit_code == 0
    (plain, first), (turned, second) = shown
    assert (plain.title, first) == ("NREL 5 MW", {"colour": "plain"})
    assert turned.title == "NREL 5 MW; perturbed: twist 2 deg"
    assert second == {"colour": "distance"}
    assert turned.field("distance").values.max() > 10


def test_preview_shows_the_rotor_that_build_writes(tmp_path, monkeypatch):
    png, html = tmp_path / "a.png", tmp_path / "a.html"
    asked = ["preview", "nrel5mw", "--rotor", "--hub-radius", "2m", "--landmarks", 101]
    result = run(*asked, "--screenshot", png, "--html", html)
    assert result.exit_code == 0, result.output
    assert result.output.split() == ["wrote", str(png), "wrote", str(html)]
    shown = []
    monkeypatch.setattr(preview, "require_window", lambda: None)
    monkeypatch.setattr(preview, "show", lambda scene, **options: shown.append(scene))
    assert run(*asked, "--mirror").exit_code == 0
    (scene,) = shown
    assert scene.caption.startswith("3 blades, 126.9 m across, hub radius 2 m, precone 2.5 deg")
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101).mirror_image()
    write_glb(rotor_of(blade, hub_radius=2.0), from_blade(blade), tmp_path / "rotor.glb")
    built = np.array(trimesh.load(tmp_path / "rotor.glb").bounds)  # y up in the file
    bounds = [scene.surface.vertices.min(axis=0), scene.surface.vertices.max(axis=0)]
    assert_allclose(
        np.sort(np.abs(bounds), axis=None), np.sort(np.abs(built), axis=None), atol=0.01
    )
    upright = np.asarray(Image.open(png).convert("L"))[200:900, 60:820] < 245
    assert 0.01 < upright.mean() < 0.2


def test_preview_writes_sweeps(small, tmp_path):
    gif, film = tmp_path / "a.gif", tmp_path / "a.mp4"
    result = run(
        "preview", "nrel5mw", "--gif", gif, "--mp4", film, "--frames", 4, "--sweep", "twist=-3:3",
        "--sweep", "t1=-0.05:0.05", "--landmarks", 101,
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    assert f"wrote {gif}: 4 frames" in result.output
    assert Image.open(gif).n_frames == 4
    assert film.stat().st_size > 1000


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["preview"], "preview: name a blade"),
        (["preview", "nrel5mw", "--sweep", "t1=0:1"], "sweep: needs --gif or --mp4"),
        (["preview", "nrel5mw", "--gif", "a.gif", "--sweep", "t1"], "sweep: got 't1', must be"),
        (["preview", "nrel5mw", "--hub-radius", "2m"], "hub-radius, precone: are of the rotor"),
        (["preview", "nrel5mw", "--rotor", "--colour", "curvature"], "rotor: is shown plain"),
        (["preview", "nrel5mw", "--rotor", "--gif", "a.gif"], "rotor: is shown plain"),
        (["preview", "nrel5mw", "--compare", "a", "b"], "compare: takes two"),
        (["preview", "nrel5mw", "--screenshot", "a.png", "--colour", "distance"], "a baseline"),
        (
            ["plot", "nrel5mw", "-o", "a.png"],
            f"for {len(PLOTS) - 1} diagrams, must be a folder or a .pdf",
        ),
        (["plot", "nrel5mw", "-o", "a.bmp"], "suffix '.bmp', allowed are .png, .svg, .pdf"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_what_cannot_be_shown_is_said_in_a_line(words, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run(*words)
    assert isinstance(result.exception, BladegenError)
    assert message in str(result.exception)
    assert "\n" not in str(result.exception)
    assert list(tmp_path.iterdir()) == []


def test_preview_compares_two(tmp_path, monkeypatch):
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=51)
    one = bg.export(blade, tmp_path / "one.stl", stations=40)
    other = bg.export(blade.perturbed(twist=0.02), tmp_path / "other.stl", stations=40, unit="mm")
    png, html = tmp_path / "a.png", tmp_path / "a.html"
    result = run("preview", "--compare", one, other, "--screenshot", png, "--html", html)
    assert result.exit_code == 0, result.output
    assert "names no unit and is taken to be in millimetres" in result.output
    assert "distance of its vertices from the other, mm" in html.read_text(encoding="utf-8")
    image = np.asarray(Image.open(png).convert("RGB")).astype(int)
    assert np.count_nonzero(np.abs(image[..., 0] - image[..., 1]) > 40) > 1000
    shown = []
    monkeypatch.setattr(preview, "require_window", lambda: None)
    monkeypatch.setattr(preview, "show", lambda scene, **options: shown.append((scene, options)))
    assert run("preview", "--compare", one, other).exit_code == 0
    assert shown[0][0].names == ("sections", "baseline")
    assert shown[0][1] == {"colour": "distance"}


def test_plot_writes_a_file_a_diagram(tmp_path, monkeypatch):
    plain = replace(PLOTS["path"], draw=lambda *_: figure(1, 1, width=2, height=2)[0])
    for name in {*PLOTS} - {"path"}:  # what each of them draws tells test_blade_plots
        monkeypatch.setitem(PLOTS, name, plain)
    result = run("plot", "nrel5mw", "-o", tmp_path / "out", "--format", "svg", "--landmarks", 101)
    assert result.exit_code == 0, result.output
    names = sorted(file.name for file in (tmp_path / "out").iterdir())
    others = {What.all, What.volume}  # what may be refused is to be asked for
    assert names == sorted(f"nrel5mw-{what}.svg" for what in What if what not in others)
    assert "Grassmannian" in (tmp_path / "out" / "nrel5mw-path.svg").read_text(encoding="utf-8")
    assert "<svg" in (tmp_path / "out" / "nrel5mw-grid.svg").read_text(encoding="utf-8")


def test_plot_writes_one_file(tmp_path):
    pdf, png = tmp_path / "all.pdf", tmp_path / "one.png"
    two = ("--what", "planform", "--what", "path")
    assert run("plot", "nrel5mw", "-o", pdf, "--twist", 1, "--landmarks", 101, *two).exit_code == 0
    assert pdf.read_bytes().count(b"/Type /Page ") == 2
    result = run("plot", "nrel5mw", "-o", png, "--what", "planform", "--landmarks", 101)
    assert result.output == f"wrote {png}\n"
    assert Image.open(png).size[0] > 1000


def test_help_lists_keys_and_the_options_of_perturb():
    page = " ".join(run("preview", "--help").output.split())
    for key, about in (keys.LAYERS | keys.COLOURS).items():
        assert f"{key} {about.help}".split()[1] in page
    for command in ("preview", "plot", "perturb"):
        text = run(command, "--help").output
        for option in ("--pga", "--thickness", "--prebend-scale", "--allow-extrapol"):
            assert option in text, command


def test_changes_are_asked_when_they_differ_from_the_identity():
    assert not Changes(name="a").asked
    assert Changes(twist=1.0).asked
    assert Changes(pga=["0,0,0,0"]).asked
