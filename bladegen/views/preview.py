"""Blades to look at: a picture, a window, a moving picture, a page that turns in a browser.

A `scene.Scene` says what there is to see; the other modules draw it.  pyvista is imported when
first needed, and before VTK is asked for a picture it is tried whether it can make one, since it
may end the process where it cannot.
"""

import sys
import tempfile
from pathlib import Path
from typing import Any

from bladegen.blade.blade import Blade
from bladegen.views.rendering.blade_scene import scene_of
from bladegen.views.rendering.picture import gallery, picture, write_vtp
from bladegen.views.rendering.renderer import quietly, require_renderer, require_window
from bladegen.views.rendering.window import show

__all__ = [
    "gallery",
    "picture",
    "quietly",
    "require_renderer",
    "require_window",
    "show",
    "show_blade",
    "write_vtp",
]


def show_blade(blade: Blade, *, baseline: Blade | None = None, colour: str = "plain") -> None:
    """Show a blade: as a picture in a notebook, or in a window."""
    if _in_notebook():
        from IPython import display

        inline: Any = display

        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "blade.png"
            picture(blade, file, baseline=baseline, colour=colour)
            inline.display(inline.Image(file.read_bytes()))
    else:
        show(scene_of(blade, baseline), colour=colour)


def _in_notebook() -> bool:
    """Tell whether a kernel that shows pictures runs this, not a terminal."""
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    return shell is not None and hasattr(shell, "kernel")
