"""OpenFAST: the polars of AeroDyn's airfoil files (AirfoilInfo v1.01, OpenFAST 3 to 5).

A file holds one table a Reynolds number: ``Re`` [millions], ``InclUAdata`` and the constants of
unsteady aerodynamics, ``NumAlf`` and rows of alpha [deg], Cl, Cd, Cm.  Lines that begin with !
are comments; bladegen's own ``! source:``, ``! configuration:`` and ``! reynolds: unknown`` are
read.  What cannot be read is left out and said: a blade's shape does not depend on it.
"""

import re
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from bladegen.airfoils.polars import Polar
from bladegen.errors import DefinitionError, Finding
from bladegen.formats.common.document import Notes
from bladegen.formats.common.polars import COEFFICIENT, PARAMETER, REYNOLDS, TURN
from bladegen.formats.common.text_file import number

__all__ = ["COLUMNS", "CONSTANTS", "MILLION", "UNKNOWN", "Columns", "holds_tables", "polars"]

MILLION = 1e6
MOST_TABLES = 200
MOST_ROWS = 10_000
MOST_WORDS = 600  # letters of a source that are kept
MARKS = ("source", "configuration", "reynolds")
UNKNOWN = "unknown"
# AeroDyn's names in the order of its file, and windIO's where they differ
CONSTANTS = {
    "alpha0": "aoa0",
    "alpha1": "aoa1",
    "alpha2": "aoa2",
    "eta_e": "eta_e",
    "C_nalpha": "c_nalpha",
    "T_f0": "T_f0",
    "T_V0": "T_V0",
    "T_p": "T_p",
    "T_VL": "T_VL",
    "b1": "b1",
    "b2": "b2",
    "b5": "b5",
    "A1": "A1",
    "A2": "A2",
    "A5": "A5",
    "S1": "S1",
    "S2": "S2",
    "S3": "S3",
    "S4": "S4",
    "Cn1": "cn1",
    "Cn2": "cn2",
    "St_sh": "St_sh",
    "Cd0": "cd0",
    "Cm0": "cm0",
    "k0": "k0",
    "k1": "k1",
    "k2": "k2",
    "k3": "k3",
    "k1_hat": "k1_hat",
    "x_cp_bar": "x_cp_bar",
    "UACutout": "UACutout",
    "filtCutOff": "filtCutOff",
}
_MARK = re.compile(rf"!\s*({'|'.join(MARKS)}):\s*(\S.*)")


class Columns(NamedTuple):
    """Where a row holds what, from 1 on; 0 where it does not (InCol of AeroDyn's main input)."""

    alpha: int = 1
    cl: int = 2
    cd: int = 3
    cm: int = 4


COLUMNS = Columns()


@dataclass(frozen=True)
class _Table:
    """The lines of one table: by label the values, the marks of comments, and the rows."""

    values: dict[str, str]
    marks: dict[str, str]
    rows: list[list[str]]


class _UnreadableError(Exception):
    """Why a file's polars are left out."""


def holds_tables(text: str) -> bool:
    """Tell whether a text begins as an airfoil file with polars."""
    return bool(re.search(r"^\s*\S+\s+(NumTabs|NumAlf)\b", text, re.MULTILINE))


def polars(
    lines: list[str], name: str, notes: Notes, columns: Columns = COLUMNS
) -> tuple[Polar, ...]:
    """Return the polars of an airfoil file's lines, none if it holds none or they are unusable.

    Parameters
    ----------
    lines : list of str
        Of the file.
    name : str
        The file's, for findings.
    notes : Notes
        Takes a finding on what is left out.
    columns : Columns
        Of the tables.
    """
    try:
        return tuple(_polar(table, columns) for table in _tables(lines))
    except (_UnreadableError, DefinitionError) as error:
        notes.findings.append(Finding(name, f"polars left out: {error}"))
        return ()


def _tables(lines: list[str]) -> list[_Table]:
    """Divide a file into its tables."""
    tables: list[_Table] = []
    values: dict[str, str] = {}
    marks: dict[str, str] = {}
    wanted = 0
    for line in lines:
        words = line.split()
        if not wanted and (mark := _MARK.match(line.strip())):
            marks[mark[1]] = mark[2].strip()[:MOST_WORDS]
        if not words or words[0].startswith("!"):
            continue
        if wanted:
            tables[-1].rows.append(words)
            wanted -= 1
            continue
        label = words[1] if len(words) > 1 else ""
        if label == "Re":
            values = {}
        values[label] = words[0]
        if label != "NumAlf":
            continue
        count = number(words[0])
        if count is None or not 2 <= count <= MOST_ROWS or count != int(count):
            raise _UnreadableError(f"NumAlf: got {words[0][:40]!r}, allowed is 2 to {MOST_ROWS}")
        if len(tables) == MOST_TABLES:
            raise _UnreadableError(f"more than {MOST_TABLES} tables")
        tables.append(_Table(values, marks, []))
        wanted, values, marks = int(count), {}, {}
    if wanted:
        raise _UnreadableError(f"the last table ends {wanted} rows before NumAlf")
    return tables


def _polar(table: _Table, columns: Columns) -> Polar:
    """Return the polar of a table."""
    width = max(columns)
    rows = [[number(word) for word in row[:width]] for row in table.rows]
    for k, row in enumerate(rows):
        if len(row) < width or None in row:
            got = " ".join(table.rows[k])[:40]
            raise _UnreadableError(f"row {k + 1} of a table: got {got!r}, must be {width} numbers")
    cells = np.array(rows, dtype=np.float64)
    alpha, cl, cd, cm = (
        cells[:, column - 1] if column else np.zeros(len(cells)) for column in columns
    )
    for field, part in (("Cl", cl), ("Cd", cd), ("Cm", cm)):
        if not COEFFICIENT.holds(part).all():
            raise _UnreadableError(f"{field}: allowed is {COEFFICIENT}")
    if not np.all(np.abs(alpha) <= TURN):
        raise _UnreadableError(f"alpha: allowed is -{TURN:g} to {TURN:g} deg")
    if not np.all(np.diff(alpha) > 0):
        raise _UnreadableError("alpha must increase strictly")
    stated = number(table.values.get("Re", ""))
    reynolds = None if stated is None else stated * MILLION
    if reynolds is not None and not REYNOLDS.holds([reynolds]).all():
        raise _UnreadableError(f"Re: got {stated:g} millions, allowed is {REYNOLDS}")
    parameters = []
    for ours, theirs in CONSTANTS.items():
        value = number(table.values.get(ours, ""))
        if value is not None and PARAMETER.holds([value]).all():
            parameters.append((theirs, value))
    return Polar(
        np.clip(np.radians(alpha), -np.pi, np.pi),
        cl,
        cd,
        cm,
        reynolds=None if table.marks.get("reynolds") == UNKNOWN else reynolds or None,
        configuration=table.marks.get("configuration", "default"),
        source=table.marks.get("source", ""),
        parameters=tuple(parameters),
    )
