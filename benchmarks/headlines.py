"""The twenty figures of docs/measured.md that most people ask for, in one table at its top.

Each names one column of one benchmark's tables and the case it was measured on, ours and what it
is beside; `summary` takes them from the document itself, so no figure is written twice by hand.
"""

import re
from collections.abc import Mapping
from typing import NamedTuple


class Headline(NamedTuple):
    """A figure: its words, its benchmark, its column and case, and those of a contender."""

    words: str
    benchmark: str
    column: str
    case: str
    beside: str = ""
    column_beside: str = ""  # the same, if not given
    case_beside: str = ""  # the same, if not given


SOLID, LOFT = "iea15mw, bladegen to 1 mm", "iea15mw, OCCT's loft of 160 sections"
MESH, TESSELLATION = "iea15mw, bladegen, 300 sections", "iea15mw, OCCT's tessellation to 1 mm"
LEFT_OUT = "left-out station missed by [% chord], "
HELD_OUT = "held-out shapes missed by, RMS [chord], "
VARIANTS = "iea15mw, 1000 variants: clock"
HEADLINES = (
    Headline(
        "a STEP solid to 1 mm, made and written [s]",
        "solids",
        "made and written [s]",
        SOLID,
        "OCCT's loft of 160 sections",
        "",
        LOFT,
    ),
    Headline(
        "how far it is off its blade [mm]",
        "solids",
        "off the blade by up to [mm]",
        SOLID,
        "OCCT's loft of 160 sections",
        "",
        LOFT,
    ),
    Headline(
        "its file [MB]", "solids", "STEP [MB]", SOLID, "OCCT's loft of 160 sections", "", LOFT
    ),
    Headline(
        "a STEP solid to 0.05 mm [s]",
        "solids",
        "made and written [s]",
        "iea15mw, bladegen to 0.05 mm",
    ),
    Headline(
        "a mesh of 240,000 triangles [s]",
        "meshing",
        "made and written [s]",
        MESH,
        "OCCT, to 1 mm",
        "",
        TESSELLATION,
    ),
    Headline(
        "how far it is off its blade [mm]",
        "meshing",
        "off the blade by up to [mm]",
        MESH,
        "OCCT, to 1 mm",
        "",
        TESSELLATION,
    ),
    Headline("a structured grid [s]", "meshing", "structured grid, made [s]", "iea15mw"),
    Headline(
        "a station of IEA 15 MW left out is missed by [% chord]",
        "paths",
        LEFT_OUT + "spline",
        "iea15mw, in thickness",
        "PCHIP blend",
        LEFT_OUT + "PCHIP blend",
    ),
    Headline(
        "of NREL 5 MW",
        "paths",
        LEFT_OUT + "spline",
        "nrel5mw, in thickness",
        "PCHIP blend",
        LEFT_OUT + "PCHIP blend",
    ),
    Headline(
        "of DTU 10 MW",
        "paths",
        LEFT_OUT + "spline",
        "dtu10mw, in thickness",
        "PCHIP blend",
        LEFT_OUT + "PCHIP blend",
    ),
    Headline(
        "mean and 4 modes of 16,000 shapes [s]",
        "spaces",
        "mean and 4 modes [s], bladegen",
        "16000 shapes of 401",
        "careful loop",
        "mean and 4 modes [s], careful loop",
    ),
    Headline(
        "held-out airfoils in 4 numbers, missed by [chord]",
        "spaces",
        HELD_OUT + "modes",
        "4 parameters",
        "CST",
        HELD_OUT + "CST",
    ),
    Headline("in 8 numbers", "spaces", HELD_OUT + "modes", "8 parameters", "CST", HELD_OUT + "CST"),
    Headline(
        "100 sections of 401 points [ms]",
        "core",
        "100 sections of 401 [ms], in space",
        "iea15mw, spline",
    ),
    Headline(
        "a variant and its sections, tested [ms]",
        "core",
        "A variant's sections [ms], tested",
        "iea15mw, spline",
    ),
    Headline(
        "1,000 variants of 100 x 401, tested [s]",
        "families",
        "sections, tested [s], a family's blocks",
        VARIANTS,
        "a plain loop",
        "sections, tested [s], a plain loop",
    ),
    Headline(
        "STEP of a variant, one core [s]",
        "families",
        "STEP of a variant, one core [s]",
        "iea15mw, variants 0 to 14: clock",
    ),
    Headline(
        "Jacobian in 12 parameters [evaluations' time]",
        "derivatives",
        "12 parameters, 100 x 401, evaluations' time, jacobian",
        "iea15mw",
        "differences, in one batch",
        "12 parameters, 100 x 401, evaluations' time, differences, in one batch",
    ),
    Headline(
        "vjp [evaluations' time]",
        "derivatives",
        "12 parameters, 100 x 401, evaluations' time, vjp",
        "iea15mw",
    ),
    Headline(
        "rotor figures of a variant, processor [ms]",
        "labels",
        "processor time, a variant [ms], rotor",
        "64 variants, one thread",
    ),
)
COUNT = re.compile(r", of [\d,]+(?: to [\d,]+)?$")


def summary(documents: Mapping[str, str]) -> str:
    """Return the table of all headlines whose benchmark the document holds.

    Raises
    ------
    ValueError
        If a benchmark is there but not the figure.
    """
    lines = ["| what | bladegen | beside | | `benchmarks/` |", "| --- | --- | --- | --- | --- |"]
    for one in HEADLINES:
        if one.benchmark not in documents:
            continue
        cells = cells_of(documents[one.benchmark])
        places = [(one.column, one.case)]
        if one.beside:
            places.append((one.column_beside or one.column, one.case_beside or one.case))
        try:
            found = [cells[column.lower(), case] for column, case in places]
        except KeyError as error:
            raise ValueError(f"{one.benchmark}: no figure {error}") from None
        found += [""] * (2 - len(found))
        lines.append(
            f"| {one.words} | {found[0]} | {found[1]} | {one.beside} | `{one.benchmark}.py` |"
        )
    return "\n".join(lines) + "\n"


def cells_of(text: str) -> dict[tuple[str, str], str]:
    """Return the cells of all tables of a benchmark by column, its title before it, and case."""
    cells, title, heads = {}, "", []
    for line in text.splitlines():
        if line.endswith("]:") or line.endswith("time:"):
            title = f"{line[:-1]}, "
        elif line.startswith("| on |"):
            heads = [COUNT.sub("", head.strip()) for head in line.split("|")[2:-1]]
        elif line.startswith("| ") and heads and "---" not in line:
            case, *values = (cell.strip() for cell in line.split("|")[1:-1])
            cells |= {
                ((title + head).lower(), case): value
                for head, value in zip(heads, values, strict=True)
            }
        elif not line.strip() and heads:
            title, heads = "", []
    return cells
