"""`structure` of windIO 2: anchors on the skin, webs and layers between them, angles in degrees.

A handle of an anchor (`start_nd_arc`, `end_nd_arc`, `midpoint_nd_arc`) is found by the first of
these that is there: a `plane_intersection` that defines it; a `width` that defines it, about the
midpoint or from the other end; an `offset_arc` from another anchor; a reference to another
anchor; fractions of the arc.  Files often hold the fractions besides, as the tool that wrote them
found them; they are kept as `stated`.  The anchor LE is the leading edge.

A plane without rotation is normal to the y axis of the blade's root, whatever the twist.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

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
from bladegen.definition.structure.structure import Layer, Structure, Web
from bladegen.formats.common.document import FRACTION, Node, Notes, Range
from bladegen.formats.windio.structure import parts
from bladegen.formats.windio.structure.parts import END, MIDDLE, START

__all__ = ["read"]

DEGREE = np.pi / 180.0
TURN = Range(-180.0, 180.0, "deg")
OTHER = {START: END, END: START}
SIDE = {START: "suction", END: "pressure"}
Known = tuple[Position | None, Distribution | None]


def read(root: Node) -> Structure | None:
    """Read what lies inside the skin; None if the file says nothing of it."""
    blade = root["components"]["blade"]
    if not blade.has("structure"):
        return None
    inside = Node(blade.value["structure"], f"{blade.path}.structure", root.notes)
    skin = _Anchors.of(inside)
    walls = {}
    for i, entry in enumerate(_listed(inside.value, "webs")):
        if isinstance(entry, dict):
            wall = Node(entry, f"{inside.path}.webs[{i}]", root.notes)
            walls[str(entry.get("name"))] = _Anchors.of(wall)

    def web(node: Node) -> Web | None:
        name, ends = node["name"].text(), [_end(node, key, skin) for key in (START, END)]
        low, high = parts.given_extent(node)
        (start, first), (end, last) = ends
        if name is None or start is None or end is None:
            return None
        least, most = extent_of(start, end)
        return Web(name, start, end, (max(low, least), min(high, most)), (first, last))

    def layer(node: Node) -> Layer | None:
        anchors = walls.get(str(node.value["web"]), skin) if node.has("web") else skin
        if node.has("web") and not (node.has(START) or node.has(END)):
            whole = parts.whole(0.0), parts.whole(1.0)
            return parts.layer(node, whole, (None, None), DEGREE)
        (start, first), (end, last) = (_end(node, key, anchors) for key in (START, END))
        if start is None or end is None:
            return None
        return parts.layer(node, (start, end), (first, last), DEGREE)

    return parts.assembled(root, inside, web, layer)


def _listed(holder: Any, key: str) -> list[Any]:
    listed = holder.get(key) if isinstance(holder, dict) else None
    return listed if isinstance(listed, list) else []


def _end(node: Node, key: str, anchors: "_Anchors") -> Known:
    """Return where a web or a layer starts or ends, and the fractions that are stated besides."""
    place = node[key]
    if not place.has("anchor"):
        given = parts.curve(place, parts.ARC)
        return (None if given is None else Arc(given)), None
    return anchors.referred(place["anchor"])


@dataclass
class _Anchors:
    """The anchors of a skin or a web, found as they are asked for; `asked` are on the way."""

    nodes: dict[str, Node]
    known: dict[tuple[str, str], Known] = field(default_factory=dict)
    asked: list[tuple[str, str]] = field(default_factory=list)

    @classmethod
    def of(cls, holder: Node) -> "_Anchors":
        nodes: dict[str, Node] = {}
        for i, entry in enumerate(_listed(holder.value, "anchors")):
            if isinstance(entry, dict):
                node = Node(entry, f"{holder.path}.anchors[{i}]", holder.notes)
                nodes.setdefault(str(entry.get("name")), node)
        return cls(nodes)

    def referred(self, reference: Node) -> Known:
        """Return the place that a reference (`name`, `handle`) means."""
        name, handle = reference["name"].text(), reference["handle"].text()
        if name is None or handle is None:
            return None, None
        if name not in self.nodes:
            reference["name"].problem(f"got {name!r}, must be the name of an anchor")
        elif handle not in (START, MIDDLE, END):
            allowed = f"{START}, {END} and {MIDDLE}"
            reference["handle"].problem(f"got {handle!r}, allowed are {allowed}")
        elif (name, handle) in self.asked or len(self.asked) > parts.DEEPEST:
            reference.problem(f"{name} rests on itself, must rest on a place that is given")
        else:
            return self._known(name, handle, reference)
        return None, None

    def _known(self, name: str, handle: str, reference: Node) -> Known:
        """Return the place of a handle, the same object for all that ask."""
        key = name, handle
        if key not in self.known:
            self.asked.append(key)
            node, notes = self.nodes[name], Notes()
            quiet = Node(node.value, node.path, notes)
            place = self._place(quiet, name, handle)
            stated = None
            if place is not None and not isinstance(place, Arc) and _gives(node, handle):
                stated = parts.curve(Node(node.value[handle], handle, Notes()), parts.ARC)
            for problem in notes.problems[:1]:
                reference.notes.problems.append(problem)
            if notes.problems:
                place = None
            self.known[key] = place, stated
            self.asked.remove(key)
        if self.known[key][0] is None and not reference.notes.problems:
            reference.problem(f"where {handle} of {name} lies is not known")
        return self.known[key]

    def _place(self, node: Node, name: str, handle: str) -> Position | None:
        if name == "LE":
            return LEADING_EDGE
        rules: dict[str, Callable[[], Position | None]] = {
            "plane_intersection": lambda: _cut(node["plane_intersection"], handle),
            "width": lambda: self._beside(node, name, handle),
            "offset_arc": lambda: self._shifted(node["offset_arc"]),
        }
        for key, rule in rules.items():
            if handle in _defined(node, key):
                return rule()
        if handle in _defined(node, "offset_nd_arc"):
            node["offset_nd_arc"].problem("is not known here, allowed is offset_arc [m]")
        place = node[handle]
        if place.has("anchor"):
            return self.referred(place["anchor"])[0]
        given = parts.curve(place, parts.ARC)
        return None if given is None else Arc(given)

    def _shifted(self, shift: Node) -> Position | None:
        base, _ = self.referred(shift["anchor"])
        width = parts.curve(shift, parts.OFFSET)
        return Shifted(base, width) if base is not None and width is not None else None

    def _beside(self, node: Node, name: str, handle: str) -> Position | None:
        """Return an end that lies a width beside the other one, or half of it from the middle."""
        width = parts.curve(node["width"], parts.WIDTH)
        toward = 1.0 if handle == END else -1.0
        if MIDDLE in _defined(node, "plane_intersection") or node.has(MIDDLE):
            middle, times = self._own(node, name, MIDDLE), 0.5 * toward
            base = None if middle is None else parts.beside(middle, handle)
        elif handle in OTHER and OTHER[handle] not in _defined(node, "width"):
            base, times = self._own(node, name, OTHER[handle]), toward
        else:
            node["width"].problem(f"defines {handle}, must have a midpoint or the other end, too")
            return None
        return Shifted(base, width, times) if base is not None and width is not None else None

    def _own(self, node: Node, name: str, handle: str) -> Position | None:
        if (name, handle) in self.asked:
            node.problem(f"{name} rests on itself, must rest on a place that is given")
            return None
        return self._known(name, handle, node)[0]


def _defined(node: Node, key: str) -> tuple[str, ...]:
    """Return the handles that a rule of an anchor defines."""
    held = node.value.get(key) if isinstance(node.value, dict) else None
    defines = held.get("defines") if isinstance(held, dict) else None
    if isinstance(defines, str):
        return (defines,)
    return tuple(map(str, defines)) if isinstance(defines, list) else ()


def _gives(node: Node, handle: str) -> bool:
    held = node.value.get(handle)
    return isinstance(held, dict) and "values" in held


def _cut(node: Node, handle: str) -> Position | None:
    """Return where a plane cuts the skin: `plane_type1`, through two points of the axis."""
    side = node["side"].text()
    if side == "both":
        side = SIDE.get(handle)
    if side not in ("suction", "pressure"):
        node.problem(f"got side {node.value.get('side')!r} for {handle}, allowed is one side of it")
    if not isinstance(node.value.get("plane_type1"), dict):
        node.problem("plane_type1 is missing, no other plane is known here")
    if node.notes.problems or side is None:
        return None
    plane = node["plane_type1"]
    if plane.has("anchor_curve") and plane.value["anchor_curve"] != "reference_axis":
        given = plane.value["anchor_curve"]
        plane["anchor_curve"].problem(f"got {given!r}, allowed is 'reference_axis'")
    rotation = plane["rotation"].number(TURN) if plane.has("rotation") else 0.0
    ends = _ends(plane["anchors_nd_grid"]) if plane.has("anchors_nd_grid") else None
    given = node.has("offset")
    offset = parts.curve(node["offset"], parts.OFFSET) if given else Distribution.constant(0.0)
    if node.notes.problems or offset is None:
        return None
    turn = Distribution.constant(rotation * DEGREE) if rotation else None
    return PlaneCut(side, offset, turn, "root", ends)


def _ends(node: Node) -> tuple[float, float] | None:
    """Return the span fractions of the two points that a plane goes through."""
    given = node.numbers(FRACTION)
    if given is None:
        return None
    if len(given) != 2 or not given[0] < given[1]:
        node.problem("must be two span fractions that increase")
        return None
    return float(given[0]), float(given[1])
