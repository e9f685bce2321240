"""Layers and webs of the section looked at, to scale, over the baseline's outline."""

import numpy as np

from bladegen.blade.layup.pieces import Section
from bladegen.studio.page.drawing.svg import line, path, picture, text, ticks
from bladegen.support.arrays import Array

__all__ = ["layers"]

SIZE = 480, 210
FOOT = 44  # of the height, for the scale and two rows of names
COLOURS = 6  # classes m0, m1, ... of the style sheet
LETTER = 5.6  # of a name's width


def layers(now: Section, before: Section, mass: float, plain: float) -> str:
    """Draw the section's layers, webs and outline.

    Parameters
    ----------
    now, before : pieces.Section
        Of the state, and of its baseline [m].
    mass, plain : float
        What both weigh [kg/m].
    """
    width, height = SIZE
    both = np.concatenate([now.outline, before.outline])
    low, high = both.min(axis=0), both.max(axis=0)
    room = np.array([width - 24, height - FOOT - 12])
    scale = float((room / (high - low)).min())
    middle = 0.5 * (low + high)

    def at(points: Array) -> Array:
        corner = np.array([0.5 * width, 0.5 * (height - FOOT)])
        spots: Array = corner + (points - middle) * [scale, -scale]
        return spots

    half = 0.5 * width / scale
    parts = []
    for value in ticks(middle[0] - half, middle[0] + half, 5):
        x = at(np.array([value, 0.0]))[0]
        parts += [line(x, 0, x, height - FOOT), text(x, height - FOOT + 12, f"{value:g} m")]
    materials = list(dict.fromkeys(piece.material for piece in now.pieces))
    colours = {name: f"m{i % COLOURS}" for i, name in enumerate(materials)}
    for piece in now.pieces:
        parts.append(path(at(piece.border), f"piece {colours[piece.material]}", closed=True))
    parts.append(path(at(before.outline), "before"))
    parts.append(path(at(now.outline), "skin"))
    parts += _names(colours)
    words = (
        f"{len(now.pieces)} layers of {', '.join(materials)}; {mass:.1f} kg/m, "
        f"baseline {plain:.1f} kg/m"
    )
    return picture(SIZE, words, parts)


def _names(colours: dict[str, str]) -> list[str]:
    """Name materials beside their colours, in two rows if one is too short for them."""
    parts, x, y = [], 12.0, SIZE[1] - 16.0
    for name, colour in colours.items():
        wide = 26 + LETTER * len(name)
        if x + wide > SIZE[0]:
            x, y = 12.0, y + 13.0
        box = np.array([[x, y - 8], [x + 8, y - 8], [x + 8, y], [x, y]])
        parts.append(path(box, f"piece {colour}", closed=True))
        parts.append(text(x + 12, y, name, "start"))
        x += wide
    return parts
