"""What the package says by `logging`: nothing by itself, and what was done to who listens."""

import logging
import re
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cli import commands
from bladegen.exports.build import build
from bladegen.exports.options import Options
from bladegen.families.order import Order
from bladegen.families.run import run

LOGGER = logging.getLogger("bladegen")


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=51)


@pytest.fixture
def messages(caplog):
    """What was said, once a call."""
    caplog.set_level(logging.DEBUG, logger="bladegen")

    def said(level=logging.INFO):
        return [one.getMessage() for one in caplog.records if one.levelno == level]

    return said


@pytest.fixture
def quiet_again():
    before = LOGGER.level, list(LOGGER.handlers)
    yield
    LOGGER.setLevel(before[0])
    LOGGER.handlers = before[1]


def test_every_file_is_said_with_its_bytes(blade, messages, tmp_path):
    report = build(blade, tmp_path, formats=["stl", "step"], options=Options(sections=20))
    sizes = dict(re.findall(r"^wrote (\S+), (\d+) bytes$", "\n".join(messages()), re.MULTILINE))
    files = {str(file): str(file.stat().st_size) for file in tmp_path.iterdir()}
    assert sizes == files
    (solid,) = (said for said in messages() if "sections" in said and "wrote" not in said)
    off = report["solid"]["deviation_mm"]
    assert solid.startswith(f"nrel5mw: 20 sections, {report['solid']['poles']} poles, ")
    assert f"off the blade by {off['maximum']:.4f} mm at most ({off['on_face']}, " in solid
    stages = {said.rsplit(": ", 1)[0] for said in messages(logging.DEBUG) if said.endswith(" s")}
    assert stages == set(report["seconds"])


def test_what_a_format_cannot_hold_is_said(blade, messages, tmp_path):
    report = build(blade, tmp_path, formats=["htc"])
    assert report["remarks"]
    assert {f"nrel5mw.htc: {remark}" for remark in report["remarks"]} <= set(messages())


def test_a_family_says_its_blocks_and_what_it_drew_again(blade, messages, tmp_path):
    bounds = {"thickness": (0.2, 1.0)}
    planned = bg.family(blade, None, count=70, bounds=bounds, design="box", spans=16)
    family = replace(planned, thinnest=0.09)
    run(Order(family, tmp_path))
    again = [one for one in messages(logging.DEBUG) if "draws, the first refused" in one]
    attempts = {family.name(place): 0 for place in range(70)}
    for first in (0, 64):
        block = family.block(np.arange(first, min(first + 64, 70)))
        for place, count, refused in zip(block.index, block.attempts, block.refused, strict=True):
            attempts[family.name(place)] = count
            assert bool(refused) == (count > 1)
    assert again
    assert [said.split(":")[0] for said in again] == [k for k, n in attempts.items() if n > 1]
    assert all("relative thickness" in said for said in again)
    there = [said for said in messages() if "variants are there" in said]
    assert there[0].endswith("0 of 70 variants are there, 2 blocks to make")
    assert there[-1].startswith("block 1 is whole")
    assert there[-1].endswith("; 70 of 70 variants are there")
    run(Order(family, tmp_path), resume=True)
    *_, last = (said for said in messages() if "variants are there" in said)
    assert last.endswith("70 of 70 variants are there, 0 blocks to make")


def test_nothing_is_heard_unless_asked_for(quiet_again, tmp_path):
    command = ["convert", "nrel5mw", str(tmp_path / "blade.csv")]
    plain = CliRunner().invoke(commands.app, command)
    assert plain.exit_code == 0, plain.output
    assert "INFO" not in plain.stderr
    for _ in range(2):
        told = CliRunner().invoke(commands.app, ["-v", *command])
        assert told.exit_code == 0, told.output
        assert "".join(told.stderr.split()).count("blade.csv,") == 1  # lines are wrapped
        assert "INFO" in told.stderr
        assert told.stdout == plain.stdout
    CliRunner().invoke(commands.app, ["-vv", "list"])
    assert LOGGER.level == logging.DEBUG
