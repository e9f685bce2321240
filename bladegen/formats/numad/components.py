"""Sheet "Components" of a NuMAD workbook: what lies inside the skin, between key points.

From row 7 on there is a component a row: of the skin, from "b,c" on the high and the low pressure
side, or of a web, whose feet are "b" or "0.5b-c".  From the outside to the inside; outside of its
control points there is nothing of a component (NuMAD's xlsBlade, ComponentDef, BladeDef).

A blade is usable without it, so nothing here refuses a file: what cannot be read is left out, and
a finding says where and why.  Plies are not rounded to whole ones.
"""

import re
from collections import Counter
from dataclasses import replace

import numpy as np

from bladegen.definition.distribution import Distribution
from bladegen.definition.structure.positions import Arc, Between, Position
from bladegen.definition.structure.structure import Layer, Structure, Web
from bladegen.errors import DefinitionError, Finding
from bladegen.formats.common.document import Notes
from bladegen.formats.common.table import Rows
from bladegen.formats.numad import materials as numad_materials
from bladegen.formats.numad.component_rows import (
    MOST,
    SHEET,
    Component,
    LeftOutError,
    component,
    text,
    widths,
)
from bladegen.formats.numad.keypoints import LABELS, SIDES, places

__all__ = ["SHEET", "read"]

FIRST_ROW, COLUMNS = 7, 9
DEGREE = np.pi / 180.0
Keys = dict[str, dict[str, Position]]
_SHARE = re.compile(r"(\d*\.?\d+)([a-z]+)-([a-z]+)")


def read(
    components: Rows,
    materials: Rows,
    notes: Notes,
    *,
    ends: tuple[float, float] = (0.0, 1.0),
    twisted: bool = False,
) -> Structure | None:
    """Return webs, layers and materials; None if there are none.

    Parameters
    ----------
    components, materials : rows of cells
        The sheets; no rows if there is none.
    notes : Notes
        Takes findings.
    ends : pair of float
        Span fractions of the blade between which those of the sheet count.
    twisted : bool
        Whether the plane of spar caps and webs is twisted with the chord.
    """
    by_row = dict(components)
    table = [
        (at, cells)
        for at, cells in components
        if at >= FIRST_ROW and any(text(cells, k) for k in range(COLUMNS))
    ]
    if not table:
        return None
    given = widths(by_row, notes)
    if len(table) > MOST:
        said = f"has {len(table)} components, allowed are {MOST}; the structure is left out"
        notes.findings.append(Finding(SHEET, said))
    if given is None or len(table) > MOST:
        return None
    known = numad_materials.read(materials, notes)
    keys = {side: places(side, given, "chord" if twisted else "root") for side in SIDES}
    rows: list[Component] = []
    for at, cells in table:
        try:
            rows.append(component(at, cells, known, ends))
        except (LeftOutError, DefinitionError) as error:
            _left_out(error, at, text(cells, 1), notes)
    layers: list[Layer] = []
    webs: list[Web] = []
    for group in sorted({one.group for one in rows}):
        parts = [one for one in rows if one.group == group]
        if not group:
            layers += _on_skin(parts, keys, notes)
            continue
        web = _web(group, parts, keys, notes)
        if web is not None:
            webs.append(web)
            layers += _on_web(web, parts, notes)
    if not layers:
        return None
    if any(np.ptp(one.thickness.values) for one in rows):
        said = "plies between control points are not rounded to whole ones, as they are in NuMAD"
        notes.findings.append(Finding(SHEET, said))
    used = {layer.material for layer in layers}
    kept = tuple(one for one in known.values() if one.name in used)
    return Structure(kept, tuple(webs), _named(layers))


def _left_out(error: Exception, at: int, name: str, notes: Notes) -> None:
    column = error.column if isinstance(error, LeftOutError) else "G"
    notes.findings.append(Finding(f"{SHEET}!{column}{at}", f"{error}; {name or 'it'} is left out"))


def _on_skin(parts: list[Component], keys: Keys, notes: Notes) -> list[Layer]:
    """Return the layers of the skin."""
    made: list[Layer] = []
    for one in parts:
        try:
            made += _sides(one, keys)
        except LeftOutError as error:
            _left_out(error, one.row, one.name, notes)
    return made


