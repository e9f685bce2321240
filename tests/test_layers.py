"""Rooms import one way, and heavy libraries come late."""

import ast
import graphlib
import sys
from pathlib import Path

import pytest

import bladegen

PACKAGE = Path(bladegen.__file__).parent
ROOMS = """errors version support curves airfoils shapes definition blade neuralfoil formats
surface cad measures parametric fitting views exports families studio cli""".split()  # noqa: SIM905
LIGHT = {*sys.stdlib_module_names, "bladegen", "numpy", "rich", "typer", "yaml"}
TREES = {p: ast.parse(p.read_text(encoding="utf-8")) for p in sorted(PACKAGE.rglob("*.py"))}
NAMES = {".".join(p.relative_to(PACKAGE.parent).with_suffix("").parts): p for p in TREES}


def imports(tree):
    """The modules that a tree imports."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            whole = (f"{node.module}.{alias.name}" for alias in node.names)
            yield from (name if name in NAMES else node.module for name in whole)


ROOM = {n: n.split(".")[1] for n in NAMES}
INSIDE = {n: (set(imports(TREES[p])) & set(NAMES)) - {n} for n, p in NAMES.items()}
HEADS = {
    n: {*imports(ast.Module([i for i in TREES[p].body if hasattr(i, "names")], []))}
    for n, p in NAMES.items()
}
LATE = {"bladegen.support.compiled", "bladegen.support.workers"}
LATE |= {n for n in NAMES if "bladegen.support.compiled" in HEADS[n]}  # compiled loops


@pytest.mark.parametrize("name", [n for n in NAMES if ROOM[n] in ROOMS])
def test_imports_lead_to_rooms_below(name):
    assert {ROOM[other] for other in INSIDE[name]} <= {*ROOMS[: ROOMS.index(ROOM[name]) + 1]}
    assert "importlib.import_module" not in ast.unparse(TREES[NAMES[name]])
    adapters = {"bladegen.openmdao", "bladegen.torch", "bladegen.jax", "bladegen.wisdem"}
    assert not INSIDE[name] & adapters


@pytest.mark.parametrize("package", sorted({name.rpartition(".")[0] for name in NAMES}))
def test_neither_modules_nor_packages_import_each_other(package):
    part = {n: n.removeprefix(f"{package}.").split(".")[0] for n in NAMES if f"{package}." in n}
    graph = graphlib.TopologicalSorter()
    for name, child in part.items():
        graph.add(child, *{part[other] for other in INSIDE[name] & set(part)} - {child})
    graph.prepare()


@pytest.mark.parametrize("name", [n for n in NAMES if n not in LATE])
def test_heavy_libraries_are_imported_late(name):
    assert {other.split(".")[0] for other in HEADS[name]} <= LIGHT
    assert not HEADS[name] & LATE
