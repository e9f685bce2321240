"""`internal_structure_2d_fem` of windIO 1 from a `Structure`: each layer with its own rule."""

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.distribution import Distribution
from bladegen.definition.structure.positions import LEADING_EDGE, Arc, PlaneCut, Position
from bladegen.definition.structure.structure import Layer, Web
from bladegen.formats.windio.structure.parts import END, MIDDLE, START, whole
from bladegen.formats.windio.structure.written import (
    EDGES,
    Strip,
    Written,
    extents,
    materials,
    strip_of,
)
from bladegen.formats.windio.writing import Document, Note, axis, pairs

__all__ = ["document"]


def document(definition: BladeDefinition, note: Note) -> tuple[Document, list[Document]] | None:
    """Return `internal_structure_2d_fem` and the materials; None if there is no structure."""
    structure = definition.structure
    if structure is None:
        return None
    written = Written(definition, note)
    skin = [layer for layer in structure.layers if not layer.web]
    own = [one for one in skin if strip_of(one.start, one.end) or isinstance(one.start, Arc)]
    starts = {one.start: one.name for one in reversed(own)}
    ends = {one.end: one.name for one in reversed(own)}
    webs = [
        {"name": web.name, **_places(web, written, {}, {}), **extents(web)}
        for web in structure.webs
    ]
    layers = []
    for layer in structure.layers:
        if layer.web:
            places = _on_web(layer)
        else:
            others = ({k: v for k, v in kind.items() if v != layer.name} for kind in (starts, ends))
            places = _places(layer, written, *others)
        angle = layer.angle
        layers.append(
            {
                "name": layer.name,
                "material": layer.material,
                **({"web": layer.web} if layer.web else {}),
                "thickness": pairs(layer.thickness),
                **places,
                **({} if angle is None else {"fiber_orientation": pairs(angle)}),
                **extents(layer),
            }
        )
    made: Document = {"reference_axis": axis(definition), "webs": webs, "layers": layers}
    return made, materials(structure.materials)


def _on_web(layer: Layer) -> Document:
    if (layer.start, layer.end) == (whole(0.0), whole(1.0)):
        return {}
    held = ((START, layer.start), (END, layer.end))
    return {key: pairs(place.fraction) for key, place in held if isinstance(place, Arc)}


def _places(
    one: Web | Layer, written: Written, starts: dict[Position, str], ends: dict[Position, str]
) -> Document:
    """Return the members that say where a web or a layer lies."""
    strip = strip_of(one.start, one.end)
    found = tuple(written.fractions(place, one, i) for i, place in enumerate((one.start, one.end)))
    stated: Document = dict(zip((START, END), found, strict=True))
    if isinstance(one.start, PlaneCut) and isinstance(one.end, PlaneCut):
        both = (one.start.side, one.end.side) == ("suction", "pressure")
        if both and one.start.offset == one.end.offset:
            return {**_plane(one.start, written), **stated}
    if strip is not None and strip.by == 0.5:
        middle = _middle(strip, written)
        if middle:
            return {**middle, "width": pairs(strip.width), **stated}
    if strip is not None and strip.base in EDGES:
        fixed = START if strip.by > 0 else END
        return {**stated, fixed: {"fixed": "TE", **stated[fixed]}, "width": pairs(strip.width)}
    for key, place, others in ((START, one.start, ends), (END, one.end, starts)):
        if place in others:
            stated[key] = {"fixed": others[place], **stated[key]}
        elif place == LEADING_EDGE:
            stated[key] = {"fixed": "LE", **stated[key]}
        elif not isinstance(place, Arc):
            written.formless(one.name, key, "1")
    return stated


def _middle(strip: Strip, written: Written) -> Document:
    if isinstance(strip.base, PlaneCut):
        return {**_plane(strip.base, written), "side": strip.base.side}
    if strip.base == LEADING_EDGE:
        return {MIDDLE: {"fixed": "LE"}}
    if strip.base in EDGES:
        return {MIDDLE: {"fixed": "TE", **pairs(whole(1.0).fraction)}}
    return {MIDDLE: pairs(strip.base.fraction)} if isinstance(strip.base, Arc) else {}


def _plane(plane: PlaneCut, written: Written) -> Document:
    """Return offset and rotation, the latter from the normal of the chord."""
    if plane.frame == "chord" and plane.rotation is not None:
        rotation = pairs(plane.rotation)
    else:
        twist = written.definition.twist
        back = -twist.values
        if plane.rotation is not None:
            back = back + plane.rotation(twist.grid)
        rotation = pairs(Distribution(twist.grid, back))
        if plane.rotation is None:
            rotation = {"fixed": "twist", **rotation}
    return {"offset_y_pa": written.offset(plane, None), "rotation": rotation}
