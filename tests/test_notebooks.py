"""Notebooks run on a family and draw, and pages show them."""

import importlib.util
import re
from pathlib import Path

import pytest

import bladegen as bg
from bladegen.families.order import Order
from bladegen.families.run import run

HOME = Path(__file__).parent.parent
NOTEBOOKS = sorted((HOME / "examples" / "notebooks").glob("*.py"))
BY_DAY = ("open_family",)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder that holds a small family like the one of the notebooks."""
    target = tmp_path_factory.mktemp("notebooks")
    bounds = {"thickness": (0.95, 1.05), "chord": (0.95, 1.05), "twist": (-0.035, 0.035)}
    planned = bg.family(
        bg.Blade.from_definition(bg.read("iea15mw")),
        bg.ShapeSpace.bundled(),
        **{"count": 12, "seed": 7, "spans": 12, "reach": 0.5, "bounds": bounds},
    )
    run(Order(planned, target / "family", labels=("rotor", "mass")))
    return target


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(path, id=path.stem, marks=[] if path.stem in BY_DAY else pytest.mark.nightly)
        for path in NOTEBOOKS
    ],
)
def test_notebooks_run_and_draw(command, folder, path):
    done = command(script=path, folder=folder)
    assert done["status"] == 0, done["err"]
    assert (folder / f"{path.stem}.png").stat().st_size > 10_000


def test_pages_show_notebooks_with_their_pictures():
    spec = importlib.util.spec_from_file_location("notebooks", HOME / "scripts" / "notebooks.py")
    hook = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(hook)
    page = (HOME / "docs" / "notebooks.md").read_text(encoding="utf-8")
    names = re.findall(r"<!-- notebook: examples/notebooks/(\w+)\.py -->", page)
    assert sorted(names) == [path.stem for path in NOTEBOOKS]
    for path in NOTEBOOKS:
        shown = hook.rendered(path.read_text(encoding="utf-8"))
        assert shown.startswith("## ")
        assert "# %%" not in shown
        assert len(re.findall("^```", shown, re.MULTILINE)) % 2 == 0
        (name,) = re.findall(r"!\[[^\]]+\]\(images/notebook-(\w+)\.png\)", shown)
        assert name == path.stem
        assert (HOME / "docs" / "images" / f"notebook-{name}.png").is_file()
