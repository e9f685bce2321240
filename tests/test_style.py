"""Colours are told apart by everyone, held against simulated colour blindness.

The matrices are those of Machado, Oliveira and Fernandes, IEEE Trans. Vis. Comput. Graph. 15
(2009), for whole dichromacy, and act on linear RGB.
"""

from itertools import combinations

import numpy as np
import pytest
from matplotlib import colormaps
from matplotlib.colors import to_rgb

from bladegen.views.plots import style

BLINDNESS = {
    "none": np.eye(3),
    "protanopia": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deuteranopia": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "tritanopia": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}


def seen(colours, blindness):
    """CIE L*a*b* (D65) of sRGB colours (..., 3) as they are seen."""
    rgb = np.asarray(colours, dtype=float)
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    linear = np.clip(linear @ np.transpose(BLINDNESS[blindness]), 0, 1)
    to_xyz = np.array(
        [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    )
    xyz = linear @ to_xyz.T / [0.9505, 1.0, 1.089]
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    x, y, z = np.moveaxis(f, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


@pytest.mark.parametrize("blindness", BLINDNESS)
def test_categories_differ(blindness):
    colours = seen([to_rgb(c) for c in (*style.CATEGORIES, style.INK)], blindness)
    for one, other in combinations(colours, 2):
        assert np.linalg.norm(one - other) > 9  # a difference of 2.3 can just be seen


@pytest.mark.parametrize("blindness", BLINDNESS)
@pytest.mark.parametrize(
    "pair",
    [(style.BASELINE, style.VARIANT), (style.STATION, style.SURFACE)],
    ids=["lines", "rings"],
)
def test_what_lies_side_by_side_differs_much(pair, blindness):
    one, other = seen([to_rgb(c) for c in pair], blindness)
    assert np.linalg.norm(one - other) > 30


@pytest.mark.parametrize("blindness", BLINDNESS)
def test_amounts_rise_in_lightness(blindness):
    lightness = seen(colormaps[style.SEQUENTIAL](np.linspace(0, 1, 64))[:, :3], blindness)[:, 0]
    assert np.all(np.diff(lightness) > 0)


@pytest.mark.parametrize("blindness", BLINDNESS)
def test_signs_are_told_apart_and_zero_is_light(blindness):
    lab = seen(colormaps[style.DIVERGING](np.linspace(0, 1, 65))[:, :3], blindness)
    assert np.argmax(lab[:, 0]) in range(30, 35)
    low, high = lab[8], lab[-9]
    assert np.linalg.norm(low - high) > 40