def _sides(one: Component, keys: Keys) -> list[Layer]:
    """Return a component's layers: one a side, or one for both if it goes round the nose."""
    ends: dict[str, tuple[int, int]] = {}
    for side, column in (("HP", "E"), ("LP", "F")):
        labels = one.extents[side]
        if not labels:
            continue
        for label in labels:
            _require_known(label, column)
        if len(labels) != 2 or labels[0] == labels[1]:
            shown = ",".join(labels)[:40]
            raise LeftOutError(column, f"extents: got {shown!r}, must be two, such as b,c")
        first, last = sorted(LABELS.index(label) for label in labels)
        ends[side] = first, last
    if not ends:
        raise LeftOutError("E", "extents: none on either side")
    if len(ends) == 2 and all(first == 0 for first, _ in ends.values()):
        places = tuple(keys[side][LABELS[ends[side][1]]] for side in ("LP", "HP"))
        return [_layer(one, one.name, (places[0], places[1]))]
    made = []
    for side, (first, last) in ends.items():
        inner, outer = (keys[side][LABELS[i]] for i in (first, last))
        where = (inner, outer) if side == "HP" else (outer, inner)
        name = f"{one.name} {side}" if len(ends) == 2 else one.name
        made.append(_layer(one, name, where))
    return made


def _web(group: int, parts: list[Component], keys: Keys, notes: Notes) -> Web | None:
    """Return the web of a group, whose components must all say the same of its feet."""
    try:
        feet = [_foot(side, column, parts, keys) for side, column in (("LP", "F"), ("HP", "E"))]
    except LeftOutError as error:
        for one in parts:
            _left_out(error, one.row, one.name, notes)
        return None
    low, high = zip(*(one.span for one in parts), strict=True)
    return Web(f"web {group}", feet[0], feet[1], (min(low), max(high)))


def _on_web(web: Web, parts: list[Component], notes: Notes) -> list[Layer]:
    """Return the layers of a web, over all of its height."""
    whole = (Arc(Distribution.constant(0.0)), Arc(Distribution.constant(1.0)))
    for part in parts:
        if part.angle:
            said = f"{part.name} lies on a web, where NuMAD has no angle; taken as 0"
            notes.findings.append(Finding(f"{SHEET}!D{part.row}", said))
    return [_layer(replace(part, angle=0.0), part.name, whole, web.name) for part in parts]


def _foot(side: str, column: str, parts: list[Component], keys: Keys) -> Position:
    """Return where a web stands: at a key point, or at a share from one to another ("0.5b-c")."""
    said = sorted({",".join(one.extents[side]) for one in parts})
    label = said[0]
    if len(said) > 1:
        each = " and ".join(one or "none" for one in said)[:40]
        raise LeftOutError(column, f"foot: got {each}, must be the same in a group")
    match = _SHARE.fullmatch(label)
    if match is None:
        if label not in LABELS:
            allowed = ", ".join(LABELS)
            said_so = f"foot: got {label[:40]!r}, known here are {allowed} and such as 0.5b-c"
            raise LeftOutError(column, said_so)
        return keys[side][label]
    for one in match.groups()[1:]:
        _require_known(one, column)
    share = float(match[1])
    if not 0.0 <= share <= 1.0:
        raise LeftOutError(column, f"foot: got {label[:40]!r}, the share must be 0 to 1")
    return Between(keys[side][match[2]], keys[side][match[3]], share)


def _require_known(label: str, column: str) -> None:
    if label not in LABELS:
        allowed = ", ".join(LABELS)
        raise LeftOutError(column, f"extents: got {label[:40]!r}, known here are {allowed}")


def _layer(one: Component, name: str, where: tuple[Position, Position], web: str = "") -> Layer:
    turned = Distribution.constant(one.angle * DEGREE) if one.angle else None
    return Layer(
        name,
        one.material.name,
        one.thickness,
        *where,
        angle=turned,
        web=web,
        extent=one.span,
    )


def _named(layers: list[Layer]) -> tuple[Layer, ...]:
    """Return the layers with a name each: the second of a name is NAME 2, and so on."""
    taken = {layer.name for layer in layers}
    seen: Counter[str] = Counter()
    made = []
    for layer in layers:
        seen[layer.name] += 1
        name = layer.name
        while seen[layer.name] > 1:
            name = f"{layer.name} {seen[layer.name]}"
            if name not in taken:
                break
            seen[layer.name] += 1
        taken.add(name)
        made.append(replace(layer, name=name))
    return tuple(made)
