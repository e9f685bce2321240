"""`internal_structure_2d_fem` of windIO 1: webs and layers, angles in radians.

A web or a layer says where it is in one of these ways, of which the first that is there rules:
an offset of a plane (`offset_y_pa`) and its `rotation`, for layers with `side` and `width`; a
`midpoint_nd_arc` and a width; a start or an end that is fixed, and a width; a start and an end,
each fixed ("TE", "LE", or to another layer) or a fraction of the arc.  Files often hold the
fractions besides, as the tool that wrote them found them; they are kept as `stated`.

A `rotation` turns the plane from the normal of the chord, against the twist: with `fixed: twist`
it is normal to the y axis of the blade's root, as with values that are the twist negated.
"""

from dataclasses import dataclass, field

import numpy as np

from bladegen.definition.distribution import Distribution
from bladegen.definition.structure.positions import (
    LEADING_EDGE,
    Arc,
    PlaneCut,
    Position,
    Shifted,
    extent_of,
)
from bladegen.definition.structure.structure import NOTHING, Layer, Stated, Structure, Web
from bladegen.formats.common.document import Node, Notes, Range
from bladegen.formats.windio.structure import parts
from bladegen.formats.windio.structure.parts import END, MIDDLE, START, Places

__all__ = ["read"]

TURN = Range(-np.pi, np.pi, "rad")
EDGES = {START: 0.0, END: 1.0}


def read(root: Node) -> Structure | None:
    """Read what lies inside the skin; None if the file says nothing of it."""
    blade = root["components"]["blade"]
    if not blade.has("internal_structure_2d_fem"):
        return None
    inside = Node(
        blade.value["internal_structure_2d_fem"],
        f"{blade.path}.internal_structure_2d_fem",
        root.notes,
    )
    found = _Places({})
    if isinstance(inside.value, dict) and isinstance(inside.value.get("layers"), list):
        for i, entry in enumerate(inside.value["layers"]):
            if isinstance(entry, dict) and entry.get("name") is not None:
                node = Node(entry, f"{inside.path}.layers[{i}]", root.notes)
                found.entries.setdefault(str(entry["name"]), node)

    def web(node: Node) -> Web | None:
        name, places = node["name"].text(), found.of(node, web=True)
        low, high = parts.given_extent(node)
        if name is None or places is None:
            return None
        least, most = extent_of(*places)
        return Web(name, *places, (max(low, least), min(high, most)), _stated(node, places))

    def layer(node: Node) -> Layer | None:
        if node.has("web") and not (node.has(START) or node.has(END)):
            return parts.layer(node, (parts.whole(0.0), parts.whole(1.0)), NOTHING, 1.0)
        places = found.of(node, web=False)
        return None if places is None else parts.layer(node, places, _stated(node, places), 1.0)

    return parts.assembled(root, inside, web, layer)


@dataclass
class _Places:
    """Where layers are by their names, found as they are asked for; `asked` are on the way."""

    entries: dict[str, Node]
    known: dict[str, tuple[Places | None, list[str]]] = field(default_factory=dict)
    asked: list[str] = field(default_factory=list)

    def of(self, node: Node, *, web: bool) -> Places | None:
        """Return the places of a web or a layer; each is the same object for all that ask."""
        if web:
            return self._places(node, web=True)
        name = str(node["name"].text())
        if name not in self.known:
            notes = Notes()
            self.asked.append(name)
            places = self._places(Node(node.value, node.path, notes), web=False)
            self.asked.remove(name)
            self.known[name] = places, notes.problems
        places, problems = self.known[name]
        node.notes.problems.extend(problems)
        return None if problems else places

    def _places(self, node: Node, *, web: bool) -> Places | None:
        width = parts.curve(node["width"], parts.WIDTH) if node.has("width") else None
        if node.has("offset_y_pa"):
            return self._cut(node, width, web=web)
        if node.has(MIDDLE):
            middle = self._end(node, MIDDLE)
            if not node.has("width"):
                node.problem(f"{MIDDLE} is given without a width, must have one")
            return parts.strip(middle, width)
        if width is not None:
            if _fixed(node, START) or not node.has(END):
                start = self._end(node, START)
                return None if start is None else (start, Shifted(start, width))
            if _fixed(node, END) or not node.has(START):
                end = self._end(node, END)
                return None if end is None else (Shifted(end, width, -1.0), end)
        start, end = self._end(node, START), self._end(node, END)
        return (start, end) if start and end else None

    def _cut(self, node: Node, width: Distribution | None, *, web: bool) -> Places | None:
        offset, turn = parts.curve(node["offset_y_pa"], parts.OFFSET), node["rotation"]
        rotation, frame = None, "root"
        if _fixed(node, "rotation"):
            if turn.value["fixed"] != "twist":
                turn["fixed"].problem(f"got {turn.value['fixed']!r}, allowed is 'twist'")
        else:
            rotation, frame = parts.curve(turn, TURN), "chord"
        if offset is None or (rotation is None and frame == "chord"):
            return None
        if web:
            return (
                PlaneCut("suction", offset, rotation, frame),
                PlaneCut("pressure", offset, rotation, frame),
            )
        side = node["side"].text()
        if side not in ("suction", "pressure"):
            if side is not None:
                node["side"].problem(f"got {side!r}, allowed are 'suction' and 'pressure'")
            return None
        if not node.has("width"):
            node.problem("offset_y_pa is given without a width, must have one")
        return parts.strip(PlaneCut(side, offset, rotation, frame), width)

    def _end(self, node: Node, key: str) -> Position | None:
        """Return one place: fixed to an edge or to another layer, or a fraction of the arc."""
        place = node[key]
        if not _fixed(node, key):
            given = parts.curve(place, parts.ARC)
            return None if given is None else Arc(given)
        name = str(place.value["fixed"])
        if name == "TE" and key in EDGES:
            return parts.whole(EDGES[key])
        if name == "LE":
            return LEADING_EDGE
        if name == "TE":  # in the middle of a strip
            return parts.whole(1.0)
        if name in self.asked or len(self.asked) > parts.DEEPEST:
            place["fixed"].problem(f"{name} rests on itself, must rest on a place that is given")
        elif key == MIDDLE:
            place["fixed"].problem(f"{name!r} is not known here, must be LE or TE")
        elif name not in self.entries:
            place["fixed"].problem(f"{name!r} is not known here, must be TE, LE or a layer")
        else:
            notes, there = Notes(), self.entries[name]
            other = self.of(Node(there.value, there.path, notes), web=False)
            if other is not None and not notes.problems:
                return other[key == START]
            place["fixed"].problem(f"where {name} lies is not known")
        return None


def _fixed(node: Node, key: str) -> bool:
    return node.has(key) and isinstance(node.value[key], dict) and "fixed" in node.value[key]


def _stated(node: Node, places: Places) -> Stated:
    """Return the fractions of the arc that stand beside a rule."""
    found = []
    for key, place in zip((START, END), places, strict=True):
        held = node.value.get(key)
        beside = isinstance(held, dict) and "values" in held and not isinstance(place, Arc)
        quiet = Node(held, key, Notes())
        found.append(parts.curve(quiet, parts.ARC) if beside else None)
    return found[0], found[1]
