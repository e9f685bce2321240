"""`structure` of windIO 2 from a `Structure`: an anchor for each place, shared where it is one."""

from dataclasses import dataclass, field

import numpy as np

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.structure.positions import (
    LEADING_EDGE,
    Arc,
    LeadingEdge,
    PlaneCut,
    Position,
    Shifted,
)
from bladegen.definition.structure.structure import Layer, Web
from bladegen.formats.windio.structure.parts import END, MIDDLE, START
from bladegen.formats.windio.structure.written import (
    EDGES,
    Written,
    extents,
    materials,
    strip_of,
)
from bladegen.formats.windio.writing import Document, Note, pairs

__all__ = ["document"]

DEGREES = 180.0 / np.pi
FLAT = 1e-6  # rad, by which the rotation of a plane may vary over span
Reference = tuple[str, str]


def document(definition: BladeDefinition, note: Note) -> tuple[Document, list[Document]] | None:
    """Return `structure` and the materials; None if there is none."""
    structure = definition.structure
    if structure is None:
        return None
    skin = _Anchors(Written(definition, note))
    on_skin = [layer for layer in structure.layers if not layer.web]
    strips = [layer for layer in on_skin if strip_of(layer.start, layer.end)]
    skin.edges()
    order: tuple[Web | Layer, ...] = (*structure.webs, *strips, *on_skin)
    for one in order:
        skin.add(one)
    walls = {web.name: _Anchors(Written(definition, note)) for web in structure.webs}
    for layer in structure.layers:
        if layer.web:
            walls[layer.web].wall(layer)
    webs = [
        {"name": web.name, **skin.ends(web), "anchors": walls[web.name].made, **extents(web)}
        for web in structure.webs
    ]
    layers = [_layer(layer, walls[layer.web] if layer.web else skin) for layer in structure.layers]
    made: Document = {"anchors": skin.made, "webs": webs, "layers": layers}
    return made, materials(structure.materials)


def _layer(layer: Layer, anchors: "_Anchors") -> Document:
    angle = layer.angle
    return {
        "name": layer.name,
        **anchors.ends(layer),
        **({"web": layer.web} if layer.web else {}),
        "material": layer.material,
        "thickness": pairs(layer.thickness),
        **({} if angle is None else {"fiber_orientation": pairs(angle, DEGREES)}),
        **extents(layer),
    }


