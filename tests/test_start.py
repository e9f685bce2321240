"""What starts light and keeps to itself: light commands, the core, public names."""

import ast
import subprocess
import sys
from collections import Counter

import pytest
from test_layers import NAMES, ROOM, imports, tree

import bladegen

HEAVY = {
    *"""OCP PIL aerosandbox cadquery casadi distributed fastapi h5py imageio_ffmpeg jax matplotlib
    neuralfoil nicegui numba openmdao openpyxl pyarrow pyvista ruamel scipy torch trimesh uvicorn
    vtkmodules zarr""".split()  # noqa: SIM905
}
CORE = ("airfoils", "blade", "curves", "definition", "shapes", "variants")


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


def test_the_list_of_blades_reads_none():
    code = (
        "import sys, bladegen.cli.commands as cli; cli.app(['list'], standalone_mode=False);"
        "assert not {'numpy', 'yaml'} & set(sys.modules)"
    )
    assert "iea15mw" in run(code)


def test_the_figures_of_a_blade_load_no_part_of_numpy_that_they_do_not_need():
    code = (
        "import sys, bladegen.cli.commands as cli;"
        "cli.app(['info', 'iea15mw'], standalone_mode=False);"
        "assert not {'numpy.ma', 'numpy.random', 'scipy'} & set(sys.modules)"
    )
    assert "iea15mw" in run(code)


def test_public_names_are_there_and_not_hidden_by_rooms():
    code = (
        "import bladegen.exports.build, bladegen.families.run, bladegen as bg;"
        "print(callable(bg.export), callable(bg.family), set(dir(bg)) == set(bg.__all__),"
        "all(getattr(bg, name) is not None for name in (*bg.__all__, 'grassmann', 'affine')))"
    )
    assert set(run(code).split()) == {"True"}
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = bladegen.nonsense


def test_no_folder_holds_more_than_13_modules():
    held = Counter(name.rpartition(".")[0] for name in NAMES if not name.endswith("__init__"))
    assert not {package for package, count in held.items() if count > 13}


def test_no_module_is_longer_than_300_lines():
    assert not [n for n, p in NAMES.items() if len(p.read_text("utf-8").splitlines()) > 300]


@pytest.mark.parametrize("name", [n for n in NAMES if ROOM[n] in CORE])
def test_the_core_opens_no_file_and_prints_nothing(name):
    nodes = [*ast.walk(tree(name))]
    calls = {
        node.func.id
        for node in nodes
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
    }
    assert not calls & {"open", "print", "eval", "exec"}
    assert not set(imports(nodes)) & {"random", "logging", "os"}
