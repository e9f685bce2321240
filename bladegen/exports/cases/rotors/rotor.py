"""A rotor in steady wind, as a case that OpenFOAM meshes and runs: one blade in its sector.

Rotor frame: x along the axis, downwind; the blade points up, its suction side downwind at zero
pitch, and the rotor turns clockwise as seen from upwind.  Precone leans it upwind, as in
`cad.rotor`; there is neither tilt nor tower.  Metres and radians.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import degrees, floor, log2
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.cad.rotor import Rotor, rotor_of
from bladegen.errors import GeometryError
from bladegen.exports.cases.folder import put, put_dictionaries, put_fields, put_run, written
from bladegen.exports.cases.guidance import allrun
from bladegen.exports.cases.rotors import dictionaries
from bladegen.exports.cases.rotors.blocks import block_mesh
from bladegen.exports.cases.rotors.guidance import readme
from bladegen.exports.cases.rotors.meshing import EDGES, SURFACE, Layers, snappy
from bladegen.exports.cases.rotors.operation import TURN, Operation, operation_of
from bladegen.exports.cases.rotors.placing import edges, radii, require_clear, standing
from bladegen.exports.cases.rotors.sector import Sector
from bladegen.exports.provenance import made_from
from bladegen.support.arguments import require_within
from bladegen.support.arrays import Array
from bladegen.support.values import brief
from bladegen.surface.mesh import TriangleMesh
from bladegen.surface.mesh_files import obj_text
from bladegen.surface.regions import REGIONS
from bladegen.surface.wall_spacing import first_height

__all__ = ["RotorCase", "rotor_case"]

INNER = 0.2  # span fraction, within which a blade's lean is left aside
BLADES = 3, 6  # of rotors whose sectors have blocks of sound angles
CELLS = 16, 1024
FINE = 200  # cells, below which it is said that they are few
RADII = 3.0, 50.0  # tip radii
GROWTHS = 1.05, 2.0
ENDS = 1, 1_000_000
UPSTREAM, DOWNSTREAM = 0.8, 1.2  # of the far field's radius: inlet and outlet
SLENDER = 3.0  # how many times as long cells are along the blade
STRIP = 0.75  # background cells are at most that share of the strip's half width
AHEAD, OFF, UP = 1.37, 0.41, 0.71  # a point in the flow: cells ahead of the blade, beside; radii
LANDMARKS = 201
STEPS = "blockMesh", "snappyHexMesh -overwrite", "checkMesh", "setFields"
TOLD = (
    "wind_m_s",
    "rotor_speed_rpm",
    "pitch_deg",
    "hub_radius_m",
    "y_plus",
    "around",
    "growth",
    "far_field_radii",
)


@dataclass(frozen=True, eq=False)
class RotorCase:
    """A blade in its sector, and how the rotor works.

    Parameters
    ----------
    blade : Blade
    rotor : Rotor
        Where its blades stand.
    flow : Operation
        How it works.
    surface : TriangleMesh
        The blade where it stands [m].
    sector : Sector
    level : int
        Halvings of background cells on the blade.
    layers : Layers
        Of cells on the blade.
    cells : int
        Around the section that stands for the blade.
    y_plus : float
        That of the first cells' centres there, by a flat plate's friction.
    end : int
        Iterations.
    """

    blade: Blade
    rotor: Rotor
    flow: Operation
    surface: TriangleMesh
    sector: Sector
    level: int
    layers: Layers
    cells: int
    y_plus: float
    end: int

    __repr__ = brief

    @property
    def sense(self) -> float:
        """1 if the rotor turns about x by the right hand, clockwise from upwind, else -1."""
        return -1.0 if self.blade.mirrored else 1.0

    @property
    def size(self) -> float:
        """Of cells on the blade [m]."""
        return self.sector.cell * 0.5**self.level

    @property
    def regions(self) -> list[str]:
        """Of the blade's surface."""
        assert self.surface.regions is not None  # a blade's mesh has them
        return [REGIONS[number] for number in np.unique(self.surface.regions).tolist()]

    @property
    def inside(self) -> Array:
        """A point in the flow, on no face of the background [m]."""
        cell, sector = self.sector.cell, self.sector
        up = UP * sector.tip
        return np.array([sector.blade[0] + sector.lean * up - AHEAD * cell, OFF * cell, up])

    @cached_property
    def figures(self) -> dict[str, Any]:
        """What the case is, in figures: how the rotor works, and its mesh."""
        flow, sector, layers = self.flow, self.sector, self.layers
        return {
            "blades": sector.blades,
            "sector_deg": 2.0 * degrees(sector.half),
            "tip_radius_m": flow.radius,
            "hub_radius_m": self.rotor.hub_radius,
            "hub_cylinder_m": sector.hub,
            "wind_m_s": flow.wind,
            "rotor_speed_rpm": flow.speed / TURN,
            "tip_speed_m_s": flow.tip_speed,
            "tip_speed_ratio": flow.ratio,
            "pitch_deg": degrees(flow.pitch),
            "reynolds": flow.reynolds,
            "far_field_radii": sector.far / flow.radius,
            "background_cell_m": sector.cell,
            "background_cells": sector.cells,
            "surface_cell_m": self.size,
            "around": self.cells,
            "level": self.level,
            "y_plus": self.y_plus,
            "first_height_mm": 1e3 * layers.first,
            "growth": layers.growth,
            "layers": layers.count,
            "layers_height_mm": 1e3 * layers.height,
        }

    @property
    def remarks(self) -> list[str]:
        """What is to be said of the case."""
        if self.cells >= FINE:
            return []
        return [
            f"{self.cells} cells around the section are few: drag comes out too high and torque "
            "too low (48 cells: drag half as high again to twice as high); docs/cfd.md says what "
            "a real run needs"
        ]

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
        note = f"{self.blade.name}, a rotor; README.md says how it was made"
        blades, layers = self.sector.blades, self.layers
        put_fields(draft, dictionaries.fields(self.flow), note)
        constant = dictionaries.constant(self.flow, self.sense)
        put_dictionaries(draft / "constant", constant, note)
        for name, part in ((SURFACE, self.surface), (EDGES, edges(self.blade, self.surface))):
            put(draft / "constant" / "triSurface" / name, obj_text(part, made))
        system = dictionaries.system(self.flow, blades, self.sector.ends[1], self.end)
        system["blockMeshDict"] = block_mesh(self.sector)
        system["snappyHexMeshDict"] = snappy(
            self.level, self.size, layers, self.inside, self.regions
        )
        put_dictionaries(draft / "system", system, note)
        page = readme(self.blade.name, self.figures, self.flow, self.end, self.remarks, made)
        put(draft / "README.md", page)
        put_run(draft, allrun(STEPS, "1 1 $count", "coefficients", "iteration, thrust coefficient"))