@dataclass
class _Anchors:
    """Anchors as they are made, and by which name and handle each place is known."""

    written: Written
    made: list[Document] = field(default_factory=list)
    known: dict[Position, Reference] = field(default_factory=dict)

    def edges(self) -> None:
        """Make the anchors TE and LE."""
        one = Web("LE", LEADING_EDGE, LEADING_EDGE)
        self.made.append(
            {"name": "TE", **{handle: pairs(arc.fraction) for arc, handle in EDGES.items()}}
        )
        self.made.append({"name": "LE", START: self.written.fractions(LEADING_EDGE, one, 0)})
        self.known |= {arc: ("TE", handle) for arc, handle in EDGES.items()}
        self.known[LEADING_EDGE] = "LE", START

    def ends(self, one: Web | Layer) -> Document:
        """Return the references of a web or a layer to its anchors."""
        return {key: _reference(self.known[place]) for key, place in _ends(one)}

    def wall(self, layer: Layer) -> None:
        """Make the anchor of a layer on a web: fractions of its height."""
        if all(place in self.known for _, place in _ends(layer)):
            return
        attached = "shell_attachment" if not self.made else f"part_{len(self.made)}"
        name = f"{layer.web}_{attached}"
        self.made.append(
            {"name": name} | {k: self.written.fractions(p, layer, 0) for k, p in _ends(layer)}
        )
        self.known |= {place: (name, key) for key, place in _ends(layer)}

    def add(self, one: Web | Layer) -> None:
        """Make the anchor of those places of a web or a layer that are not known yet."""
        new = [(key, place) for key, place in _ends(one) if place not in self.known]
        if not new:
            return
        taken = {anchor["name"] for anchor in self.made}
        name, i = one.name, 1
        while name in taken:
            name, i = f"{one.name}_{i}", i + 1
        anchor: Document = {"name": name}
        for end, (key, place) in enumerate(_ends(one)):
            if place in self.known:
                anchor[key] = _reference(self.known[place])
            else:
                anchor[key] = self.written.fractions(place, one, end)
        for key, place in new if not self._pair(anchor, one) else ():
            if not self._single(anchor, key, place):
                self.written.formless(one.name, key, "2")
        if isinstance(one, Web) and "plane_intersection" not in anchor:
            said = "stands on no plane; WISDEM 4 takes webs on planes alone, and stops at this one"
            self.written.note(f"structure: {one.name}", said)
        self.made.append(anchor)
        self.known |= {place: (name, key) for key, place in new}

    def _pair(self, anchor: Document, one: Web | Layer) -> bool:
        """Add the one rule for both ends to an anchor, if there is one."""
        first, last, strip = one.start, one.end, strip_of(one.start, one.end)
        if isinstance(first, PlaneCut) and last == _other_side(first):
            return self._plane(anchor, first, "both", [START, END])
        if strip is None:
            return False
        if strip.by == 0.5 and not self._middle(anchor, strip.base):
            return False
        defines = {0.5: [START, END], 1.0: [END], -1.0: [START]}[strip.by]
        end = START if strip.by > 0.0 else END
        known = strip.by == 0.5 or strip.base in self.known
        if not (known or self._single(anchor, end, strip.base)):
            return False
        anchor["width"] = {**pairs(strip.width), "defines": defines}
        if strip.by == 0.5 and strip.base in EDGES:
            said = "its middle is the trailing edge; WISDEM 4 takes middles at LE alone"
            self.written.note(f"structure: {one.name}", said)
        return True

    def _middle(self, anchor: Document, place: Position) -> bool:
        if place in self.known:
            anchor[MIDDLE] = _reference(self.known[place])
        elif isinstance(place, Arc):
            anchor[MIDDLE] = pairs(place.fraction)
        elif isinstance(place, PlaneCut):
            return self._plane(anchor, place, place.side, [MIDDLE])
        else:
            return False
        return True

    def _single(self, anchor: Document, key: str, place: Position) -> bool:
        """Add the rule of one end to an anchor, if there is a form for it."""
        if isinstance(place, PlaneCut) and "plane_intersection" not in anchor:
            return self._plane(anchor, place, place.side, [key])
        if isinstance(place, Shifted) and place.base in self.known and "offset_arc" not in anchor:
            reference = _reference(self.known[place.base])
            anchor["offset_arc"] = {"defines": key, **reference, **pairs(place.width, place.times)}
            return True
        return isinstance(place, Arc | LeadingEdge)

    def _plane(self, anchor: Document, plane: PlaneCut, side: str, defines: list[str]) -> bool:
        turn, through = self.written.turn(plane, plane.offset.grid), plane.through or (0.0, 1.0)
        if np.ptp(turn) > FLAT:
            return False
        anchor["plane_intersection"] = {
            "side": side,
            "defines": defines,
            "plane_type1": {
                "anchor_curve": "reference_axis",
                "anchors_nd_grid": [*through],
                "rotation": float(DEGREES * turn.mean()) if np.any(np.abs(turn) > FLAT) else 0.0,
            },
            "offset": self.written.offset(plane, through),
        }
        return True


def _ends(one: Web | Layer) -> tuple[tuple[str, Position], tuple[str, Position]]:
    return (START, one.start), (END, one.end)


def _other_side(plane: PlaneCut) -> PlaneCut:
    return PlaneCut("pressure", plane.offset, plane.rotation, plane.frame, plane.through)


def _reference(known: Reference) -> Document:
    return {"anchor": {"name": known[0], "handle": known[1]}}
