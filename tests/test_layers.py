"""Rooms import one way, heavy libraries come late, and public names are at hand."""

import ast
import graphlib
import subprocess
import sys
from pathlib import Path

import pytest

import bladegen

PACKAGE = Path(bladegen.__file__).parent
ROOMS = """errors support airfoils shapes definition blade variants formats surface cad measures
views exports families studio cli""".split()  # noqa: SIM905
HEAVY = set(
    """OCP PIL cadquery distributed fastapi h5py imageio_ffmpeg matplotlib neuralfoil nicegui numba
    openpyxl pyarrow pyvista ruamel scipy trimesh uvicorn vtkmodules zarr""".split()  # noqa: SIM905
)
COMPILED = set("compiled workers plane_maps characteristics section_measures sizes kernels".split())  # noqa: SIM905
TREES = {p: ast.parse(p.read_text(encoding="utf-8")) for p in sorted(PACKAGE.rglob("*.py"))}
NAMES = {".".join(p.relative_to(PACKAGE.parent).with_suffix("").parts): p for p in TREES}


def imports(tree):
    """The modules that a tree imports."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            whole = [f"{node.module}.{alias.name}" for alias in node.names]
            yield from (name if name in NAMES else node.module for name in whole)


INSIDE = {
    name: {n for n in imports(TREES[path]) if n in NAMES and n != name}
    for name, path in NAMES.items()
}


def room(name):
    return name.split(".")[1]


@pytest.mark.parametrize("name", [n for n in NAMES if room(n) in ROOMS])
def test_imports_lead_to_rooms_below(name):
    below = ROOMS[: ROOMS.index(room(name)) + 1]
    assert {room(other) for other in INSIDE[name]} <= set(below)
    assert "importlib.import_module" not in ast.unparse(TREES[NAMES[name]])


def test_no_modules_import_each_other():
    graphlib.TopologicalSorter(INSIDE).prepare()


@pytest.mark.parametrize("name", [n for n in NAMES if n.split(".")[-1] not in COMPILED])
def test_heavy_libraries_are_imported_late(name):
    body = [n for n in TREES[NAMES[name]].body if isinstance(n, ast.Import | ast.ImportFrom)]
    loaded = {n.split(".")[-1 if n in NAMES else 0] for n in imports(ast.Module(body, []))}
    assert not loaded & (HEAVY | COMPILED)


def run(code):
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout


def test_light_commands_load_nothing_heavy():
    code = (
        "import sys, bladegen; bladegen.read('iea15mw'); import bladegen.cli.commands;"
        "print(*sorted({m.split('.')[0] for m in sys.modules}))"
    )
    assert not set(run(code).split()) & HEAVY


def test_public_names_are_there_and_not_hidden_by_rooms():
    code = (
        "import bladegen.exports.build, bladegen.families.run, bladegen as bg;"
        "print(callable(bg.export), callable(bg.family), set(dir(bg)) == set(bg.__all__),"
        "all(getattr(bg, name) is not None for name in (*bg.__all__, 'grassmann', 'affine')))"
    )
    assert set(run(code).split()) == {"True"}
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = bladegen.nonsense


def test_no_module_is_longer_than_300_lines():
    assert not [n for n, p in NAMES.items() if len(p.read_text("utf-8").splitlines()) > 300]
