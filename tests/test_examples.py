from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).parent.parent / "examples").glob("*.py"))
LEARNING = [path for path in EXAMPLES if "import torch" in path.read_text(encoding="utf-8")]
GALLERY = EXAMPLES[0].parent.parent / "docs" / "gallery.md"


def test_the_gallery_takes_in_every_example():
    lines = GALLERY.read_text(encoding="utf-8").splitlines()
    wanted = {f'--8<-- "examples/{path.name}"' for path in EXAMPLES}
    assert wanted == {line for line in lines if line.startswith("--8")}


# those that need torch are run by test_learning
@pytest.mark.parametrize(
    "path", [path for path in EXAMPLES if path not in LEARNING], ids=lambda path: path.stem
)
def test_examples_run_and_write_files(command, path, tmp_path):
    done = command(script=path, folder=tmp_path)
    assert done["status"] == 0, done["err"]
    assert done["out"].startswith("wrote")
    assert any(entry.stat().st_size > 1000 for entry in tmp_path.rglob("*") if entry.is_file())
