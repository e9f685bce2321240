"""windIO 1: angles in radians, the pitch axis as a fraction of the chord."""

import math
from functools import partial

from bladegen.formats.common.document import Node, Range
from bladegen.formats.windio import reading as windio

__all__ = ["LAYOUT", "read", "recognises"]


def schedule(shape: Node) -> list[windio.Entry]:
    """Read `airfoil_position`: a grid and the labels of the airfoils on it."""
    position = shape["airfoil_position"]
    grid, labels = position["grid"].span_fractions(), position["labels"].members()
    names = [label.text() for label in labels]
    if grid is not None and labels and len(grid) != len(labels):
        position.problem(f"grid has {len(grid)} entries and labels {len(labels)}, must be alike")
        return []
    etas = [None] * len(labels) if grid is None else grid.tolist()
    return [
        windio.Entry(name, eta, label)
        for name, eta, label in zip(names, etas, labels, strict=False)
        if name is not None
    ]


LAYOUT = windio.Layout(
    version="1",
    shape="outer_shape_bem",
    offset="pitch_axis",
    thickness="relative_thickness",
    axis=("outer_shape_bem", "reference_axis"),
    schedule=schedule,
    tilt=tuple(
        ("components", "nacelle", part, name)
        for part in ("drivetrain", "outer_shape_bem")
        for name in ("uptilt", "uptilt_angle")
    ),
    angle=1.0,
    turn=Range(-math.pi / 2, math.pi / 2, "rad"),
)
recognises = partial(windio.recognises, layout=LAYOUT)
read = partial(windio.read, layout=LAYOUT)
