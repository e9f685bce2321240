"""What README.md says under "Use" is typed as it stands, in one empty folder."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import bladegen as bg
from bladegen.measures import checks

ROOT = Path(bg.__file__).parent.parent
USE = re.search(
    r"\n## Use\n(.*?)\n## ", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL
)


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", USE[1], re.DOTALL)


def lines():
    return [
        line.partition("#")[0].split()
        for block in blocks("sh")
        for line in block.splitlines()
        if line.strip()
    ]


def test_commands_are_ours_and_write_where_the_next_ones_read():
    assert all(words[0] == "bladegen" for words in lines())
    read, written = set(), {"iea15mw", "out/iea15mw.step", "out/iea15mw.stl", "out/variant.yaml"}
    for words in lines():
        read |= {word for word in words[2:3] if "." in word}
        written |= {words[k] for k in range(3, len(words)) if words[1] == "convert"}
    assert read <= written


@pytest.mark.nightly
def test_what_is_typed_makes_one_consistent_folder(tmp_path):
    environment = {**os.environ, "COLUMNS": "200"}
    for words in lines():
        done = subprocess.run(
            [sys.executable, "-m", *words],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, (words, done.stderr)
    for block in blocks("python"):
        subprocess.run([sys.executable, "-c", block], cwd=tmp_path, env=environment, check=True)
    made = {str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*") if path.is_file()}
    assert {"out/iea15mw.step", "out/variant.step", "cfd/my_turbine.cgns", "variant.dat"} <= made
    assert {"apart.png", "blade.png", "iea15.step", "iea15.stl", "new.yaml"} <= made
    # the files of one blade are of one blade
    volumes = [
        checks.check_file(tmp_path / name).figures
        for name in ("out/iea15mw.step", "out/iea15mw.stl", "iea15.step", "iea15.stl")
    ]
    first, second = ((a["volume_m3"], b["volume"]) for a, b in (volumes[:2], volumes[2:]))
    assert first[0] == pytest.approx(first[1], rel=1e-3)
    assert second[0] == pytest.approx(second[1], rel=1e-3)
    assert len(bg.load_family(tmp_path / "family")) == 200
    blade = bg.Blade.from_definition(bg.read(tmp_path / "new.yaml"))
    assert blade.length == pytest.approx(bg.read("iea15mw").length)
