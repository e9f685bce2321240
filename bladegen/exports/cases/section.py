"""The flow around a section of a blade, as a case that OpenFOAM runs: two dimensions, steady.

The mesh is an O-grid around the section in metres, the chord line along x, written without any
mesher; the stream comes at the angle of attack.  Nothing of OpenFOAM is needed to write it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import degrees
from pathlib import Path
from typing import Any

from bladegen.blade.blade import Blade
from bladegen.errors import GeometryError
from bladegen.exports.cases import dictionaries
from bladegen.exports.cases.cell_measures import figures
from bladegen.exports.cases.conditions import Conditions, flow_at
from bladegen.exports.cases.folder import put, put_dictionaries, put_fields, put_run, written
from bladegen.exports.cases.guidance import allrun, readme
from bladegen.exports.cases.marching import marched
from bladegen.exports.cases.outline import Outline, around
from bladegen.exports.cases.poly_mesh import extruded, write_mesh
from bladegen.exports.provenance import made_from
from bladegen.support.arguments import require_within
from bladegen.support.arrays import Array
from bladegen.support.values import brief
from bladegen.surface.wall_spacing import first_height

__all__ = ["SectionCase", "section_case"]

RADII = (5.0, 1000.0)  # chords
ENDS = (1, 1_000_000)
SLAB = 0.1  # chords between the planes
TOLD = (
    "eta",
    "speed_m_s",
    "reynolds",
    "alpha_deg",
    "y_plus",
    "far_field_chords",
    "around",
    "growth",
)


@dataclass(frozen=True, eq=False)
class SectionCase:
    """A mesh around a section and what flows there.

    Parameters
    ----------
    blade : Blade
    eta : float
        Span fraction.
    flow : Conditions
    outline : Outline
    layers : (m, n, 2) array
        Points of the mesh [m], the wall first.
    y_plus : float
        That of the first cells' centres, by a flat plate's friction.
    growth : float
        Of the cells' heights from layer to layer.
    radius : float
        Of the far field, chords.
    end : int
        Iterations.
    """

    blade: Blade
    eta: float
    flow: Conditions
    outline: Outline
    layers: Array
    y_plus: float
    growth: float
    radius: float
    end: int

    __repr__ = brief

    @cached_property
    def figures(self) -> dict[str, Any]:
        """What the case is, in figures: the flow, the mesh and its quality."""
        flow, mesh = self.flow, figures(self.layers)
        low, high = mesh.pop("first_height")
        return {
            "eta": self.eta,
            "chord_m": flow.chord,
            "relative_thickness": float(self.blade.relative_thickness(self.eta)),
            "speed_m_s": flow.speed,
            "reynolds": flow.reynolds,
            "alpha_deg": degrees(flow.alpha),
            "y_plus": self.y_plus,
            "far_field_chords": self.radius,
            "growth": self.growth,
            **mesh,
            "first_height_mm": [1e3 * low, 1e3 * high],
        }

    @property
    def remarks(self) -> list[str]:
        """What is to be said of the flow."""
        if not self.flow.is_stalled:
            return []
        return ["most sections stall at this angle, and a steady run may not settle"]

    def write(self, folder: Path, *, command: str = "") -> None:
        """Write the case; what an earlier one of ours left in the folder is replaced.

        Raises
        ------
        ExportError
            If the folder holds anything else, or cannot be written.
        """
        written(folder, lambda draft: self._write(draft, command))

    def _write(self, draft: Path, command: str) -> None:
        told = {name: f"{self.figures[name]:.9g}" for name in TOLD} | {"end": str(self.end)}
        made = made_from(self.blade, told, command).text
        note = f"{self.blade.name}, {100.0 * self.eta:g} % span; README.md says how it was made"
        thickness = SLAB * self.flow.chord
        put_fields(draft, dictionaries.fields(self.flow), note)
        put_dictionaries(draft / "constant", dictionaries.constant(self.flow), note)
        system = dictionaries.system(self.flow, thickness, self.end)
        put_dictionaries(draft / "system", system, note)
        home = draft / "constant" / "polyMesh"
        home.mkdir()
        mesh = extruded(self.layers, thickness, self.outline.sides)
        write_mesh(mesh, home, group=dictionaries.BLADE)
        put(draft / "README.md", readme(self.blade.name, self.figures, self.flow, self.end, made))
        put_run(draft, allrun(("checkMesh",), "$count 1 1", "forces", "iteration, Cd, Cs, Cl"))


def section_case(
    blade: Blade,
    eta: float,
    *,
    speed: float | None = None,
    reynolds: float | None = None,
    alpha: float | None = None,
    y_plus: float = 2.0,
    cells: int = 512,
    growth: float = 1.15,
    radius: float = 500.0,
    end: int = 1000,
    progress: Callable[[str], None] = lambda _: None,
) -> SectionCase:
    """Return the case of a blade's section.

    Parameters
    ----------
    blade : Blade
    eta : float
        Span fraction.
    speed, reynolds, alpha : float, optional
        See `conditions.flow_at` [m/s, 1, rad].
    y_plus : float
        Of the first cells' centres.
    cells : int
        Around the section.
    growth : float
        Of cells' heights, outward.
    radius : float
        Of the far field, chords.
    end : int
        Iterations.
    progress : callable
        Told what is being done.

    Raises
    ------
    GeometryError
        If a value is out of range, or no mesh can be made.
    """
    require_within(radius, "radius", RADII, GeometryError)
    require_within(end, "end", ENDS, GeometryError)
    flow = flow_at(blade, eta, speed=speed, reynolds=reynolds, alpha=alpha)
    outline = around(blade, eta, cells)
    height = 2.0 * float(first_height(flow.reynolds, flow.chord, y_plus))
    progress("marching the mesh")
    layers = marched(outline.points, height, growth, radius * flow.chord)
    return SectionCase(blade, eta, flow, outline, layers, y_plus, growth, radius, end)
