"""All formats that a blade is exported to: one row each, by suffix.

A new exporter is a function that writes a product to a path, and a row in `FORMATS` that says from
which product: the solid, the mesh, the grid, or the blade itself.  A package of somebody else
offers its rows by the entry point ``bladegen.exporters``; bladegen's own come first.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from bladegen.errors import ExportError
from bladegen.exports.options import Kind
from bladegen.exports.products import Products
from bladegen.exports.writers import beams, others, solids, surfaces
from bladegen.support.arguments import suggestion
from bladegen.support.plugins import Offered, guarded, offered

__all__ = ["FORMATS", "Format", "format_of", "formats", "plugged", "plugins", "suffix_of"]

GROUP = "bladegen.exporters"  # of entry points

Writer = Callable[[Products, Path], None]


@dataclass(frozen=True)
class Format:
    """A file format: what it is, and how a blade's products are written to it.

    Parameters
    ----------
    kind : Kind
        What a file of it holds.
    description : str
        What it is, in a line.
    write : callable
        From a blade's products to a temporary path, which is renamed when it is whole; those of
        definitions and of beams get the final one, since their files name or write companions that
        are named after it, and replace all by themselves.
    suffix : str
        Of a plug-in's row: the suffix of its files, lower case, with its dot.
    """

    kind: Kind
    description: str
    write: Writer
    suffix: str = ""


FORMATS = {
    ".step": Format(
        Kind.solid,
        "STEP AP242 (or AP214), one closed solid with named faces, mm",
        solids.write_step,
    ),
    ".stp": Format(Kind.solid, "the same as .step", solids.write_step),
    ".iges": Format(Kind.solid, "IGES 5.3, one closed solid, mm", solids.write_iges),
    ".igs": Format(Kind.solid, "the same as .iges", solids.write_iges),
    ".brep": Format(Kind.solid, "OCCT's own BREP, one closed solid, mm", solids.write_brep),
    ".curves.step": Format(
        Kind.curves, "STEP, stations, edges and axes as named curves, mm", solids.write_curves
    ),
    ".structure.step": Format(
        Kind.structure,
        "STEP, skin cut where layers end, webs and inner surface, an assembly, mm",
        solids.write_structure,
    ),
    ".stl": Format(Kind.triangles, "STL, binary triangles, m (or mm)", surfaces.write_stl),
    ".regions.stl": Format(
        Kind.triangles,
        "STL, text, a named solid a region for meshers, m (or mm)",
        surfaces.write_regions_stl,
    ),
    ".glb": Format(Kind.triangles, "glTF binary, triangles for the web, m", surfaces.write_glb),
    ".ply": Format(Kind.triangles, "PLY, binary triangles, m (or mm)", surfaces.write_ply),
    ".obj": Format(
        Kind.triangles,
        "Wavefront OBJ, triangles in groups by region, m (or mm)",
        surfaces.write_obj,
    ),
    ".3mf": Format(
        Kind.triangles, "3MF, triangles for printing, a material a region, mm", surfaces.write_3mf
    ),
    ".vtp": Format(
        Kind.triangles, "VTK poly data, triangles for ParaView, m (or mm)", surfaces.write_vtp
    ),
    ".p3d": Format(
        Kind.grid, "PLOT3D multi-block grid, Fortran unformatted, m (or mm)", surfaces.write_p3d
    ),
    ".fmt": Format(Kind.grid, "PLOT3D multi-block grid, text, m (or mm)", surfaces.write_fmt),
    ".cgns": Format(
        Kind.grid, "CGNS structured grid with connectivity and families, m", surfaces.write_cgns
    ),
    ".vtu": Format(
        Kind.grid, "VTK unstructured quadrilaterals of the grid, m (or mm)", surfaces.write_vtu
    ),
    ".volume.p3d": Format(
        Kind.volume,
        "PLOT3D multi-block volume, Fortran unformatted, m (or mm)",
        surfaces.write_volume_p3d,
    ),
    ".volume.fmt": Format(
        Kind.volume, "PLOT3D multi-block volume, text, m (or mm)", surfaces.write_volume_fmt
    ),
    ".volume.cgns": Format(
        Kind.volume,
        "CGNS structured volume with connectivity, families and boundary conditions, m",
        surfaces.write_volume_cgns,
    ),
    ".volume.foam.zip": Format(
        Kind.volume, "OpenFOAM's polyMesh of the volume with patches, m", surfaces.write_volume_foam
    ),
    ".inp": Format(
        Kind.shell,
        "shell model of skin and webs for CalculiX and Abaqus, m, N, kg",
        others.write_inp,
    ),
    ".elastodyn_blade.dat": Format(
        Kind.beam,
        "OpenFAST, ElastoDyn's blade file: mass, stiffness, mode shapes",
        beams.write_elastodyn_blade,
    ),
    ".beamdyn_blade.dat": Format(
        Kind.beam, "OpenFAST, BeamDyn's blade file: 6 x 6 matrices", beams.write_beamdyn_blade
    ),
    ".beamdyn.dat": Format(
        Kind.beam,
        "OpenFAST, BeamDyn's main input: axis and twist; names NAME.beamdyn_blade.dat",
        beams.write_beamdyn,
    ),
    ".beam.csv": Format(
        Kind.beam,
        "beam properties as a table: mass, stiffness, matrices over span",
        beams.write_beam,
    ),
    ".sections.csv": Format(
        Kind.table, "sections as a table: eta, landmark, u, x, y, z, m", others.write_csv
    ),
    ".yaml": Format(
        Kind.definition,
        "windIO 2, a perturbed blade with airfoils of its own",
        others.write_definition,
    ),
    ".dat": Format(
        Kind.definition,
        "OpenFAST, an AeroDyn blade file and airfoil files with polars",
        others.write_definition,
    ),
    ".htc": Format(
        Kind.definition,
        "HAWC2, c2_def, ae and pc file, airfoils by thickness",
        others.write_definition,
    ),
    ".csv": Format(
        Kind.definition, "spanwise table, airfoils in a folder beside it", others.write_definition
    ),
    ".xlsx": Format(
        Kind.definition, "workbook in the layout of the IEA tabular files", others.write_definition
    ),
    ".png": Format(Kind.picture, "picture of the blade", surfaces.write_png),
}


def formats() -> dict[str, Format]:
    """Return all formats by suffix: bladegen's own, then those that only plug-ins have."""
    return FORMATS | {s: row for s, row in plugged().items() if s not in FORMATS}


