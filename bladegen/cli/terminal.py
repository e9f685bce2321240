"""What the command line prints: tables, figures, progress.  rich is imported when needed.

Names come from files of anybody, so every text is shown as `errors.visible` has it.
"""

import json
import logging
import os
import re
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

import typer

from bladegen.errors import BladegenError, visible

__all__ = [
    "log_to_terminal",
    "print_figures",
    "print_findings",
    "print_space",
    "print_summary",
    "print_table",
    "progress_bar",
    "remark",
    "variants_bar",
]


ALIKE = 3  # findings of a kind that are printed; the report holds all
NUMBER = re.compile(r"[-+]?\d[\d.e+-]*")
CLAUSE = re.compile(r"[,;] ")  # the last one says what kind of finding it is
SOON, OFTEN = 2.0, 30.0  # s into a step until it is said where no terminal is, and said again
WIDE = 200  # columns of what is no terminal: there a row stays a line
ASKED = "BLADEGEN_PROGRESS"  # the variable that says how often instead [s]; 0 for never


@cache
def _stderr() -> Any:
    """The one console that progress and messages share, so that neither writes over the other."""
    from rich.console import Console

    return Console(stderr=True)


def log_to_terminal(level: int) -> None:
    """Show the package's messages from a level of `logging` on, on stderr."""
    from rich.logging import RichHandler

    logger = logging.getLogger("bladegen")
    logger.setLevel(level)
    shown = RichHandler(console=_stderr(), show_path=False, rich_tracebacks=False)
    shown.addFilter(_made_visible)
    logger.handlers = [*(h for h in logger.handlers if not isinstance(h, RichHandler)), shown]


def _made_visible(record: logging.LogRecord) -> bool:
    """Show the names in a message as `errors.visible` has them."""
    record.msg, record.args = visible(record.getMessage()), None
    return True


def remark(text: str) -> None:
    """Say something while a command goes on, above its progress."""
    _stderr().print(f"note: {visible(text)}", markup=False, highlight=False, soft_wrap=True)


@contextmanager
def progress_bar() -> Iterator[Any]:
    """Show what is being done and for how long; elsewhere than on a terminal as `_lines` does."""
    console = _stderr()
    if not console.is_terminal:
        with _lines() as say:
            yield say
        return
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn()
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("starting", total=None)
        yield lambda message: bar.update(task, description=visible(message))


@contextmanager
def _lines() -> Iterator[Callable[[str], None]]:
    """Say each step that lasts in a plain line on stderr, after `SOON` and again every `OFTEN`.

    Texts that differ in numbers, or behind a comma, such as in how many are done, are of one step.
    """
    often = _how_often()
    start = time.monotonic()
    step, text, due = "", "", start + min(SOON, often)
    lock, ended = threading.Lock(), threading.Event()

    def told(message: str) -> None:
        nonlocal step, text, due
        with lock:
            text, kind = message, NUMBER.sub("", message.partition(",")[0])
            if kind != step:
                step, due = kind, time.monotonic() + min(SOON, often)

    def watch() -> None:
        nonlocal due
        while not ended.wait(max(0.01, min(due - time.monotonic(), 0.25))):
            with lock:
                now, what = time.monotonic(), text
                late = now >= due and bool(what)
                due = now + often if late else due
            if late:
                with suppress(OSError, ValueError):  # nobody listens any more
                    typer.echo(f"progress: {visible(what)} ({now - start:.0f} s)", err=True)

    watching = threading.Thread(target=watch, name="progress", daemon=True)
    if often > 0.0:
        watching.start()
    try:
        yield told
    finally:
        ended.set()
        if often > 0.0:
            watching.join()


def _how_often() -> float:
    """Return how often a step is said [s], 0 for never."""
    try:
        return max(0.0, float(os.environ.get(ASKED, OFTEN)))
    except ValueError:
        raise BladegenError(
            f"{ASKED}: got {os.environ[ASKED]!r}, must be seconds between two lines; 0 for none"
        ) from None


@contextmanager
def variants_bar(count: int, what: str = "variants") -> Iterator[Any]:
    """Show how many of `count` variants are whole, the rate, and the time that remains.

    Elsewhere than on a terminal as `_lines` does.
    """
    console, start, first = _stderr(), time.monotonic(), -1

    def rate(done: int) -> str:
        nonlocal first
        first = done if first < 0 else first
        spent = time.monotonic() - start
        return f"{(done - first) / spent:.1f}/s" if done > first else ""

    if not console.is_terminal:
        with _lines() as say:
            say(f"0 of {count} {what}")
            yield lambda done: say(f"{done} of {count} {what}, {rate(done)}".strip(", "))
        return
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]}"),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task(what, total=count, rate="")
        yield lambda done: bar.update(task, completed=done, rate=rate(done))


def print_summary(folder: Path, name: str) -> None:
    """Print a report's main figures and the files."""
    from bladegen.exports.build import report_path
    from bladegen.views.tables import megabytes, report_rows

    path = report_path(folder, name)
    report = json.loads(path.read_text(encoding="utf-8"))
    print_table(["figure", "measured"], report_rows(report), title=report["blade"])
    rows = [[str(folder / f["name"]), megabytes(f["bytes"])] for f in report["files"]]
    rows.append([str(path), "all figures"])
    print_table(["file", "size"], rows)
    print_findings(report["figures"]["findings"] + report["remarks"])


def print_space(space: Any) -> None:
    """Print a shape space."""
    from bladegen.views.tables import space_figures, space_rows

    figures = space_figures(space)
    shown = {key: figures[key] for key in ("about", "shapes", "landmarks", "modes")}
    print_figures("shape space", shown)
    print_table(["mode", "variance, %", "in sum, %", "least t", "largest t"], space_rows(space))


def print_figures(title: str, figures: dict[str, Any]) -> None:
    from bladegen.views.tables import shown

    rows = [[key.replace("_", " "), shown(value)] for key, value in figures.items()]
    print_table(["figure", "value"], rows, title=title)


def print_findings(findings: list[str]) -> None:
    """Print findings; of those that say the same of many places, the first few and their count."""
    kinds: dict[str, list[str]] = {}
    for finding in findings:
        kinds.setdefault(NUMBER.sub("", CLAUSE.split(finding)[-1]), []).append(finding)
    for alike in kinds.values():
        for finding in alike[:ALIKE]:
            typer.echo(f"note: {visible(finding)}")
        if len(alike) > ALIKE:
            typer.echo(f"note: and {len(alike) - ALIKE} more like the last")


def print_table(columns: list[str], rows: list[list[str]], title: str | None = None) -> None:
    from rich import box
    from rich.console import Console
    from rich.table import Column, Table

    head = None if title is None else visible(title)
    whole = [Column(name, overflow="fold") for name in columns]  # names are typed again: not cut
    table = Table(*whole, title=head, title_justify="left", box=box.SIMPLE_HEAD)
    for row in rows:
        table.add_row(*map(visible, row))
    console = Console()
    if not console.is_terminal and "COLUMNS" not in os.environ:
        console.width = WIDE
    console.print(table, markup=False, highlight=False)