def rotor_case(
    blade: Blade,
    *,
    hub_radius: float | None = None,
    wind: float | None = None,
    ratio: float | None = None,
    turns: float | None = None,
    pitch: float | None = None,
    y_plus: float = 300.0,
    cells: int = 48,
    growth: float = 1.6,
    radius: float = 5.0,
    end: int = 500,
    progress: Callable[[str], None] = lambda _: None,
) -> RotorCase:
    """Return the case of a blade's rotor.

    Parameters
    ----------
    blade : Blade
        A mirror image turns the other way.
    hub_radius : float, optional
        Instead of the definition's [m].
    wind, ratio, turns, pitch : float, optional
        See `operation.operation_of` [m/s, 1, 1/min, rad].
    y_plus : float
        Of the first cells' centres, at 75 % span.
    cells : int
        Around the section there.
    growth : float
        Of layers' heights, outward.
    radius : float
        Of the far field, tip radii.
    end : int
        Iterations.
    progress : callable
        Told what is being done.

    Raises
    ------
    BladegenError
        If a value is out of range or missing, or the blade does not fit into its sector.
    """
    require_within(cells, "cells", CELLS, GeometryError)
    require_within(growth, "growth", GROWTHS, GeometryError)
    require_within(radius, "radius", RADII, GeometryError)
    require_within(end, "end", ENDS, GeometryError)
    rotor = rotor_of(blade, hub_radius=hub_radius)
    if not BLADES[0] <= rotor.blades <= BLADES[1]:
        raise GeometryError(
            f"{blade.name}: a rotor of {rotor.blades} blades, sectors are written for "
            f"{BLADES[0]} to {BLADES[1]}"
        )
    tip, reach = radii(blade, rotor)
    flow = operation_of(blade, tip, reach, wind=wind, ratio=ratio, turns=turns, pitch=pitch)
    progress("meshing the blade's surface")
    surface = standing(blade, rotor, flow.pitch)
    size = 2.0 * flow.chord / cells
    level, cell = _background(rotor, size)
    from_axis = np.hypot(surface.vertices[:, 1], surface.vertices[:, 2])
    lean = _lean(surface, from_axis)
    straight = surface.vertices[:, 0] - lean * from_axis
    sector = Sector(
        blades=rotor.blades,
        hub=rotor.spinner_radius,
        tip=float(from_axis.max()),
        far=radius * tip,
        blade=(float(straight.min()), float(straight.max())),
        lean=lean,
        ends=(-UPSTREAM * radius * tip, DOWNSTREAM * radius * tip),
        cell=cell,
        slender=SLENDER,
    )
    require_clear(blade, sector, surface.vertices)
    height = 2.0 * float(first_height(flow.reynolds, flow.chord, y_plus))
    layers = Layers.under(size, height, growth)
    return RotorCase(blade, rotor, flow, surface, sector, level, layers, cells, y_plus, end)


def _lean(surface: TriangleMesh, from_axis: Array) -> float:
    """Return how far downwind a blade goes over its radii (v,): the line by its outer part."""
    assert surface.places is not None  # a blade's mesh has them
    outer = surface.places[:, 0] > INNER
    return float(np.polyfit(from_axis[outer], surface.vertices[outer, 0], 1)[0])


def _background(rotor: Rotor, size: float) -> tuple[int, float]:
    """Return how often background cells are halved on the blade, and their size [m]."""
    wide = rotor.spinner_radius * np.sin(np.pi / rotor.blades)
    level = max(0, floor(log2(STRIP * wide / size)))
    return level, size * 2**level
