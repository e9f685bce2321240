"""What is shipped: a wheel and an sdist that hold the blades and the shape space, and work."""

import os
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet

import bladegen
from strategies import by_day

CORE = """
import sys
import bladegen as bg
blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101)
blade = blade.perturbed(bg.ShapeSpace.bundled(), [0.01, 0.0, 0.0, 0.0], thickness=1.05)
for suffix in sys.argv[1].split():
    bg.export(blade, f"blade.{suffix}")
    print(suffix)
print("volume", bg.read("blade.yaml").name, bg.read("blade.dat").length)
print("heavy", *{"vtkmodules", "numba", "pyarrow", "casadi", "cadquery"} & set(sys.modules))
try:
    bg.export(blade, "blade.png")
except bg.BladegenError as error:
    print(error)
"""
SUFFIXES = "step iges brep stl glb obj ply cgns p3d yaml dat htc csv"
MOST = 650  # MB of an environment without pictures
ROOT = Path(bladegen.__file__).parent.parent
BLADES = ("dtu10mw", "iea15mw", "nrel5mw")
RUN = "import sys; from bladegen.cli.commands import main; sys.argv[0] = 'bladegen'; main()"


@pytest.fixture(scope="module")
def dist(tmp_path_factory):
    """Wheel and sdist, built as they would be for a release."""
    target = tmp_path_factory.mktemp("dist")
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-d", str(target)],
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    return next(target.glob("*.whl")), next(target.glob("*.tar.gz"))


@pytest.fixture(scope="module")
def unpacked(dist, tmp_path_factory):
    """A folder that holds what the wheel installs, and nothing else of this checkout."""
    target = tmp_path_factory.mktemp("site")
    with zipfile.ZipFile(dist[0]) as wheel:
        wheel.extractall(target)
    return target


def test_the_wheel_holds_blades_space_types_and_licence(dist):
    with zipfile.ZipFile(dist[0]) as wheel:
        names = set(wheel.namelist())
    assert {f"bladegen/blades/{name}.yaml" for name in BLADES} <= names
    assert {"bladegen/shapes/reference.npz", "bladegen/py.typed"} <= names
    assert any(name.endswith("licenses/LICENSE") for name in names)
    assert not any(name.startswith(("tests/", "docs/", "benchmarks/")) for name in names)


def test_the_sdist_holds_what_tests_and_documentation_need(dist):
    with tarfile.open(dist[1]) as sdist:
        names = {name.split("/", 1)[1] for name in sdist.getnames() if "/" in name}
    needed = ("blades/iea15mw.yaml", "tests/strategies.py", "docs/guide.md", "mkdocs.yml")
    assert {*needed, "CONTRIBUTING.md", "CHANGELOG.md", "Makefile", "scripts/setup.sh"} <= names


def test_a_wheel_can_be_made_from_the_sdist(dist, tmp_path):
    with tarfile.open(dist[1]) as sdist:
        sdist.extractall(tmp_path, filter="data")
    source = next(tmp_path.iterdir())
    done = subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path / "again")],
        cwd=source,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    again = next((tmp_path / "again").glob("*.whl"))
    with zipfile.ZipFile(dist[0]) as one, zipfile.ZipFile(again) as two:
        assert set(one.namelist()) == set(two.namelist())


@pytest.mark.parametrize("name", by_day("nrel5mw"))
def test_blades_are_built_from_what_the_wheel_installs(unpacked, tmp_path, name):
    words = ["build", name, "-o", str(tmp_path), "--format", "stl", "--stations", "20"]
    done = subprocess.run(
        [sys.executable, "-c", RUN, *words, "--landmarks", "101"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(unpacked)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / f"{name}.stl").stat().st_size > 10_000


def test_it_is_the_wheel_that_runs_there(unpacked, tmp_path):
    code = "import bladegen; print(bladegen.__file__); bladegen.ShapeSpace.bundled()"
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(unpacked)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.startswith(str(unpacked))


@pytest.mark.nightly
def test_the_core_alone_reads_perturbs_and_writes(dist, tmp_path):
    """locks/core.txt in a fresh environment, without what its libraries would bring along."""
    subprocess.run([sys.executable, "-m", "venv", str(tmp_path / "core")], check=True)
    python = tmp_path / "core" / "bin" / "python"
    pip = [python, "-m", "pip", "install", "--quiet", "--no-deps"]
    subprocess.run([*pip, "-r", ROOT / "locks" / "core.txt"], check=True)
    subprocess.run([*pip, dist[0]], check=True)
    folder = tmp_path / "core"
    size = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
    assert size < MOST * 1e6
    plain = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}

    def run(*words):
        return subprocess.run(
            [python, *words], cwd=tmp_path, env=plain, capture_output=True, text=True, check=False
        )

    done = run("-c", CORE, SUFFIXES)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert lines[:-3] == SUFFIXES.split()
    assert lines[-2] == "heavy"
    assert "pip install pyvista" in lines[-1]
    for words in ("preview nrel5mw --screenshot a.png", "family nrel5mw -o f --count 2"):
        said = run("-m", "bladegen", *words.split())
        assert said.returncode == 1
        assert len(said.stderr.strip().splitlines()) == 1
        assert "pip install" in said.stderr


def test_the_conda_recipe_asks_for_what_the_package_asks_for():
    """Names differ from the package index's where conda-forge has others."""
    recipe = yaml.safe_load((ROOT / "packaging/conda/recipe.yaml").read_text(encoding="utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    ours = {Requirement(text).name.lower(): Requirement(text) for text in project["dependencies"]}
    others = {"ocp": "cadquery-ocp", "matplotlib-base": "matplotlib"}
    theirs = {}
    for text in recipe["requirements"]["run"]:
        name, _, allowed = text.partition(" ")
        theirs[others.get(name, name)] = SpecifierSet(allowed)
    assert theirs.pop("python") == SpecifierSet(project["requires-python"])
    assert theirs == {name: requirement.specifier for name, requirement in ours.items()}
    assert recipe["context"]["version"] == bladegen.__version__


def test_the_container_holds_what_the_build_reads():
    """What the Dockerfile copies is not kept back, and is all that hatchling asks for."""
    lines = (ROOT / "Dockerfile").read_text(encoding="utf-8").splitlines()
    copied = {Path(word) for line in lines if line.startswith("COPY ") for word in line.split()[1:]}
    kept = {
        Path(line[1:])
        for line in (ROOT / ".dockerignore").read_text(encoding="utf-8").splitlines()
        if line.startswith("!")
    }
    needed = {Path(name) for name in ("bladegen", "blades", "LICENSE", "README.md", "locks")}
    assert needed <= copied
    assert needed <= kept
    assert all((ROOT / path).exists() for path in kept)
