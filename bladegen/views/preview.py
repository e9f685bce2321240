"""Blades to look at: a picture, a window, a moving picture, a page that turns in a browser.

A `scene.Scene` says what there is to see; the other modules draw it.  pyvista is imported when
first needed, and before VTK is asked for a picture it is tried whether it can make one, since it
may end the process where it cannot.
"""

from bladegen.views.picture import gallery, picture, write_vtp
from bladegen.views.renderer import quietly, require_renderer, require_window
from bladegen.views.window import show

__all__ = [
    "gallery",
    "picture",
    "quietly",
    "require_renderer",
    "require_window",
    "show",
    "write_vtp",
]