@cache
def plugged() -> dict[str, Format]:
    """Return the formats that packages of others offer, by suffix."""
    found: dict[str, Format] = {}
    for name, row in plugins().rows:
        write = guarded(row.write, name, ExportError)
        found.setdefault(row.suffix, replace(row, write=write))
    return found


def plugins() -> Offered:
    """Return what packages of others offer as it is, and what is wrong with it."""
    return offered(GROUP, Format, _require_suffix)


def _require_suffix(row: Format) -> None:
    """Raise unless a plug-in's row says by which suffix it is meant."""
    if row.suffix[:1] != "." or row.suffix != row.suffix.lower():
        raise ExportError(f"suffix: got {row.suffix!r}, must be one such as '.toy', lower case")


def format_of(path: Path) -> Format:
    """Return the format that a path's suffix names.

    Raises
    ------
    ExportError
        If no format has that suffix.
    """
    suffix = suffix_of(path)
    return FORMATS[suffix] if suffix in FORMATS else plugged()[suffix]


def suffix_of(path: Path) -> str:
    """Return the suffix by which a path names its format: .sections.csv before .csv.

    Raises
    ------
    ExportError
        If no format has that suffix.
    """
    own = _ending(path, FORMATS)
    if own:
        return own
    found = _ending(path, plugged())
    if found:
        return found
    raise ExportError(
        f"{path}: suffix {path.suffix!r}, allowed are {', '.join(formats())}"
        f"{suggestion(path.suffix, formats())}{plugins().remark}"
    )


def _ending(path: Path, known: Iterable[str]) -> str:
    """Return the longest of some suffixes that a path ends in, "" if there is none."""
    fitting = [suffix for suffix in known if path.name.lower().endswith(suffix)]
    return max(fitting, key=len, default="")
