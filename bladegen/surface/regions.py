"""The regions of a blade's surface: their names, and the colours that files show them in.

Faces of a solid that is cut in several carry a region's name and a number, such as
``suction side 2``; what rounds the tip of a blunt edge is `TIP_EDGE`.
"""

__all__ = ["COLOURS", "EDGE", "PRESSURE", "REGIONS", "ROOT", "SUCTION", "TIP", "TIP_EDGE", "colour"]

SUCTION, PRESSURE, EDGE = "suction side", "pressure side", "trailing edge"
ROOT, TIP, TIP_EDGE = "root", "tip", "tip trailing edge"
COLOURS: dict[str, tuple[int, int, int]] = {  # sRGB, 0 to 255
    SUCTION: (143, 180, 214),
    PRESSURE: (217, 222, 227),
    EDGE: (213, 94, 0),
    ROOT: (91, 103, 112),
    TIP: (230, 159, 0),
    TIP_EDGE: (213, 94, 0),
}
REGIONS = tuple(COLOURS)


def colour(face: str) -> tuple[int, int, int] | None:
    """Return the colour of a face by its name, with or without a number; None of other things."""
    return COLOURS.get(face.rstrip("0123456789").rstrip())
