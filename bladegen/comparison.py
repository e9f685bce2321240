"""How far two surfaces lie apart: files of any kind, or blades, each way and over span.

Distances are exact to the triangles (VTK's implicit distance): CAD files are triangulated to
`DEFLECTION`, blades to `mesh.SECTIONS` sections.  Metres; the blade frame's z is the span.
pyvista is imported when first needed.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bladegen import cad_files, mesh
from bladegen.arrays import Array
from bladegen.blade import Blade
from bladegen.errors import FileError
from bladegen.mesh import TriangleMesh
from bladegen.preview import quietly, require_renderer
from bladegen.preview.cameras import VIEWS
from bladegen.preview.drawing import (
    add_colour_bar,
    add_surface,
    cuts,
    dress,
    look,
    shaded,
    signed_distances,
)
from bladegen.preview.picture import save_image
from bladegen.preview.renderer import image_of
from bladegen.preview.scene import MILLIMETRES, Field, Layer, Scene
from bladegen.style import INK, STATION

__all__ = ["Comparison", "compared", "draw", "scene", "surface_of"]

DEFLECTION = 1e-3  # m, of triangles to the CAD surface they stand for; finer takes minutes
BANDS = 10  # of the span, in the table
SAME_SCALE = 30.0  # sizes that differ by more are in other units: a mesh file names none
MESHES = (".stl", ".glb", ".ply", ".obj", ".3mf", ".off")
SIZE = (1600, 700)  # pixels


@dataclass(frozen=True, eq=False)
class Comparison:
    """Signed distances [m] between two surfaces, positive outside of the other.

    Parameters
    ----------
    one, other : TriangleMesh
        The surfaces [m].
    of_one, of_other : (v,), (w,) arrays
        From the vertices of each to the other's surface.
    """

    one: TriangleMesh
    other: TriangleMesh
    of_one: Array
    of_other: Array

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
        z = np.concatenate([self.one.vertices[:, 2], self.other.vertices[:, 2]])
        distance = MILLIMETRES * np.concatenate([self.of_one, self.of_other])
        low, high = self.one.vertices[:, 2].min(), self.one.vertices[:, 2].max()
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


def surface_of(source: Path | Blade) -> TriangleMesh:
    """Return the surface of a file or a blade as triangles [m].

    Raises
    ------
    FileError
        If the file is of no kind that has a surface.
    """
    if isinstance(source, Blade):
        return mesh.from_blade(source)
    suffix = source.suffix.lower()
    if not source.is_file():
        raise FileError(str(source), ["is no file"])
    if suffix in cad_files.READERS:
        return cad_files.triangulated(cad_files.read(source), DEFLECTION)
    if suffix in MESHES:
        triangles = mesh.read(source)
        return TriangleMesh(triangles.vertices, triangles.faces)
    allowed = ", ".join([*cad_files.READERS, *MESHES])
    raise FileError(str(source), [f"suffix {suffix!r}, allowed are {allowed}"])


def compared(one: TriangleMesh, other: TriangleMesh) -> tuple[Comparison, str]:
    """Measure two surfaces against each other.

    Returns
    -------
    Comparison
    str
        What was assumed of units, or "": mesh files name none, so a surface a thousand times
        as large as the other is taken to be in millimetres.
    """
    sizes = [float(np.ptp(surface.vertices, axis=0).max()) for surface in (one, other)]
    ratio, note = sizes[0] / sizes[1], ""
    if ratio > SAME_SCALE:
        one, note = _shrunk(one), "the first file is taken to be in millimetres"
    elif ratio < 1.0 / SAME_SCALE:
        other, note = _shrunk(other), "the second file is taken to be in millimetres"
    return Comparison(one, other, signed_distances(one, other), signed_distances(other, one)), note


def scene(comparison: Comparison, title: str) -> Scene:
    """Return the first surface coloured by its distance from the other, with cuts of the other.

    Fields and layers have the names of a perturbed blade's, so that the same keys show them.
    """
    shown, other = comparison.one, comparison.other
    distance = MILLIMETRES * comparison.of_one
    label = "distance from the other, mm, outside positive"
    figures = comparison.figures
    return Scene(
        title=title,
        caption=f"largest distance {figures['maximum_mm']:.3g} mm, RMS {figures['rms_mm']:.3g} mm",
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
            if row:
                add_colour_bar(plotter, actor, field.label)
        image = image_of(plotter, f"{path}: the picture")
    save_image(image, path)


def _shrunk(surface: TriangleMesh) -> TriangleMesh:
    return TriangleMesh(surface.vertices / MILLIMETRES, surface.faces)
