"""What all benchmarks share: turns, spreads, and tables that hold every contender and case."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"


@pytest.fixture
def shared(monkeypatch):
    """The modules that benchmarks import."""
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    import figures
    import table

    yield figures, table
    for name in ("figures", "headlines", "table"):
        sys.modules.pop(name, None)


def test_contenders_take_turns_after_one_call_each_that_warms_them(shared):
    figures, _ = shared
    calls = []
    spent = figures.seconds({name: lambda n=name: calls.append(n) for name in "ab"}, runs=3)
    assert "".join(calls) == "ab" * 4
    assert {name: len(taken) for name, taken in spent.items()} == {"a": 3, "b": 3}


def test_a_spread_is_median_mean_ninth_decile_and_maximum(shared):
    figures, _ = shared
    values = [5.0, 1.0, 2.0, 3.0, 100.0, 4.0, 6.0, 7.0, 8.0, 9.0, 10.0]
    assert figures.spread(values) == pytest.approx((6.0, np.mean(values), 10.0, 100.0))


def test_tables_hold_every_case_and_contender(shared, tmp_path, monkeypatch, capsys):
    figures, table = shared
    monkeypatch.setenv(figures.TABLE, str(tmp_path / "f.jsonl"))
    for case, late in (("one", None), ("two", [1.0, 3.0])):
        figures.figure("made", case, "s", {"ours": [1.0, 2.0], "theirs": late})
        figures.figure("valid", case, "", {"ours": 1, "theirs": 0})
        figures.figure("size", case, "MB", 2.5)
    assert "made" in capsys.readouterr().out
    rows = [json.loads(line) for line in (tmp_path / "f.jsonl").read_text().splitlines()]
    both, size = table.tables(rows)
    assert both.splitlines() == [
        "| on | made [s], ours, of 2 | made [s], theirs, of 2 | valid, ours | valid, theirs |",
        "| --- | --- | --- | --- | --- |",
        "| one | 1.5 / 1.5 / 1.9 / 2 | not done | 1 | 0 |",
        "| two | 1.5 / 1.5 / 1.9 / 2 | 2 / 2 / 2.8 / 3 | 1 | 0 |",
    ]
    assert size.splitlines()[0] == "| on | size [MB] |"


def test_one_figure_of_several_contenders_is_a_table_s_title(shared, tmp_path, monkeypatch):
    figures, table = shared
    monkeypatch.setenv(figures.TABLE, str(tmp_path / "f.jsonl"))
    figures.figure("missed by", "one", "%", {"ours": 2.0, "theirs": 1.0})
    (made,) = table.tables([json.loads((tmp_path / "f.jsonl").read_text())])
    assert made == (
        "Missed by [%]:\n\n| on | ours | theirs |\n| --- | --- | --- |\n| one | 2 | 1 |\n"
    )


def test_what_a_document_holds_of_other_benchmarks_stays(shared):
    _, table = shared
    text = (
        "# Measured\n\nA machine.\n\n## `benchmarks/a.py`\n\n| x |\n\n## `benchmarks/b.py`\n\ny\n"
    )
    assert table.parts(text) == {"a": "\n| x |\n", "b": "\ny\n"}


def test_tables_of_pages_are_made_anew_where_their_benchmark_ran(shared):
    _, table = shared
    rows = [
        {"what": what, "case": case, "unit": "s", "found": {"": [float(k)]}}
        for what in ("made", "other")
        for k, case in enumerate(("a, 1 mm", "a, 2 mm", "b, 1 mm"))
    ]
    page = (
        "before\n<!-- measured: solids | made | 1 mm; 3 mm -->\n\n| old |\n\n<!-- end -->\n"
        "<!-- measured: paths | made | -->\n\n| stays |\n\n<!-- end -->\nafter\n"
    )
    again = table.refreshed(page, {"solids": rows})
    assert "| a, 1 mm | 0 |\n| b, 1 mm | 2 |\n" in again
    assert "old" not in again
    assert "stays" in again
    assert again.startswith("before")
    assert table.refreshed(again, {"solids": rows}) == again
    with pytest.raises(ValueError, match="no one table of made; gone"):
        table.chosen(rows, ["made", "gone"], [])


def test_pages_name_benchmarks_and_figures_that_there_are(shared):
    _, table = shared
    root = BENCHMARKS.parent
    blocks = [
        block
        for page in (root / "README.md", *sorted((root / "docs").glob("*.md")))
        for block in table.BLOCK.findall(page.read_text())
    ]
    assert blocks
    for name, figures, _ in blocks:
        script = (BENCHMARKS / f"{name.strip()}.py").read_text()
        assert all(f'"{one.strip()}' in script for one in figures.split(";")), (name, figures)


@pytest.mark.parametrize("path", sorted(BENCHMARKS.glob("*.py")), ids=lambda path: path.stem)
def test_every_benchmark_says_how_it_is_run_and_can_be_tried_at_a_small_size(path, shared):
    _, table = shared
    text = path.read_text()
    if path.stem in ("figures", "headlines", "numad_workbook", "rotor_flow", "wisdem_run"):
        return
    assert f"benchmarks/{path.name}" in text
    assert "quick" in text
    assert path.stem in table.SKIPPED or "figure(" in text


def test_the_document_begins_with_figures_that_stand_in_its_tables(shared):
    _, table = shared
    document = table.MEASURED.read_text(encoding="utf-8")
    top = table.summary(table.parts(document))
    assert f"{table.TOP}\n\n{top}\n## `benchmarks/" in document
    assert top.count("\n") == 22
    with pytest.raises(ValueError, match="solids: no figure"):
        table.summary({"solids": "| on | made [s] |\n| --- | --- |\n| iea15mw | 1 |\n"})
