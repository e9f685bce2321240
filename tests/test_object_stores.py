"""Families in object stores: fsspec's memory each day, servers of S3 and Cloud Storage at night."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from test_learning import run as ran
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cli import commands
from bladegen.cli.options.variants import variant
from bladegen.errors import ExportError, FamilyError
from bladegen.families.order import Order
from bladegen.families.run import run
from bladegen.families.storage import places

HERE = Path(__file__).parent
PACKAGES = ("s3fs", "gcsfs", "moto[s3,server]", "gcp-storage-emulator")


def planned(count):
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=61)
    return bg.family(blade, count=count, spans=16, bounds={"chord": (0.9, 1.1)}, design="box")


class KilledError(Exception):
    """What ends a run in the middle."""


def killed(done):
    if done:
        raise KilledError


def test_a_family_in_a_store_is_that_of_a_folder(tmp_path):
    place = f"memory://{tmp_path.name}/family"
    with pytest.raises(KilledError):
        run(Order(planned(70), place), progress=killed)
    with pytest.raises(FamilyError, match="not whole; the same command with --resume goes on"):
        bg.load_family(place)
    assert run(Order(planned(70), place), resume=True) == 6
    assert run(Order(planned(80), place), append=True, jobs=2) == 16
    with pytest.raises(FamilyError, match="holds another family"):
        run(Order(planned(70), place), resume=True)
    assert run(Order(planned(80), tmp_path / "family")) == 80
    there, here = bg.load_family(place), bg.load_family(tmp_path / "family")
    for name in ("manifest.parquet", "CARD.md", "family.json"):
        assert (there.path / name).read_bytes() == (here.path / name).read_bytes()
    assert not (there.path / "parts").exists()
    assert there.names == here.names
    assert np.array_equal(there["sections"][:], here["sections"][:])
    assert there[3].volume == here[3].volume
    read = [batch["variant"] for batch in there.batches(("variant",), 32, rng=0)]
    assert sorted(np.concatenate(read).tolist()) == list(range(80))
    assert there.dataset().volume.values.tolist() == here["volume"][:].tolist()
    shown = CliRunner().invoke(commands.app, ["info", place, "--json", "--where", "variant < 2"])
    assert '"variants": 80' in shown.output
    assert variant(f"{place}/nrel5mw-00003", None, plain=True).volume == here[3].volume


def test_what_a_store_lacks_is_one_line(monkeypatch):
    for place, said in (
        ("nothing://bucket/fam", "nothing:// is no store that fsspec knows; s3://BUCKET/FOLDER"),
        ("gs://bucket/fam", r"need universal_pathlib and gcsfs; pip install 'bladegen\[stores\]'"),
    ):
        monkeypatch.setitem(sys.modules, "gcsfs", None)
        with pytest.raises(FamilyError, match=said):
            bg.load_family(place)
    with pytest.raises(ExportError, match="memory://b/f: the store says: the bucket does not ex"):  # noqa: SIM117
        with places.told(places.located("memory://b/f")):
            (places.located("memory://b/f") / "x").read_bytes()
    with pytest.raises(ZeroDivisionError), places.told(places.located("memory://b/f")):
        _ = 1 / 0


@pytest.mark.nightly
def test_servers_of_s3_and_cloud_storage_hold_families(tmp_path):
    """In an environment of their own: servers and clients are as large as all else together."""
    subprocess.run([sys.executable, "-m", "venv", str(tmp_path / "own")], check=True)
    (own,) = (tmp_path / "own").glob("lib/python3*/site-packages")
    ours = [path for path in sys.path if path.endswith("site-packages")]
    (own / "ours.pth").write_text("\n".join([str(HERE.parent), *ours]))
    python = tmp_path / "own" / "bin" / "python"
    subprocess.run([python, "-m", "pip", "install", "--quiet", *PACKAGES], check=True)
    assert "100%" in ran(python, "-m", "pytest", "-p", "no:cacheprovider", HERE / "stores.py")
