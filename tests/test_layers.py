"""Rooms import one way, and heavy libraries come late."""

import ast
import graphlib
from pathlib import Path

import pytest

import bladegen

PACKAGE = Path(bladegen.__file__).parent
ROOMS = """errors version support curves airfoils shapes definition blade variants formats surface
cad measures parametric adapters plots views exports families studio cli""".split()  # noqa: SIM905
HEAVY = {
    *"""OCP PIL aerosandbox cadquery casadi distributed fastapi h5py imageio_ffmpeg jax matplotlib
    neuralfoil nicegui numba openmdao openpyxl pyarrow pyvista ruamel scipy torch trimesh uvicorn
    vtkmodules zarr""".split()  # noqa: SIM905
}
COMPILED = {
    *"""compiled workers plane_maps characteristics section_measures sizes kernels edge_slopes
    section_slopes coefficient_kernels""".split()  # noqa: SIM905
}
ADAPTERS = {"openmdao", "torch", "jax"}  # imported by who has the library, and by nothing of ours
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


INSIDE = {n: (set(imports(TREES[p])) & set(NAMES)) - {n} for n, p in NAMES.items()}


def room(name):
    return name.split(".")[1]


@pytest.mark.parametrize("name", [n for n in NAMES if room(n) in ROOMS])
def test_imports_lead_to_rooms_below(name):
    assert {room(other) for other in INSIDE[name]} <= {*ROOMS[: ROOMS.index(room(name)) + 1]}
    assert "importlib.import_module" not in ast.unparse(TREES[NAMES[name]])


@pytest.mark.parametrize("package", sorted({name.rpartition(".")[0] for name in NAMES}))
def test_neither_modules_nor_packages_import_each_other(package):
    part = {n: n.removeprefix(f"{package}.").split(".")[0] for n in NAMES if f"{package}." in n}
    graph = graphlib.TopologicalSorter()
    for name, child in part.items():
        graph.add(child, *{part[other] for other in INSIDE[name] & set(part)} - {child})
    graph.prepare()


@pytest.mark.parametrize("name", [n for n in NAMES if n.split(".")[-1] not in COMPILED])
def test_heavy_libraries_are_imported_late(name):
    body = [n for n in TREES[NAMES[name]].body if isinstance(n, ast.Import | ast.ImportFrom)]
    loaded = {n.split(".")[-1 if n in NAMES else 0] for n in imports(ast.Module(body, []))}
    assert not loaded & (HEAVY | COMPILED)


@pytest.mark.parametrize("name", NAMES)
def test_no_module_imports_an_adapter(name):
    assert not INSIDE[name] & {f"bladegen.{adapter}" for adapter in ADAPTERS}
