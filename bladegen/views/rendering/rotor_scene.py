"""A whole rotor to look at: its blades and spinner where they stand, and a picture of it.

Metres, rotor frame: x downwind along the axis, z up, as `cad.rotor` has it.
"""

from pathlib import Path

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.cad.rotor import Rotor, standing
from bladegen.surface.mesh import TriangleMesh, surface
from bladegen.views.plots.figures import heading
from bladegen.views.plots.style import INK
from bladegen.views.rendering.blade_scene import thinning
from bladegen.views.rendering.cameras import View
from bladegen.views.rendering.drawing import add_surface, add_words, dress, look, shaded
from bladegen.views.rendering.picture import save_image
from bladegen.views.rendering.renderer import image_of, quietly, require_renderer
from bladegen.views.rendering.scene import Scene

__all__ = ["rotor_picture", "rotor_scene"]

SECTIONS, LANDMARKS = 120, 101  # of each blade, about
SIZE = (1920, 1080)
FROM_UPWIND = View((-1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
FROM_THE_SIDE = View((0.0, -1.0, 0.0), (0.0, 0.0, 1.0))
OBLIQUE = View((-0.86, -0.46, 0.22), (0.0, 0.0, 1.0), parallel=False)


def rotor_scene(blade: Blade, rotor: Rotor) -> Scene:
    """Return what there is to see of a rotor."""
    step = thinning(len(blade.u), LANDMARKS)
    eta = blade.stations(max(SECTIONS, len(blade.eta) + 2))
    parts = standing(rotor, surface(blade.sections(eta)[:, ::step]))
    points, faces, start = [], [], 0
    for part in parts:
        points.append(part.mesh.vertices @ part.rotation.T + part.shift)
        faces.append(part.mesh.faces + start)
        start += len(part.mesh.vertices)
    whole = TriangleMesh(np.concatenate(points), np.concatenate(faces))
    across = 2.0 * float(np.hypot(*whole.vertices[:, 1:].T).max())
    return Scene(
        title=f"{heading(blade)}: rotor",
        caption=f"{rotor.blades} blades, {across:.4g} m across, hub radius "
        f"{rotor.hub_radius:.3g} m, precone {np.degrees(rotor.cone):.3g} deg",
        surface=whole,
    )


def rotor_picture(scene: Scene, path: Path, *, size: tuple[int, int] = SIZE) -> None:
    """Render a rotor as a PNG: from upwind to scale, from the side, and obliquely.

    Raises
    ------
    RenderError
        If this machine cannot render.
    """
    import pyvista as pv

    require_renderer()
    shown = shaded(scene.surface)
    views = (
        ("from upwind", FROM_UPWIND, (0.0, 0.0, 0.46, 0.92)),
        ("from the side", FROM_THE_SIDE, (0.46, 0.0, 0.62, 0.92)),
        ("", OBLIQUE, (0.62, 0.0, 1.0, 0.92)),
    )
    with quietly():
        plotter = pv.Plotter(off_screen=True, window_size=list(size), shape=(1, 4), border=False)
        for place, (words, view, box) in enumerate(views):
            plotter.subplot(0, place)
            plotter.renderer.viewport = box
            dress(plotter)
            add_surface(plotter, shown)
            look(plotter, scene.surface.vertices, view, _aspect(box, size))
            plotter.add_text(words, position=(16, 12), font_size=10, color=INK)
        plotter.subplot(0, 3)
        plotter.renderer.viewport = (0.0, 0.92, 1.0, 1.0)
        dress(plotter)
        add_words(plotter, f"{scene.title}\n{scene.caption}", (24, 10), 13)
        image = image_of(plotter, f"{path}: the picture")
    save_image(image, path)


def _aspect(box: tuple[float, float, float, float], size: tuple[int, int]) -> float:
    left, low, right, high = box
    return (right - left) * size[0] / ((high - low) * size[1])
