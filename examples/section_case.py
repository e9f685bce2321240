"""The mesh around the IEA 15 MW's section at 70 % span, and the flow that OpenFOAM finds on it.

    python examples/section_case.py [FILE.png [CASE]]

CASE is a folder that has been run: bladegen case openfoam iea15mw --section 0.7 -o case/ and then
case/Allrun.  Without it the mesh alone is drawn.
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

import bladegen as bg
from bladegen.exports.cases.section import SectionCase, section_case
from bladegen.views.plots import figures, style

SPAN = 0.7


def field(case: Path, name: str) -> np.ndarray:
    """Return a field of a case's last iteration, a row a cell."""
    last = max((path for path in case.iterdir() if path.name.isdigit()), key=lambda p: int(p.name))
    text = (last / name).read_text(encoding="ascii").partition("internalField")[2]
    rows = text.partition("(\n")[2].partition("\n)")[0].split("\n")
    return np.array([row.strip("()").split() for row in rows], dtype=float)


def draw_mesh(axis: object, made: SectionCase, title: str, x: tuple, y: float) -> None:
    """Draw the mesh within x and up to y around the middle, in chords."""
    from matplotlib.collections import LineCollection

    layers = made.layers / made.flow.chord
    ring = np.concatenate([layers, layers[:, :1]], axis=1)
    for lines in (ring, layers.swapaxes(0, 1)):
        axis.add_collection(LineCollection(lines, colors=style.BASELINE, linewidths=0.3))
    axis.fill(*layers[0].T, color=style.SURFACE)
    axis.plot(*ring[0].T, color=style.INK, linewidth=1.0)
    axis.set(title=title, xlim=x, ylim=(-y, y), aspect="equal", xlabel="x, chords")


def draw_flow(axes: tuple, made: SectionCase, case: Path) -> None:
    """Draw speeds, and pressures on the section."""
    layers, flow = made.layers / made.flow.chord, made.flow
    shape = len(layers) - 1, layers.shape[1]
    speed = np.linalg.norm(field(case, "U"), axis=1).reshape(shape) / flow.speed
    pressure = field(case, "p").reshape(shape) / (0.5 * flow.speed**2)
    x, y = np.concatenate([layers, layers[:, :1]], axis=1).transpose(2, 0, 1)
    near = 78  # layers that are seen
    drawn = axes[0].pcolormesh(
        x[: near + 1], y[: near + 1], speed[:near], cmap=style.SEQUENTIAL, rasterized=True
    )
    axes[0].figure.colorbar(drawn, ax=axes[0], shrink=0.8)
    axes[0].set(
        title="speed over that of the stream",
        xlim=(-0.4, 1.6),
        ylim=(-0.6, 0.6),
        aspect="equal",
        xlabel="x, chords",
    )
    middle = 0.5 * (layers[0] + np.roll(layers[0], -1, axis=0))
    sides, start = made.outline.sides, 0
    colours = {"suction_side": style.BLUE, "pressure_side": style.VERMILLION}
    for name, count in sides.items():
        part = slice(start, start + count)
        start += count
        if name in colours:
            label = name.replace("_", " ")
            axes[1].plot(middle[part, 0], pressure[0, part], color=colours[name], label=label)
    axes[1].set(title="pressure coefficient", xlabel="x, chords")
    axes[1].invert_yaxis()
    axes[1].legend(frameon=False)


def main(target: Path, case: Path | None) -> None:
    """Draw the mesh in two places, and the flow if there is one."""
    blade = bg.Blade.from_definition(bg.read("iea15mw"))
    made = section_case(blade, SPAN)
    drawn, axes = figures.figure(2 if case else 1, 2, width=11.0, height=7.0 if case else 3.6)
    draw_mesh(axes[0, 0], made, "mesh", (-0.4, 1.6), 0.6)
    draw_mesh(axes[0, 1], made, "at the trailing edge", (0.99, 1.01), 0.006)
    axes[0, 1].set_xticks([0.99, 0.995, 1.0, 1.005, 1.01])
    if case is not None:
        draw_flow(axes[1], made, case)
    figures.save_figure(drawn, target)
    with Image.open(target) as image:
        image.convert("RGB").quantize(256, Image.Quantize.MAXCOVERAGE).save(target, optimize=True)
    print(f"wrote {target}; {made.figures['cells']} cells")


if __name__ == "__main__":
    named = [Path(word) for word in sys.argv[1:3]]
    main(named[0] if named else Path("section_case.png"), named[1] if len(named) > 1 else None)
