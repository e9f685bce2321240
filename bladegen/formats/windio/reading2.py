"""windIO 2: angles in degrees, the distance from leading edge to axis in metres."""

import math
from functools import partial

from bladegen.formats.common.document import FRACTION, Node, Range
from bladegen.formats.windio import reading as windio

__all__ = ["LAYOUT", "read", "recognises"]


def schedule(shape: Node) -> list[windio.Entry]:
    """Read `airfoils`: names, with or without their position over span."""
    entries = []
    for item in shape["airfoils"].members():
        name, eta = item["name"].text(), None
        if item.has("spanwise_position"):
            eta = item["spanwise_position"].number(FRACTION)
        if name is not None:
            entries.append(windio.Entry(name, eta, item))
    return entries


LAYOUT = windio.Layout(
    version="2",
    shape="outer_shape",
    offset="section_offset_y",
    thickness="rthick",
    axis=("reference_axis",),
    schedule=schedule,
    tilt=(("components", "drivetrain", "outer_shape", "uptilt"),),
    angle=math.pi / 180.0,
    turn=Range(-90.0, 90.0, "deg"),
)
recognises = partial(windio.recognises, layout=LAYOUT)
read = partial(windio.read, layout=LAYOUT)
