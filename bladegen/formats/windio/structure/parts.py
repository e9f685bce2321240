"""What lies inside the skin, read from windIO: what versions 1 and 2 share.

A blade is usable without it, so nothing here refuses a file: what cannot be read is left out, and
a finding says where and why.  A place that is given in a way not known here is never guessed.
Conventions: windIO documentation and schema, https://ieawindsystems.github.io/windIO.
"""

from collections.abc import Callable, Iterable
from typing import TypeVar

import numpy as np

from bladegen.definition.distribution import Distribution
from bladegen.definition.structure.positions import Arc, Position, Shifted
from bladegen.definition.structure.structure import Axes, Layer, Material, Stated, Structure, Web
from bladegen.errors import DefinitionError
from bladegen.formats.common.document import FRACTION, Node, Notes, Range
from bladegen.support.arguments import suggestion

__all__ = [
    "ARC",
    "DEEPEST",
    "END",
    "HELD",
    "MIDDLE",
    "OFFSET",
    "START",
    "WIDTH",
    "Places",
    "assembled",
    "beside",
    "curve",
    "given_extent",
    "guarded",
    "layer",
    "strip",
    "whole",
]

START, MIDDLE, END = "start_nd_arc", "midpoint_nd_arc", "end_nd_arc"  # of a region of the skin
ARC = Range(-1.0, 2.0, "of the arc")
OFFSET = Range(-100.0, 100.0, "m")
WIDTH = Range(0.0, 100.0, "m")
THICKNESS = Range(0.0, 10.0, "m")
DENSITY = Range(0.0, 3e4, "kg/m3", above=True)
MOST = 1000  # webs, or layers; published blades have 30
DEEPEST = 50  # places that rest on one another; published ones on 3
ROUNDING = 1e-9  # m; published layers run out at -1e-20
FIGURE = Range(-1e15, 1e15)
HELD = {
    "E": "E",
    "G": "G",
    "nu": "nu",
    "Xt": "tensile",
    "Xc": "compressive",
    "S": "shear",
}

BONDS = ("resin", "adhesive")  # in no layer, and WISDEM runs no blade without them
OWN = frozenset({"name", "rho", "orth", "ply_t", *HELD})

Places = tuple[Position, Position]
T = TypeVar("T")


def guarded(node: Node, read: Callable[[Node], T | None]) -> T | None:
    """Read a part; if it holds problems it is left out, and a finding says so."""
    notes = Notes()
    try:
        part = read(Node(node.value, node.path, notes))
    except DefinitionError as error:
        notes.problems.append(f"{node.path}: {error}")
        part = None
    for problem in notes.problems[:1]:
        where, _, said = problem.partition(": ")
        Node(None, where, node.notes).finding(f"{said}; {_name(node)} is left out")
    node.notes.findings.extend(notes.findings)
    return None if notes.problems else part


def _name(node: Node) -> str:
    name = node.value.get("name") if isinstance(node.value, dict) else None
    return str(name) if name is not None else "it"


def curve(node: Node, allowed: Range, factor: float = 1.0) -> Distribution | None:
    """Return a quantity over span that may end before root and tip."""
    try:
        return node.distribution(allowed, factor=factor, partial=True)
    except DefinitionError as error:
        node.problem(str(error))
        return None


def whole(value: float) -> Arc:
    """Return the same fraction of the arc at all spans."""
    return Arc(Distribution.constant(value))


def strip(middle: Position | None, width: Distribution | None) -> Places | None:
    """Return the ends of a strip about a place; about the trailing edge one is on each side."""
    if middle is None or width is None:
        return None
    return Shifted(beside(middle, START), width, -0.5), Shifted(beside(middle, END), width, 0.5)


def beside(middle: Position, handle: str) -> Position:
    """Return the place from which a strip about another one goes on to its start or its end.

    A strip about the trailing edge starts on the pressure side and ends on the suction side.
    """
    if isinstance(middle, Arc) and np.all(np.isin(middle.fraction.values, (0.0, 1.0))):
        return whole(1.0 if handle == START else 0.0)
    return middle


def layer(
    node: Node, places: tuple[Position, Position], stated: Stated, angle: float
) -> Layer | None:
    """Return a layer that lies between two places; `angle` is the file's unit of angle [rad]."""
    name, material = node["name"].text(), node["material"].text()
    if not node.has("thickness") and node.has("n_plies"):
        node["n_plies"].problem("is given without a thickness, must have one [m]")
        return None
    thickness = curve(_not_below(node["thickness"]), THICKNESS)
    turned = None
    if node.has("fiber_orientation"):
        quarter = Range(-np.pi / angle, np.pi / angle)
        turned = curve(node["fiber_orientation"], quarter, angle)
    if name is None or material is None or thickness is None:
        return None
    low, high = float(thickness.grid[0]), float(thickness.grid[-1])
    given = given_extent(node)
    return Layer(
        name,
        material,
        thickness,
        *places,
        angle=turned,
        web=str(node.value.get("web") or ""),
        extent=(max(low, given[0]), min(high, given[1])),
        stated=stated,
    )


