"""Rooms import one way, modules and packages in no circle, and heavy libraries come late."""

import ast
import graphlib
import sys
from functools import cache
from pathlib import Path

HOME = Path(__file__).parents[1]
ROOMS = """errors version support curves airfoils shapes definition blade neuralfoil formats
surface cad measures parametric fitting views exports families studio cli""".split()  # noqa: SIM905
LIGHT = {*sys.stdlib_module_names, "bladegen", "numpy", "rich", "typer", "yaml"}
PATHS = sorted(HOME.glob("bladegen/**/*.py"))
NAMES = {".".join(p.relative_to(HOME).with_suffix("").parts): p for p in PATHS}
ROOM = {name: name.split(".")[1] for name in NAMES}
RANK = {room: i for i, room in enumerate(ROOMS)}


@cache
def tree(name):
    return ast.parse(NAMES[name].read_text(encoding="utf-8"))


def imports(nodes):
    """The modules that some statements import; a package is its `__init__`."""
    for node in nodes:
        if isinstance(node, ast.Import | ast.ImportFrom):
            home = f"{node.module}." if isinstance(node, ast.ImportFrom) else ""
            for name in (f"{home}{alias.name}" for alias in node.names):
                found = (name, f"{name}.__init__", f"{home}__init__")
                yield next((one for one in found if one in NAMES), home[:-1] or name)


def inside(name):
    """The modules of ours that one imports, anywhere in it."""
    return {*imports(ast.walk(tree(name)))} & {*NAMES} - {name}


def test_rooms_import_rooms_below():
    rooms = [n for n in NAMES if ROOM[n] in RANK]
    assert [(n, m) for n in rooms for m in inside(n) if RANK.get(ROOM[m], 99) > RANK[ROOM[n]]] == []
    assert [n for n in rooms if "import_module" in ast.unparse(tree(n))] == []


def test_neither_modules_nor_packages_import_each_other():
    for package in {name.rpartition(".")[0] for name in NAMES}:
        part = {n: n.removeprefix(f"{package}.").split(".")[0] for n in NAMES if f"{package}." in n}
        graph = graphlib.TopologicalSorter()
        for name, child in part.items():
            graph.add(child, *{part[other] for other in inside(name) & {*part}} - {child})
        graph.prepare()


def test_heavy_libraries_are_imported_late():
    heads = {name: {*imports(tree(name).body)} for name in NAMES}
    late = {"bladegen.support.compiled", "bladegen.support.workers"}
    late |= {n for n, head in heads.items() if "bladegen.support.compiled" in head}  # compiled
    edges = [(n, m) for n, head in heads.items() if n not in late for m in head]
    assert [(n, m) for n, m in edges if m.split(".")[0] not in LIGHT or m in late] == []
