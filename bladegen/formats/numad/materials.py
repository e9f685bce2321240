"""Sheet "Materials" of a NuMAD workbook: materials by the number that components call them by.

From row 4 on: number, name, type (isotropic or orthotropic), thickness of a ply [mm]; Ex, Ey, Ez,
Gxy, Gyz, Gxz [MPa]; Poisson's ratios xy, yz, xz; density [kg/m3], of a dry ply [g/m2]; strengths
in tension and compression [MPa]; reference.  x is along the fibres.
"""

from collections.abc import Sequence

from bladegen.definition.structure.structure import Axes, Material
from bladegen.errors import Finding
from bladegen.formats.common.document import Notes, Range
from bladegen.formats.common.table import Cell, Rows
from bladegen.formats.common.text_file import number

__all__ = ["SHEET", "read"]

SHEET = "Materials"
FIRST_ROW = 4
MM, MPA, GRAM = 1e-3, 1e6, 1e-3
TYPES = ("isotropic", "orthotropic")
COLUMNS = {  # name: column, factor, allowed
    "thickness": (3, MM, Range(0.0, 1.0, "m", above=True)),
    **{
        name: (4 + i, MPA, Range(0.0, 1e13, "Pa", above=True))
        for i, name in enumerate(("Ex", "Ey", "Ez", "Gxy", "Gyz", "Gxz"))
    },
    **{name: (10 + i, 1.0, Range(-1.0, 1.0)) for i, name in enumerate(("prxy", "pryz", "prxz"))},
    "density": (13, 1.0, Range(0.0, 3e4, "kg/m3", above=True)),
    "dry density": (14, GRAM, Range(0.0, 1e3, "kg/m2")),
    "UTS": (15, MPA, Range(0.0, 1e13, "Pa")),
    "UCS": (16, MPA, Range(0.0, 1e13, "Pa")),
}
TAKEN = {"Ez": "Ey", "Gyz": "Gxy", "Gxz": "Gyz", "pryz": "prxy", "prxz": "prxy"}  # as pyNuMAD does
REFERENCE = 17


def read(rows: Rows, notes: Notes) -> dict[int, Material]:
    """Return the materials that can be read; of the others a finding says what is wrong."""
    found: dict[int, Material] = {}
    filled: set[str] = set()
    unheld: list[str] = []
    for at, cells in rows:
        if at < FIRST_ROW or not (_cell(cells, 0) or _cell(cells, 1)):
            continue
        key = _value(cells, 0)
        if key is None:
            key = float(at - FIRST_ROW + 1)
            said = f"got no number; counted by its row, {key:g}, as NuMAD does"
            notes.findings.append(Finding(f"{SHEET}!A{at}", said))
        name = str(_cell(cells, 1) or "").strip() or f"material {key:g}"
        problem = _problem(cells)
        if not key.is_integer() or int(key) in found:
            problem = f"got {key:g}, must be a whole number that stands once"
        if problem:
            notes.findings.append(Finding(f"{SHEET}!A{at}", f"{problem}; {name} is left out"))
            continue
        while name in {one.name for one in found.values()}:
            name = f"{name} {key:g}"
        made, taken, strong = _material(name, cells)
        found[int(key)] = made
        filled |= taken
        unheld += [] if strong else [name]
    if filled:
        said = ", ".join(f"{one} as {TAKEN[one]}" for one in TAKEN if one in filled)
        notes.findings.append(Finding(SHEET, f"what is empty is taken as pyNuMAD does: {said}"))
    if unheld:
        said = "UTS and UCS are strengths along the fibres alone; left out"
        notes.findings.append(Finding(f"{SHEET}: {', '.join(unheld)}", said))
    return found


def _problem(cells: Sequence[Cell]) -> str:
    kind = str(_cell(cells, 2) or "").strip().lower()
    if kind not in TYPES:
        return f"type: got {kind!r}, allowed are {' and '.join(TYPES)}"
    for name, (k, factor, allowed) in COLUMNS.items():
        cell, value = _cell(cells, k), _value(cells, k)
        if cell is None and name in ("thickness", "density"):
            return f"{name} is empty, must be given"
        if cell is not None and (value is None or not allowed.holds(factor * value)):
            return f"{name}: got {str(cell)[:40]!r}, allowed is {allowed}"
    return ""


def _material(name: str, cells: Sequence[Cell]) -> tuple[Material, set[str], bool]:
    """Return a material, which of its figures were empty, and whether it has its strengths."""
    values = {
        key: factor * value
        for key, (k, factor, _) in COLUMNS.items()
        if (value := _value(cells, k)) is not None
    }
    orthotropic = str(cells[2]).strip().lower() == TYPES[1]
    taken: set[str] = set()
    if orthotropic:
        for key, other in TAKEN.items():
            if key not in values and other in values:
                values[key] = values[other]
                taken.add(key)
        E, G = (_three(values, *keys) for keys in (("Ex", "Ey", "Ez"), ("Gxy", "Gxz", "Gyz")))
        nu = _three(values, "prxy", "prxz", "pryz")
    else:
        E, nu = _three(values, *["Ex"] * 3), _three(values, *["prxy"] * 3)
        shear = E[0] / (2.0 * (1.0 + nu[0])) if E and nu and nu[0] > -1.0 else None
        G = None if shear is None else (shear, shear, shear)
    reference = str(_cell(cells, REFERENCE) or "").strip()
    others: tuple[tuple[str, str | float], ...] = ()
    if "dry density" in values:
        others += (("area_density_dry", values["dry density"]),)
    if reference:
        others += (("source", reference),)
    strong = not orthotropic or not {"UTS", "UCS"} & set(values)
    made = Material(
        name,
        values["density"],
        E,
        G,
        nu,
        None if orthotropic else _three(values, *["UTS"] * 3),
        None if orthotropic else _three(values, *["UCS"] * 3),
        ply_thickness=values["thickness"],
        orthotropic=orthotropic,
        others=others,
    )
    return made, taken, strong


def _three(values: dict[str, float], *keys: str) -> Axes | None:
    if any(key not in values for key in keys):
        return None
    first, second, third = (values[key] for key in keys)
    return first, second, third


def _cell(cells: Sequence[Cell], k: int) -> Cell:
    cell = cells[k] if k < len(cells) else None
    return None if isinstance(cell, str) and not cell.strip() else cell


def _value(cells: Sequence[Cell], k: int) -> float | None:
    cell = _cell(cells, k)
    return None if cell is None else number(str(cell))
