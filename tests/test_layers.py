"""Rooms import one way, and heavy libraries come late."""

import ast
import graphlib
import sys
from functools import cache
from pathlib import Path

import pytest

import bladegen

PACKAGE = Path(bladegen.__file__).parent
ROOMS = """errors version support curves airfoils shapes definition blade neuralfoil formats
surface cad measures parametric fitting views exports families studio cli""".split()  # noqa: SIM905
LIGHT = {*sys.stdlib_module_names, "bladegen", "numpy", "rich", "typer", "yaml"}
PATHS = sorted(PACKAGE.rglob("*.py"))
NAMES = {".".join(p.relative_to(PACKAGE.parent).with_suffix("").parts): p for p in PATHS}
ROOM = {n: n.split(".")[1] for n in NAMES}
COMPILED = "bladegen.support.compiled"


@cache
def tree(name):
    """A module's syntax."""
    return ast.parse(NAMES[name].read_text(encoding="utf-8"))


def imports(nodes):
    """The modules that some statements import."""
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            whole = (f"{node.module}.{alias.name}" for alias in node.names)
            yield from (name if name in NAMES else node.module for name in whole)


@cache
def inside(name):
    """The modules of ours that one imports, anywhere in it."""
    return {*imports(ast.walk(tree(name)))} & {*NAMES} - {name}


@cache
def heads(name):
    """What a module imports when it is imported."""
    return {*imports(tree(name).body)}


def is_late(name):
    """Tell compiled loops, and what makes them and other processes, from all that comes early."""
    return name in (COMPILED, "bladegen.support.workers") or COMPILED in heads(name)


@pytest.mark.parametrize("name", [n for n in NAMES if ROOM[n] in ROOMS])
def test_imports_lead_to_rooms_below(name):
    assert {ROOM[other] for other in inside(name)} <= {*ROOMS[: ROOMS.index(ROOM[name]) + 1]}
    assert "importlib.import_module" not in ast.unparse(tree(name))
    adapters = {"bladegen.openmdao", "bladegen.torch", "bladegen.jax", "bladegen.wisdem"}
    assert not inside(name) & adapters


@pytest.mark.parametrize("package", sorted({name.rpartition(".")[0] for name in NAMES}))
def test_neither_modules_nor_packages_import_each_other(package):
    part = {n: n.removeprefix(f"{package}.").split(".")[0] for n in NAMES if f"{package}." in n}
    graph = graphlib.TopologicalSorter()
    for name, child in part.items():
        graph.add(child, *{part[other] for other in inside(name) & set(part)} - {child})
    graph.prepare()


@pytest.mark.parametrize("name", NAMES)
def test_heavy_libraries_are_imported_late(name):
    assert is_late(name) or {other.split(".")[0] for other in heads(name)} <= LIGHT
    assert is_late(name) or not any(map(is_late, heads(name) & {*NAMES}))
