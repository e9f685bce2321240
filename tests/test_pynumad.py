"""What is handed to pyNuMAD becomes the shells that it should, in pyNuMAD itself."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import bladegen as bg


@pytest.fixture(scope="module")
def pynumad(tmp_path_factory):
    """A Python that has pyNuMAD, which needs a numpy that bladegen does not take."""
    folder = tmp_path_factory.mktemp("pynumad")
    subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    python = folder / "bin" / "python"
    pip = [python, "-m", "pip", "install", "--quiet", "numpy<2", "pynumad==1.0.0"]
    subprocess.run(pip, check=True)
    return python


def areas(corners):
    """Areas of flat quadrilaterals (k, 4, 3), of which the last two points may be one."""
    across = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    return 0.5 * np.linalg.norm(across, axis=1)


@pytest.mark.nightly
def test_a_variant_has_the_shells_that_it_should(pynumad, tmp_path):
    variant = bg.Blade.from_definition(bg.read("iea15mw")).perturbed(thickness=1.02)
    path = tmp_path / "variant.yaml"
    bg.write(variant, path, format="windio1", polars="keep")
    script = [pynumad, Path(__file__).with_name("pynumad_mesh.py"), path, "1.0"]
    told = subprocess.run(script, capture_output=True, text=True, check=True).stdout
    mesh = json.loads(told)
    nodes, elements = np.array(mesh["nodes"]), np.array(mesh["elements"])
    assert 2600 < len(elements) < 2950  # of 1 m, 1,347 m2 of them skin and webs
    assert set(elements.ravel()) - {-1} == set(range(len(nodes)))

    # a triangle's fourth node is -1
    corners = np.where(elements[:, 3:] < 0, elements[:, [0, 1, 2, 2]], elements)
    sizes = areas(nodes[corners])
    density = {one.name: one.density for one in variant.definition.structure.materials}
    weights = {
        name: sum(density[material] * thickness for material, thickness in plies)
        for name, plies in mesh["plies"].items()
    }
    mass = sum(weight * sizes[mesh["sets"][name]].sum() for name, weight in weights.items())
    # whole plies from station to station: 4 % more
    assert mass == pytest.approx(variant.layup.mass, rel=0.05)

    skin = nodes[np.unique(corners[mesh["sets"]["allOuterShellEls"]])]
    placed = np.stack([skin[:, 1], -skin[:, 0], skin[:, 2]], axis=1)  # x downwind, y to the edge
    length = variant.axis(np.array([1.0]))[0, 2]
    missed = []
    for z in np.unique(placed[:, 2].round(3)):
        eta = np.array([np.clip(z / length, 0.0, 1.0)])
        near, _ = cKDTree(variant.sections(eta)[0][:, :2]).query(
            placed[abs(placed[:, 2] - z) < 1e-2, :2]
        )
        missed.append(near / variant.chord(eta))
    # airfoils are blended in another way, and the last metre and a half is one element long
    assert np.quantile(np.concatenate(missed), 0.5) < 3e-3
    assert max(near.max() for near in missed[:-3]) < 0.02
