"""How a blade's products are made: what each export and build may be asked for."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from enum import StrEnum
from typing import Any

from bladegen.cad import exchange, solids, step_documents
from bladegen.errors import ExportError
from bladegen.exports.provenance import word
from bladegen.formats.openfast.beams import LATEST
from bladegen.support.arguments import amount, function, instance, one_of, suggestion, whole
from bladegen.support.arrays import Array
from bladegen.support.values import brief
from bladegen.surface import mesh
from bladegen.surface.grids import grid
from bladegen.surface.tips import Tip, flat_tip
from bladegen.surface.volumes.volume import Extrusion

__all__ = ["UNITS", "Kind", "Options"]

UNITS = {"m": 1.0, "mm": 1000.0}
_FIXED_UNITS = {
    ".glb": "m",
    ".3mf": "mm",
    ".cgns": "m",
    ".volume.cgns": "m",
    ".volume.foam.zip": "m",
}
TOLERANCES = 1e-6, 0.05  # m; millimetres that are given for metres leave the range


class Kind(StrEnum):
    """What a file holds, and so what can be measured on it."""

    solid = "solid"
    curves = "curves"
    triangles = "triangles"
    grid = "grid"
    volume = "volume"
    shell = "shell"
    structure = "structure"
    beam = "beam"
    definition = "definition"
    table = "table"
    picture = "picture"


@dataclass(frozen=True)
class Options:
    """How products are made; each format takes what concerns it.

    Parameters
    ----------
    tolerance : float
        Solids: largest distance to the blade's sections [m].
    sections : int, optional
        Solids: exactly so many sections instead of as many as the tolerance needs.
    split : bool
        Solids: sides in pieces on which CAD systems find the volume, not one face each.
    stations : int
        Meshes: how many sections.
    tip : callable
        Solids, meshes, grids and volumes: `tips.flat_tip` or `tips.round_tip`.
    unit : str
        Meshes, PLOT3D and VTK: "m" or "mm".  STEP and 3MF are always in millimetres, GLB and
        CGNS in metres.
    step_schema : str
        STEP: "ap242" or "ap214".
    timestamp : str, optional
        STEP and IGES: the time in the header, ISO 8601, instead of now.
    author, organisation : str
        STEP and IGES: who the file says made it; nobody if not given.
    command : str
        What was typed, for files to say; without folders and without what changes no file.
    largest : int, optional
        Solids: the most bytes that a file may take.
    spans : (k,) array, optional
        Solids: sections to begin with, such as those of a blade that is alike.
    spacing : Spacing
        Grids and volumes: how many points, and cell sizes where it matters.
    extrusion : Extrusion
        Volumes: first height, growth, distance.
    element : float
        Shell models: size of the elements [m].
    laminates : bool
        Shell models: composite sections, layer by layer, which CalculiX does not take.
    openfast : int
        Beam properties for OpenFAST: 5, or 4 for it and what was before.
    polars, reynolds : optional
        Definitions: where polars are from, as for `formats.writing.write`.
    """

    tolerance: float = solids.DEFAULT_TOLERANCE
    sections: int | None = None
    split: bool = False
    stations: int = mesh.SECTIONS
    tip: Tip = flat_tip
    unit: str = "m"
    step_schema: str = "ap242"
    timestamp: str | None = None
    author: str = ""
    organisation: str = ""
    largest: int | None = None
    spans: Array | None = None
    spacing: grid.Spacing = field(default_factory=grid.Spacing)
    extrusion: Extrusion = field(default_factory=Extrusion)
    element: float = 1.0
    laminates: bool = False
    openfast: int = LATEST
    polars: str | None = None
    reynolds: float | None = None
    command: str = ""

    def __post_init__(self) -> None:
        one_of(self.unit, UNITS, "unit", ExportError)
        one_of(self.step_schema, exchange.STEP_SCHEMAS, "step_schema", ExportError)
        tolerance, (least, most) = amount(self.tolerance, "tolerance", ExportError), TOLERANCES
        if not least <= tolerance <= most:
            raise ExportError(
                f"tolerance: got {tolerance:g} m, allowed is {least:g} to {most:g} m "
                f"({least * 1e3:g} to {most * 1e3:g} mm); 0.3 mm is tolerance=3e-4 in Python, "
                "--tolerance 0.3mm in the shell"
            )
        whole(self.stations, "stations", ExportError)
        if self.sections is not None:
            whole(self.sections, "sections", ExportError)
        if self.openfast not in (LATEST - 1, LATEST):
            raise ExportError(
                f"openfast: got {self.openfast!r}, allowed are 5, and 4 for it and what was before"
            )
        for name in ("author", "organisation"):
            must = "text, such as 'Ada Lovelace'"
            instance(getattr(self, name), str, name, must, ExportError)
        function(self.tip, "tip", "bladegen.surface.tips.flat_tip or round_tip", ExportError)
        must = "a bladegen.surface.grids.grid.Spacing"
        instance(self.spacing, grid.Spacing, "spacing", must, ExportError)
        must = "a bladegen.surface.volumes.volume.Extrusion"
        instance(self.extrusion, Extrusion, "extrusion", must, ExportError)

    __repr__ = brief

    def settings(self, kind: Kind, suffix: str) -> dict[str, str]:
        """Return the options that matter to a file of a kind and suffix, in words."""
        found: dict[str, str] = {}
        if kind in (Kind.solid, Kind.curves, Kind.structure):
            if self.sections is None:
                found["tolerance_mm"] = word(1e3 * self.tolerance)
            else:
                found["solid_sections"] = word(self.sections)
            if self.split and kind is Kind.solid:
                found["split"] = "yes"
            if suffix.endswith((".step", ".stp")):
                found["schema"] = self.step_schema
            if suffix != ".brep":  # which has no place for it
                told = {"author": self.author, "organisation": self.organisation}
                found |= {key: word(value) for key, value in told.items() if value}
        if kind in (Kind.grid, Kind.volume):
            spacing = asdict(self.spacing).items()
            found |= {f"grid_{k}": "coupled" if v is None else word(v) for k, v in spacing}
            grown = asdict(self.extrusion).items() if kind is Kind.volume else ()
            found |= {f"volume_{k}": word(v) for k, v in grown if v is not None}
        if kind in (Kind.triangles, Kind.table):
            found["stations"] = word(self.stations)
        if kind in (Kind.solid, Kind.structure, Kind.triangles, Kind.grid, Kind.volume):
            found["tip"] = word(self.tip)
        if kind in (Kind.triangles, Kind.grid, Kind.volume):
            found["unit"] = _FIXED_UNITS.get(suffix, self.unit)
        own = {Kind.shell: ("element", "laminates"), Kind.beam: ("openfast",)}
        found |= {name: word(getattr(self, name)) for name in own.get(kind, ())}
        if kind is Kind.definition:
            given = {"polars": self.polars, "reynolds": self.reynolds}
            found |= {key: word(value) for key, value in given.items() if value is not None}
        return found

    @property
    def told(self) -> dict[str, Any]:
        """What writers of CAD files are told of time and author."""
        author = step_documents.Author(self.author, self.organisation)
        return {"timestamp": self.timestamp, "author": author}

    @classmethod
    def named(cls, given: Mapping[str, Any]) -> "Options":
        """Return options by their names, or say which name is none.

        Raises
        ------
        ExportError
            If one is none, or out of range.
        """
        known = [entry.name for entry in fields(cls)]
        for name in given:
            if name not in known:
                raise ExportError(
                    f"{name}: no option of export, allowed are {', '.join(known)}"
                    f"{suggestion(name, known)}"
                )
        return cls(**given)
