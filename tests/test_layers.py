"""Modules import only what stands before them in the flow; heavy libraries come late."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import bladegen

PACKAGE = Path(bladegen.__file__).parent
FLOW = [
    "errors",
    "arrays",
    "arguments",
    "files",
    "style",
    "keys",
    "stopping",
    "archive",
    "grassmann",
    "fairing",
    "landmarks",
    "separation",
    "crossing",
    "polars",
    "distribution",
    "definition",
    "plausibility",
    "conventions",
    "extension",
    "blending",
    "readers",
    "affine",
    "roots",
    "resizing",
    "sections",
    "chord_lines",
    "planform",
    "interpolation",
    "edges",
    "widths",
    "crowding",
    "remarks",
    "thickness",
    "saved_spaces",
    "compiled",
    "plane_maps",
    "characteristics",
    "sanity",
    "pga",
    "domain",
    "deformation",
    "perturbation",
    "shaping",
    "blade",
    "provenance",
    "redefinition",
    "resampling",
    "estimates",
    "writers",
    "polygons",
    "orphans",
    "sizes",
    "kernels",
    "variants",
    "batch",
    "draws",
    "designs",
    "families",
    "properties",
    "smoothness",
    "spanwise",
    "inflections",
    "cst",
    "database",
    "tips",
    "net",
    "ends",
    "mesh",
    "cad",
    "cad_files",
    "cad_patches",
    "file_figures",
    "stretching",
    "caps",
    "grid",
    "grid_quality",
    "vtk_files",
    "patches",
    "surfaces",
    "distances",
    "foreign",
    "foreign_reader",
    "grid_files",
    "rotor",
    "marks",
    "checks",
    "preview",
    "comparison",
    "options",
    "exporters",
    "plots",
    "combs",
    "inventory",
    "build",
    "identity",
    "forecasts",
    "family_files",
    "family_rows",
    "family_run",
    "texts",
    "likeness",
    "tables",
    "blade_plots",
    "notebook",
    "contact",
    "studio",
    "output",
    "terminal",
    "cli_options",
    "cli_perturb",
    "cli_space",
    "cli_check",
    "cli_convert",
    "cli_family",
    "cli_view",
    "cli_studio",
    "cli",
]
LATE = {
    "cadquery": {"cad", "rotor", "studio"},
    "OCP": {"cad", "cad_files", "cad_patches", "file_figures"},
    "trimesh": {"mesh"},
    "pyvista": {"preview", "comparison", "grid_files"},
    "h5py": {"grid_files"},
    "imageio_ffmpeg": {"preview"},
    "vtkmodules": {"distances", "preview", "vtk_files"},
    "matplotlib": {"plots", "preview"},
    "zarr": {"family_files"},
    "openpyxl": {"readers", "writers"},
    "pyarrow": {"family_files", "texts"},
    "ruamel": {"writers"},
    "neuralfoil": {"estimates"},
    "distributed": {"family_run", "cli_family"},
    "numba": {"compiled", "orphans"},
    "nicegui": {"studio"},
    "fastapi": {"studio"},
    "uvicorn": {"studio"},
}
# load Numba with themselves, so come late too
COMPILED = {"compiled", "orphans", "plane_maps", "characteristics", "sizes", "kernels"}
CORE = FLOW[: FLOW.index("net") + 1]
MODULES = sorted(PACKAGE.rglob("*.py"))


def layer(path: Path) -> str:
    """The module's place in the flow: packages count as one."""
    relative = path.relative_to(PACKAGE)
    return relative.parts[0] if len(relative.parts) > 1 else relative.stem


def imports(tree: ast.AST) -> set[str]:
    """The modules that a tree imports, `bladegen.x` and other top-level names."""
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            if node.module == "bladegen":
                found |= {f"bladegen.{alias.name}" for alias in node.names}
            found.add(node.module)
    return found


def at_top(tree: ast.Module) -> set[str]:
    """The modules imported when the module is loaded (not inside functions or for types)."""
    return imports(
        ast.Module([n for n in tree.body if isinstance(n, ast.Import | ast.ImportFrom)], [])
    )


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_imports_point_down_the_flow(path):
    here = layer(path)
    if here == "__init__":
        return
    assert here in FLOW, f"{here} has no place in the flow"
    for name in imports(ast.parse(path.read_text(encoding="utf-8"))):
        parts = name.split(".")
        if parts[0] == "bladegen" and len(parts) > 1 and parts[1] in FLOW:
            assert FLOW.index(parts[1]) <= FLOW.index(here), f"{here} imports {name}"


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_heavy_libraries_are_imported_late_and_in_few_places(path):
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for name in imports(tree):
        allowed = LATE.get(name.split(".")[0])
        assert allowed is None or layer(path) in allowed, f"{layer(path)} imports {name}"
    if layer(path) not in COMPILED:
        loaded = {name.removeprefix("bladegen.").split(".")[0] for name in at_top(tree)}
        assert not loaded & {*LATE, "scipy", "PIL", *COMPILED}


@pytest.mark.parametrize("name", CORE)
def test_the_core_opens_no_file_and_prints_nothing(name):
    if name in {"readers", "writers", "files"}:
        return
    tree = ast.parse((PACKAGE / f"{name}.py").read_text(encoding="utf-8"))
    calls = {
        node.func.id
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
    }
    assert not calls & {"open", "print", "eval", "exec"}
    assert not imports(tree) & {"random", "logging", "os"}


def test_no_module_is_longer_than_400_lines():
    for path in MODULES:
        assert len(path.read_text(encoding="utf-8").splitlines()) <= 400, path


def test_light_commands_load_nothing_heavy():
    code = (
        "import sys, bladegen; bladegen.read('iea15mw'); import bladegen.cli;"
        "print(*sorted({m.split('.')[0] for m in sys.modules}))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not set(done.stdout.split()) & {*LATE, "scipy", "matplotlib", "PIL"}


def test_public_names_are_there_and_not_hidden_by_modules():
    code = (
        "import bladegen.exporters, bladegen.readers, bladegen.build, bladegen as bg;"
        "assert bg.grassmann.log and bg.affine.standardise;"
        "assert callable(bg.export) and callable(bg.read);"
        "assert all(getattr(bg, name) is not None for name in bg.__all__);"
        "assert set(dir(bg)) == set(bg.__all__)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = bladegen.nonsense
