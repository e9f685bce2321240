"""The soft shadow that a blade, suction side up, throws on the ground below it.

The surface goes along the light to a plane normal to x, as a mask that is blurred; metres, blade
frame.  A section darkens what lies between its ends in y, so that the mask is one outline.
"""

from typing import Any

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["add_shadow", "outline"]

LIGHT = -1.0, 0.25, 0.05  # where it goes
BELOW = 0.012  # of the length: the ground below the lowest point
SOFT = 0.007  # of the length, its blur
DARK = 64  # of 255, where no light comes
PIXELS = 1600  # of the mask, along the span
MARGIN = 4.0  # blurs around it


def outline(sections: Array, ground: float) -> Array:
    """Return the shadow's outline (2 k, 2), z and y [m], of sections (k, n, 3)."""
    down, along_y, along_z = LIGHT
    fall = (sections[..., 0] - ground) / -down
    y, z = sections[..., 1] + along_y * fall, sections[..., 2] + along_z * fall
    places = np.arange(len(sections))
    ends = [at(y, axis=1) for at in (np.argmin, np.argmax)]
    sides = [np.column_stack([z[places, end], y[places, end]]) for end in ends]
    return np.concatenate([sides[0], sides[1][::-1]])


def add_shadow(plotter: Any, sections: Array) -> None:
    """Add the shadow of a blade's sections (k, n, 3) to a plotter."""
    import pyvista as pv
    from PIL import Image, ImageDraw, ImageFilter

    length = float(np.ptp(sections[..., 2]))
    ground = float(sections[..., 0].min()) - BELOW * length
    edge = outline(sections, ground)
    margin = MARGIN * SOFT * length
    low, high = edge.min(axis=0) - margin, edge.max(axis=0) + margin
    scale = PIXELS / float(high[0] - low[0])
    size = [int(np.ceil(side)) for side in (high - low) * scale]
    mask = Image.new("L", (size[0], size[1]))
    ImageDraw.Draw(mask).polygon([tuple(at) for at in ((edge - low) * scale).tolist()], fill=DARK)
    mask = mask.filter(ImageFilter.GaussianBlur(SOFT * length * scale))
    ink = Image.new("RGBA", mask.size)
    ink.putalpha(mask)
    corners = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
    flat = pv.PolyData(
        np.column_stack([np.full(4, ground), corners[:, 1], corners[:, 0]]), faces=[4, 0, 1, 2, 3]
    )
    flat.active_texture_coordinates = np.array([[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]])
    texture = pv.Texture(np.asarray(ink))
    plotter.add_mesh(flat, texture=texture, lighting=False, reset_camera=False, render=False)
