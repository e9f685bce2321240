"""What a shape mode does: the section looked at, and moved along the mode to both sides."""

import numpy as np

from bladegen.studio.page.drawing.svg import path, picture
from bladegen.support.arrays import Array

__all__ = ["mode"]

SIZE = 300, 120


def mode(profiles: Array, effect: str, step: float) -> str:
    """Draw profiles (3, n, 2): minus a step [rad], as it is, and plus a step."""
    low, high = profiles.min(axis=(0, 1)), profiles.max(axis=(0, 1))
    room = np.array(SIZE) - 12.0
    scale = float((room / (high - low)).min())
    middle = 0.5 * (low + high)
    spots = (profiles - middle) * [scale, -scale] + 0.5 * np.array(SIZE)
    kinds = ("less", "before", "more")
    words = f"{effect}: the section at minus {step:.3f} rad, as it is, and at plus {step:.3f} rad"
    parts = [path(points, kind, closed=True) for points, kind in zip(spots, kinds, strict=True)]
    return picture(SIZE, words, parts)