def _not_below(node: Node) -> Node:
    """Return a quantity without what is below 0 by rounding."""
    held = node.value
    listed = held.get("values") if isinstance(held, dict) else None
    if not isinstance(listed, list):
        return node
    values = [
        0.0 if isinstance(value, float) and -ROUNDING < value < 0.0 else value for value in listed
    ]
    return Node({**held, "values": values}, node.path, node.notes)


def given_extent(node: Node) -> tuple[float, float]:
    """Return the span fractions between which a web or a layer is said to lie."""
    ends = [
        node[key].number(FRACTION) if node.has(key) else None
        for key in ("start_nd_grid", "end_nd_grid")
    ]
    low, high = 0.0 if ends[0] is None else ends[0], 1.0 if ends[1] is None else ends[1]
    if low > high:
        node.problem(f"start_nd_grid {low:g} is beyond end_nd_grid {high:g}, must be before it")
    return low, high


def assembled(
    root: Node,
    inside: Node,
    web: Callable[[Node], Web | None],
    layer: Callable[[Node], Layer | None],
) -> Structure | None:
    """Return webs, layers and the materials that they name; None if there is nothing of them."""
    if not isinstance(inside.value, dict):
        inside.finding("must be a mapping; left out")
        return None
    webs = _once(inside, "webs", web)
    layers = _once(inside, "layers", layer)
    materials = _materials(root, [one.material for one in layers.values()])
    names = [_name(Node(value, "", root.notes)) for value in _listed(root)]
    kept = []
    for place, one in layers.items():
        node = Node(None, place, inside.notes)
        if one.material not in materials:
            meant = suggestion(one.material, names)
            node.finding(f"material {one.material} is not known; {one.name} is left out{meant}")
        elif one.web and one.web not in {known.name for known in webs.values()}:
            meant = suggestion(one.web, [known.name for known in webs.values()])
            node.finding(f"web {one.web} is not known; {one.name} is left out{meant}")
        else:
            kept.append(one)
    if not (webs or kept):
        return None
    return Structure(tuple(materials.values()), tuple(webs.values()), tuple(kept))


def _once(inside: Node, kind: str, read: Callable[[Node], T | None]) -> dict[str, T]:
    """Return the parts of a list by their place in the file, each name once."""
    if not inside.has(kind) or inside.value[kind] == []:
        return {}
    listed, notes = inside.value[kind], Notes()
    if isinstance(listed, list) and len(listed) > MOST:
        inside[kind].finding(f"has {len(listed)} entries, allowed are {MOST}; left out")
        return {}
    entries = Node(listed, f"{inside.path}.{kind}", notes).members()
    for problem in notes.problems:
        inside[kind].finding(f"{problem.partition(': ')[2]}; left out")
    parts: dict[str, T] = {}
    names: set[str] = set()
    for entry in entries:
        node = Node(entry.value, entry.path, inside.notes)
        name = _name(node)
        if name in names:
            node.finding(f"{name} stands twice; this one is left out")
            continue
        part = guarded(node, read)
        if part is not None:
            parts[node.path] = part
            names.add(name)
    return parts


def _materials(root: Node, wanted: Iterable[str]) -> dict[str, Material]:
    """Return the materials that layers name, and those that bond them, in the order of the file."""
    names = {*wanted, *BONDS, *map(str.capitalize, BONDS)}
    found: dict[str, Material] = {}
    for i, value in enumerate(_listed(root)):
        node = Node(value, f"materials[{i}]", root.notes)
        name = _name(node)
        if name in names and name not in found:
            made = guarded(node, _material)
            if made is not None:
                found[name] = made
    return found


def _listed(root: Node) -> list[object]:
    listed = root.value.get("materials") if isinstance(root.value, dict) else None
    return listed if isinstance(listed, list) else []


def _material(node: Node) -> Material | None:
    name, density = node["name"].text(), node["rho"].number(DENSITY)
    held = {ours: _axes(node[key]) for key, ours in HELD.items() if node.has(key)}
    ply = node["ply_t"].number(THICKNESS) if node.has("ply_t") else None
    if name is None or density is None:
        return None
    orthotropic = bool(node.value.get("orth"))
    others = tuple((key, _plain(one)) for key, one in node.value.items() if key not in OWN)
    kept = tuple((key, one) for key, one in others if one is not None)
    return Material(name, density, **held, ply_thickness=ply, orthotropic=orthotropic, others=kept)


def _plain(value: object) -> str | float | tuple[float, ...] | None:
    """Return a text, a number or a list of numbers, None for anything else."""
    if isinstance(value, list) and all(isinstance(one, int | float) for one in value):
        return tuple(value)
    return value if isinstance(value, str | int | float) else None


def _axes(node: Node) -> Axes | None:
    """Return three figures: those of a list, or one for all directions."""
    if not isinstance(node.value, list):
        one = node.number(FIGURE)
        return None if one is None else (one, one, one)
    figures = node.numbers(FIGURE)
    if figures is None:
        return None
    if len(figures) != 3:
        node.problem(f"has {len(figures)} entries, must be 3, or one figure")
        return None
    first, second, third = figures.tolist()
    return first, second, third
