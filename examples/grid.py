"""The structured grid of the IEA 15 MW blade's rounded tip: as a whole, at its nose and its edge.

python examples/grid.py [FILE.png]
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv
from PIL import Image

import bladegen as bg
from bladegen.surface.grids import grid
from bladegen.surface.tips import round_tip
from bladegen.views import preview
from bladegen.views.plots import style

COLOURS = {
    "suction side": "#b9c6d2",
    "pressure side": "#dfe6ec",
    "trailing edge": "#d55e00",
    "edge ring": "#e69f00",
    "edge core": "#f0e442",
    "tip rim": "#0072b2",
    "tip core": "#8cc5e6",
}
SIZE = (1920, 760)


def main(target: Path) -> None:
    """Draw each block in a colour of its own, seen from three places."""
    blade = bg.Blade.from_definition(bg.read("iea15mw"))
    made = grid.from_blade(blade, tip=round_tip)
    suction = made.blocks[0].points[-1]
    nose, edge, middle = suction[-1], suction[0], 0.5 * (suction[-1] + suction[0])
    chord = float(np.linalg.norm(nose - edge))
    gap = float(np.linalg.norm(edge - made.blocks[1].points[-1, -1]))
    views = (
        ("tip", middle, (1.2, 0.3, 1.5), (0, -1, 0), 0.55 * chord),
        ("nose", nose, (0.6, -0.8, 1.6), (1, 0, 0), 0.04 * chord),
        ("trailing edge", edge, (0.6, 1.2, 0.9), (0, 0, 1), 3.5 * gap),
    )
    preview.require_renderer()
    with preview.quietly():
        plotter = pv.Plotter(off_screen=True, window_size=list(SIZE), shape=(1, 3), border=False)
        for column, (title, focus, away, up, scale) in enumerate(views):
            plotter.subplot(0, column)
            plotter.set_background("white")
            for block in made.blocks:
                x, y, z = np.moveaxis(np.array(block.points), -1, 0)[..., None]
                plotter.add_mesh(
                    pv.StructuredGrid(x, y, z),
                    color=COLOURS[block.name],
                    show_edges=True,
                    edge_color=style.INK,
                    ambient=0.35,
                )
            plotter.camera_position = [focus + chord * np.array(away), focus, up]
            plotter.enable_parallel_projection()
            plotter.camera.parallel_scale = scale
            plotter.add_text(title, position=(16, 12), font_size=14, color=style.INK)
        image = Image.fromarray(plotter.screenshot(None, return_img=True))
        plotter.close()
    image.quantize(128).save(target, optimize=True)
    cells = sum(block.eta[1:, 1:].size for block in made.blocks)
    print(f"wrote {target}; {cells} cells in {len(made.blocks)} blocks")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "grid.png"))
