"""torch and jax in an environment of their own: they are as large as all else together."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from test_examples import LEARNING

HERE = Path(__file__).parent
PINS = ("torch==2.13.0", "jax==0.10.2", "jaxlib==0.10.2")


@pytest.fixture(scope="module")
def python(tmp_path_factory):
    """A Python that sees this one's packages, torch and jax."""
    folder = tmp_path_factory.mktemp("learning")
    subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    (own,) = folder.glob("lib/python3*/site-packages")
    ours = [path for path in sys.path if path.endswith("site-packages")]
    (own / "ours.pth").write_text("\n".join([str(HERE.parent), *ours]))
    python = folder / "bin" / "python"
    subprocess.run([python, "-m", "pip", "install", "--quiet", *PINS], check=True)
    return python


def run(*words, folder=HERE.parent):
    done = subprocess.run(
        [str(word) for word in words],
        cwd=folder,
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.nightly
def test_blades_are_differentiated_through_by_torch_and_jax(python):
    assert "100%" in run(python, "-m", "pytest", "-p", "no:cacheprovider", HERE / "learning.py")


@pytest.mark.nightly
@pytest.mark.parametrize("path", LEARNING, ids=lambda path: path.stem)
def test_examples_that_need_torch_run_and_write_files(python, path, tmp_path):
    assert run(python, path, folder=tmp_path).startswith("wrote")
    assert any(entry.stat().st_size > 1000 for entry in tmp_path.iterdir())
