"""How far two surfaces lie apart: files of any kind, or blades, each way and over span.

Distances are exact to the triangles (VTK's implicit distance): CAD files are triangulated to
`DEFLECTION`, blades to `mesh.SECTIONS` sections.  Metres; the blade frame's z is the span.
pyvista is imported when first needed.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bladegen import cad_files, mesh
from bladegen.arrays import Array
from bladegen.blade import Blade
from bladegen.errors import FileError
from bladegen.mesh import TriangleMesh
from bladegen.preview import INK, quietly, require_renderer

__all__ = ["Comparison", "compared", "draw", "surface_of"]

DEFLECTION = 1e-3  # m, of triangles to the CAD surface they stand for; finer takes minutes
BANDS = 10  # of the span, in the table
SAME_SCALE = 30.0  # sizes that differ by more are in other units: a mesh file names none
MESHES = (".stl", ".glb", ".ply", ".obj", ".3mf", ".off")
MILLIMETRES = 1000.0
SIZE = (1600, 700)  # pixels
SHOWN = 99.5  # per cent of the vertices whose distances the colours resolve


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
    return Comparison(one, other, _distances(one, other), _distances(other, one)), note


def draw(comparison: Comparison, title: str, path: Path) -> None:
    """Render the first surface, seen from both sides, coloured by its distance from the other.

    Raises
    ------
    RenderError
        If this machine cannot render.
    """
    import pyvista as pv
    from PIL import Image

    require_renderer()
    shown = _poly(comparison.one)
    shown["distance, mm"] = MILLIMETRES * comparison.of_one
    reach = float(np.percentile(np.abs(shown["distance, mm"]), SHOWN)) or 1e-6
    with quietly():
        plotter = pv.Plotter(off_screen=True, window_size=list(SIZE), shape=(2, 1), border=False)
        for row, side in enumerate((1.0, -1.0)):
            plotter.subplot(row, 0)
            plotter.set_background("white")
            plotter.add_mesh(
                shown.copy(),
                scalars="distance, mm",
                cmap="PuOr",  # told apart by everyone; white where nothing moved
                clim=(-reach, reach),
                scalar_bar_args={"color": INK, "vertical": False, "fmt": "%.3g"},
                show_scalar_bar=row == 1,
            )
            low, high = np.array(shown.bounds).reshape(3, 2).T
            middle = 0.5 * (low + high)
            size = float(high[2] - low[2])
            eye = middle + np.array([side * size, 0.0, 0.0])
            plotter.camera_position = [eye, middle, (0, -1, 0)]
            plotter.enable_parallel_projection()
            plotter.camera.parallel_scale = 0.54 * size * SIZE[1] / (2 * SIZE[0])
            name = ("suction side", "pressure side")[row]
            plotter.add_text(f"{title}, {name}", position=(16, 16), font_size=9, color=INK)
        image = plotter.screenshot(None, return_img=True)
        plotter.close()
    Image.fromarray(image).save(path, format="PNG", optimize=True)


def _shrunk(surface: TriangleMesh) -> TriangleMesh:
    return TriangleMesh(surface.vertices / MILLIMETRES, surface.faces)


def _distances(of: TriangleMesh, to: TriangleMesh) -> Array:
    """Return the signed distances of one surface's vertices to the other's triangles."""
    measured = _poly(of).compute_implicit_distance(_poly(to))
    return np.asarray(measured["implicit_distance"], dtype=np.float64)


def _poly(surface: TriangleMesh) -> Any:
    import pyvista as pv

    return pv.PolyData.from_regular_faces(np.array(surface.vertices), surface.faces)
