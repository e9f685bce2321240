"""One look for all pictures: colours that everyone can tell apart, and sizes of type.

Categories take the palette of Okabe and Ito (Color Universal Design, 2008), amounts the map
viridis, and signed amounts PuOr (Harrower and Brewer, 2003), white at zero; tests hold them
against simulated colour blindness.  Colours are RGB in hexadecimal, maps go by the names that
matplotlib and pyvista share.
"""

__all__ = [
    "AXES",
    "BASELINE",
    "CATEGORIES",
    "DIVERGING",
    "FAINT",
    "INK",
    "PAPER",
    "SEQUENTIAL",
    "STATION",
    "SURFACE",
    "VARIANT",
]

PAPER = "#ffffff"
INK = "#22303c"
FAINT = "#c9d1d9"  # grids, and what stays behind
SURFACE = "#b9c6d2"
CATEGORIES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
BLUE, VERMILLION, GREEN = CATEGORIES[:3]
VARIANT = BLUE
BASELINE = STATION = VERMILLION
AXES = (VERMILLION, GREEN, BLUE)  # of a frame: x, y, z
SEQUENTIAL = "viridis"
DIVERGING = "PuOr"
