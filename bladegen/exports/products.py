"""What a blade's files are made from: its solid, mesh, grid and volume, each made once."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

from bladegen.blade.blade import Blade
from bladegen.blade.layup.beam.precomp import beam_properties, require_solver
from bladegen.blade.layup.beam.properties import BeamProperties
from bladegen.blade.layup.layup import Layup
from bladegen.blade.layup.shell.model import ShellModel, shell_model
from bladegen.cad import solids
from bladegen.cad.structure import assembly
from bladegen.errors import ExportError, Finding
from bladegen.exports import marks
from bladegen.exports.options import Kind, Options
from bladegen.exports.provenance import Provenance, made_from
from bladegen.surface import mesh
from bladegen.surface.grids import grid
from bladegen.surface.inner.inner import TOLERANCE
from bladegen.surface.volumes import volume

__all__ = ["Products", "require"]

INSIDE = {
    Kind.structure: "a structure in CAD",
    Kind.shell: "a shell model",
    Kind.beam: "a table of beam properties",
}


def require(blade: Blade, kind: Kind) -> None:
    """Raise where a blade has nothing inside of which a file of a kind would be made.

    Raises
    ------
    ExportError
        As said, with what has some; `MissingLibraryError` if what makes it is not installed.
    """
    if kind in INSIDE and blade.layup is None:
        raise ExportError(
            f"{blade.name}: its definition has no webs and layers, of which {INSIDE[kind]} "
            "is made; iea15mw and nrel5mw have some, and turbine files of windIO"
        )
    if kind is Kind.beam:
        require_solver()


@dataclass(frozen=True, eq=False)
class Products:
    """What a blade's files are made from, each made once and when first asked for."""

    blade: Blade
    options: Options = field(default_factory=Options)
    progress: Callable[[str], None] = lambda _: None
    remarks: list[Finding] = field(default_factory=list)  # what a format cannot hold

    @cached_property
    def solid(self) -> solids.Solid:
        """The closed solid."""
        return solids.solid(
            self.blade,
            tolerance=self.options.tolerance,
            sections=self.options.sections,
            spans=self.options.spans,
            tip=self.options.tip,
            split=self.options.split,
            progress=self.progress,
        )

    @cached_property
    def mesh(self) -> mesh.TriangleMesh:
        """The triangle mesh."""
        self.progress("meshing")
        return mesh.from_blade(self.blade, stations=self.options.stations, tip=self.options.tip)

    @cached_property
    def grid(self) -> grid.Grid:
        """The structured grid."""
        self.progress("making the grid")
        return grid.from_blade(self.blade, self.options.spacing, self.options.tip)

    @cached_property
    def volume(self) -> volume.Volume:
        """The volume around the structured grid."""
        made, progress = self.grid, self.progress
        return volume.volume_of(self.blade, made, self.options.extrusion, progress)

    @cached_property
    def inside(self) -> assembly.Inside:
        """The skin, cut where layers end, the webs, and the inner surface."""
        layup, solid = self._layup(Kind.structure), self.solid
        self.progress("cutting the skin where layers end")
        tolerance = max(TOLERANCE, self.options.tolerance)
        made = assembly.inside(solid, layup, tolerance, self.options.tip)
        self.remarks.extend(made.findings)
        return made

    def _layup(self, kind: Kind) -> Layup:
        """Return what lies inside the skin, or say that there is nothing."""
        require(self.blade, kind)
        layup: Layup | None = self.blade.layup
        assert layup is not None
        return layup

    @cached_property
    def shell(self) -> ShellModel:
        """The shell model of skin and webs."""
        layup = self._layup(Kind.shell)
        self.progress("making the shell")
        model = shell_model(layup, self.options.element)
        self.remarks.extend(model.findings)
        return model

    @cached_property
    def beam(self) -> BeamProperties:
        """Mass and stiffness over span."""
        self._layup(Kind.beam)
        self.progress("finding beam properties")
        return beam_properties(self.blade)

    def made_from(self, kind: Kind, suffix: str) -> Provenance:
        """Return what a file of a kind and suffix is made from."""
        options = self.options
        return replace(
            self._provenance,
            settings=self._provenance.settings + tuple(options.settings(kind, suffix).items()),
            id="",
        )

    @cached_property
    def _provenance(self) -> Provenance:
        return made_from(self.blade, {}, self.options.command)

    def mark(self, path: Path, kind: Kind, suffix: str) -> None:
        """Write what a file is made from into it, where its format has a place for it."""
        marks.put(path, self.made_from(kind, suffix))
