"""How far two surfaces lie apart: files of any kind, or blades, each way and over span.

Distances are exact to the surfaces: to the patches of CAD files and blades, to the triangles of
meshes (`distances`).  Metres; the blade frame's z is the span.  pyvista is imported when first
needed.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bladegen.measures import distances
from bladegen.measures.sides import Side, surface_of
from bladegen.measures.surfaces import Surface
from bladegen.support.arrays import Array
from bladegen.views.plots.style import INK, STATION
from bladegen.views.preview import quietly, require_renderer
from bladegen.views.rendering.blade_scene import MILLIMETRES
from bladegen.views.rendering.cameras import VIEWS
from bladegen.views.rendering.drawing import add_colour_bar, add_surface, cuts, dress, look, shaded
from bladegen.views.rendering.picture import save_image
from bladegen.views.rendering.renderer import image_of
from bladegen.views.rendering.scene import Field, Layer, Scene

__all__ = ["Comparison", "Side", "compared", "draw", "scene", "surface_of"]

BANDS = 10  # of the span, in the table
THOUSAND = 1000.0  # the one factor between units that is ever looked for
ALIKE = 0.01  # of the size, to which it must then fit
SAME_SCALE = 3.0  # sizes that differ by more are worth a word
SIZE = (1600, 700)  # pixels


@dataclass(frozen=True, eq=False)
class Comparison:
    """Signed distances [m] between two surfaces, positive outside of the other.

    Parameters
    ----------
    one, other : Surface
        The surfaces [m].
    at_one, at_other : (v, 3), (w, 3) arrays
        Points of each.
    of_one, of_other : (v,), (w,) arrays
        From these points to the other's surface.
    notes : tuple of str
        What the result says first: of units, of what was left out.
    """

    one: Surface
    other: Surface
    at_one: Array
    at_other: Array
    of_one: Array
    of_other: Array
    notes: tuple[str, ...] = ()

    @property
    def figures(self) -> dict[str, float]:
        """Largest, RMS and 99th percentile of the distances both ways [mm]."""
        both = MILLIMETRES * np.abs(np.concatenate([self.of_one, self.of_other]))
        return {
            "maximum_mm": float(both.max()),
            "rms_mm": float(np.sqrt(np.mean(both**2))),
            "percentile_99_mm": float(np.percentile(both, 99)),
        }

    def bands(self) -> list[dict[str, float]]:
        """Return the same figures for equal bands of the first surface's z."""
        z = np.concatenate([self.at_one[:, 2], self.at_other[:, 2]])
        distance = MILLIMETRES * np.concatenate([self.of_one, self.of_other])
        low, high = self.at_one[:, 2].min(), self.at_one[:, 2].max()
        edges = np.linspace(low, high, BANDS + 1)
        band = np.clip(np.searchsorted(edges, z, side="right") - 1, 0, BANDS - 1)
        rows = []
        for k in range(BANDS):
            own = distance[band == k]
            if own.size:
                rows.append(
                    {
                        "from_z_m": float(edges[k]),
                        "to_z_m": float(edges[k + 1]),
                        "maximum_mm": float(np.abs(own).max()),
                        "rms_mm": float(np.sqrt(np.mean(own**2))),
                        "mean_mm": float(own.mean()),
                    }
                )
        return rows


def compared(one: Side, other: Side) -> Comparison:
    """Measure two surfaces against each other.

    A mesh without a unit that is a thousand times as large as the other, to 1 %, is taken to be
    in millimetres.  Units that are known are believed: where sizes differ by a thousand the notes
    say so, and the comparison goes on in the metres of the definition, or of `other`.
    """
    first, second, notes = _in_one_unit(one, other)
    at_one, of_one = distances.between(first, second)
    at_other, of_other = distances.between(second, first)
    notes = (*notes, *one.remarks, *other.remarks)
    return Comparison(first, second, at_one, at_other, of_one, of_other, notes)


def _in_one_unit(one: Side, other: Side) -> tuple[Surface, Surface, tuple[str, ...]]:
    """Return both surfaces in the same unit, and what must be said of it."""
    ratio = one.surface.size / other.surface.size
    large, small = (one, other) if ratio > 1.0 else (other, one)
    times = max(ratio, 1.0 / ratio)
    if abs(times / THOUSAND - 1.0) > ALIKE:
        note = f"{large.name} is {times:.4g} times as large as {small.name}; compared as they are"
        return one.surface, other.surface, (note,) if times > SAME_SCALE else ()
    fit = f"so scaled, their sizes agree to {max(100 * abs(times / THOUSAND - 1.0), 0.01):.2g} %"
    if not large.measured:
        moved, factor = large, 1.0 / THOUSAND
        note = f"{large.name} names no unit and is taken to be in millimetres; {fit}"
    else:
        moved, still = (one, other) if other.defined or not one.defined else (other, one)
        factor = 1.0 / THOUSAND if moved is large else THOUSAND
        size = "a thousand times" if moved is large else "a thousandth of"
        note = (
            f"{moved.name} is {size} {still.name}; the comparison goes on in the metres of "
            f"{still.name}; {fit}"
        )
    first, second = (s.surface.scaled(factor) if s is moved else s.surface for s in (one, other))
    return first, second, (note,)


def scene(comparison: Comparison, title: str) -> Scene:
    """Return the first surface coloured by its distance from the other, with cuts of the other.

    Fields and layers have the names of a perturbed blade's, so that the same keys show them.
    """
    shown, other = comparison.one.mesh, comparison.other.mesh
    distance = MILLIMETRES * distances.signed(shown.vertices, comparison.other)
    label = "distance of its vertices from the other, mm, outside positive"
    figures = comparison.figures
    return Scene(
        title=title,
        caption=f"largest distance {figures['maximum_mm']:.3g} mm, RMS "
        f"{figures['rms_mm']:.3g} mm, each from the other, between vertices too",
        surface=shown,
        fields=(Field.signed("distance", label, distance, shown),),
        layers=(
            Layer("sections", (cuts(shown),), INK, 1.2),
            Layer("baseline", (cuts(other),), STATION, 1.2),
        ),
    )


def draw(comparison: Comparison, title: str, path: Path) -> None:
    """Render the first surface, seen from both sides, coloured by its distance from the other.

    Raises
    ------
    RenderError
        If this machine cannot render.
    """
    import pyvista as pv

    require_renderer()
    found = scene(comparison, title)
    field = found.fields[0]
    shown = shaded(found.surface, found.fields)
    with quietly():
        plotter = pv.Plotter(off_screen=True, window_size=list(SIZE), shape=(2, 1), border=False)
        for row, side in enumerate(("suction side", "pressure side")):
            plotter.subplot(row, 0)
            dress(plotter)
            actor = add_surface(plotter, shown, field)
            look(plotter, found.surface.vertices, VIEWS[side], 2.0 * SIZE[0] / SIZE[1])
            plotter.add_text(f"{title}, {side}", position=(16, 16), font_size=9, color=INK)
            if row == 0:
                top = SIZE[1] // 2 - 40
                plotter.add_text(found.caption, position=(16, top), font_size=9, color=INK)
            else:
                add_colour_bar(plotter, actor, field.label)
        image = image_of(plotter, f"{path}: the picture")
    save_image(image, path)
