"""All formats that a blade is exported to: one row each, by suffix.

A new exporter is a function that writes a product to a path, and a row in `FORMATS` that says from
which product: the solid, the mesh, the grid, or the blade itself.  A package of somebody else
offers its rows by the entry point ``bladegen.exporters``; bladegen's own come first.
"""

import logging
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from bladegen.blade.layup.shell.inp import inp_lines
from bladegen.cad import curves, exchange
from bladegen.cad.structure import assembly
from bladegen.errors import ExportError
from bladegen.exports.definitions import marking
from bladegen.exports.options import UNITS, Kind
from bladegen.exports.products import Products
from bladegen.formats import writing
from bladegen.support.arguments import suggestion
from bladegen.support.plugins import Offered, guarded, offered
from bladegen.surface import gltf, mesh_files
from bladegen.surface.grids import grid_files
from bladegen.views import preview

__all__ = ["FORMATS", "Format", "format_of", "formats", "plugged", "plugins", "suffix_of"]

logger = logging.getLogger(__name__)
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
        definitions get the final one, since they write companions named after it and replace all
        by themselves.
    suffix : str
        Of a plug-in's row: the suffix of its files, lower case, with its dot.
    """

    kind: Kind
    description: str
    write: Writer
    suffix: str = ""


def _write_step(products: Products, path: Path) -> None:
    options = products.options
    exchange.write_step(products.solid, path, schema=options.step_schema, **options.told)


def _write_iges(products: Products, path: Path) -> None:
    exchange.write_iges(products.solid, path, **products.options.told)


def _write_brep(products: Products, path: Path) -> None:
    exchange.write_brep(products.solid, path)


def _write_curves(products: Products, path: Path) -> None:
    options = products.options
    told = {"schema": options.step_schema, **options.told}
    curves.write_curves(products.solid, products.blade, path, **told)


def _write_structure(products: Products, path: Path) -> None:
    options = products.options
    told = {"schema": options.step_schema, **options.told}
    assembly.write_structure(products.inside, products.blade.name, path, **told)


def _write_stl(products: Products, path: Path) -> None:
    scaled = mesh_files.to_trimesh(products.mesh, scale=UNITS[products.options.unit])
    path.write_bytes(scaled.export(file_type="stl"))


def _write_regions_stl(products: Products, path: Path) -> None:
    text = mesh_files.stl_text(products.mesh, scale=UNITS[products.options.unit])
    path.write_text(text, encoding="ascii")


def _write_obj(products: Products, path: Path) -> None:
    unit = products.options.unit
    header = f"bladegen {' '.join(products.blade.name.split())}, unit: {unit}"
    text = mesh_files.obj_text(products.mesh, header, scale=UNITS[unit])
    path.write_text(text, encoding="utf-8")


def _write_ply(products: Products, path: Path) -> None:
    scaled = mesh_files.to_trimesh(products.mesh, scale=UNITS[products.options.unit])
    path.write_bytes(scaled.export(file_type="ply", vertex_normal=False))


def _write_glb(products: Products, path: Path) -> None:
    name = products.blade.name
    path.write_bytes(gltf.glb(name, [gltf.Standing(name, products.mesh, np.eye(3), np.zeros(3))]))


def _write_3mf(products: Products, path: Path) -> None:
    scaled = mesh_files.to_trimesh(products.mesh, scale=UNITS["mm"])
    package = mesh_files.with_steady_ids(scaled.export(file_type="3mf"))
    path.write_bytes(mesh_files.with_materials(package, products.mesh, products.blade.name))


def _write_vtp(products: Products, path: Path) -> None:
    preview.write_vtp(products.mesh, path, scale=UNITS[products.options.unit])


def _write_p3d(products: Products, path: Path) -> None:
    grid_files.write_plot3d(products.grid, path, scale=UNITS[products.options.unit])


def _write_fmt(products: Products, path: Path) -> None:
    grid_files.write_plot3d_text(products.grid, path, scale=UNITS[products.options.unit])


def _write_cgns(products: Products, path: Path) -> None:
    made = products.made_from(Kind.grid, ".cgns")
    grid_files.write_cgns(products.grid, path, note=made.text)


def _write_vtu(products: Products, path: Path) -> None:
    grid_files.write_vtu(products.grid, path, scale=UNITS[products.options.unit])


def _write_inp(products: Products, path: Path) -> None:
    lines = inp_lines(products.shell, laminates=products.options.laminates)
    path.write_text("".join(f"{line}\n" for line in lines), encoding="ascii")


def _write_csv(products: Products, path: Path) -> None:
    blade = products.blade
    eta = blade.stations(products.options.stations)
    grid_files.write_sections(eta, blade.u, blade.sections(eta), path)


def _write_png(products: Products, path: Path) -> None:
    products.progress("rendering")
    preview.picture(products.blade, path)


def _write_definition(products: Products, path: Path) -> None:
    options = products.options
    said = writing.write(
        products.blade,
        path,
        polars=options.polars,
        reynolds=options.reynolds,
        progress=products.progress,
        mark=marking(products.made_from(Kind.definition, path.suffix.lower())),
    )
    products.remarks.extend(said)
    for remark in said:
        logger.info("%s: %s", path.name, remark)


FORMATS = {
    ".step": Format(
        Kind.solid, "STEP AP242 (or AP214), one closed solid with named faces, mm", _write_step
    ),
    ".stp": Format(Kind.solid, "the same as .step", _write_step),
    ".iges": Format(Kind.solid, "IGES 5.3, one closed solid, mm", _write_iges),
    ".igs": Format(Kind.solid, "the same as .iges", _write_iges),
    ".brep": Format(Kind.solid, "OCCT's own BREP, one closed solid, mm", _write_brep),
    ".curves.step": Format(
        Kind.curves, "STEP, stations, edges and axes as named curves, mm", _write_curves
    ),
    ".structure.step": Format(
        Kind.structure,
        "STEP, skin cut where layers end and webs, an assembly, mm",
        _write_structure,
    ),
    ".stl": Format(Kind.triangles, "STL, binary triangles, m (or mm)", _write_stl),
    ".regions.stl": Format(
        Kind.triangles,
        "STL, text, a named solid a region for meshers, m (or mm)",
        _write_regions_stl,
    ),
    ".glb": Format(Kind.triangles, "glTF binary, triangles for the web, m", _write_glb),
    ".ply": Format(Kind.triangles, "PLY, binary triangles, m (or mm)", _write_ply),
    ".obj": Format(
        Kind.triangles, "Wavefront OBJ, triangles in groups by region, m (or mm)", _write_obj
    ),
    ".3mf": Format(
        Kind.triangles, "3MF, triangles for printing, a material a region, mm", _write_3mf
    ),
    ".vtp": Format(Kind.triangles, "VTK poly data, triangles for ParaView, m (or mm)", _write_vtp),
    ".p3d": Format(
        Kind.grid, "PLOT3D multi-block grid, Fortran unformatted, m (or mm)", _write_p3d
    ),
    ".fmt": Format(Kind.grid, "PLOT3D multi-block grid, text, m (or mm)", _write_fmt),
    ".cgns": Format(
        Kind.grid, "CGNS structured grid with connectivity and families, m", _write_cgns
    ),
    ".vtu": Format(Kind.grid, "VTK unstructured quadrilaterals of the grid, m (or mm)", _write_vtu),
    ".inp": Format(
        Kind.shell, "shell model of skin and webs for CalculiX and Abaqus, m, N, kg", _write_inp
    ),
    ".sections.csv": Format(
        Kind.table, "sections as a table: eta, landmark, u, x, y, z, m", _write_csv
    ),
    ".yaml": Format(
        Kind.definition, "windIO 2, a perturbed blade with airfoils of its own", _write_definition
    ),
    ".dat": Format(
        Kind.definition,
        "OpenFAST, an AeroDyn blade file and airfoil files with polars",
        _write_definition,
    ),
    ".htc": Format(
        Kind.definition, "HAWC2, c2_def, ae and pc file, airfoils by thickness", _write_definition
    ),
    ".csv": Format(
        Kind.definition, "spanwise table, airfoils in a folder beside it", _write_definition
    ),
    ".xlsx": Format(
        Kind.definition, "workbook in the layout of the IEA tabular files", _write_definition
    ),
    ".png": Format(Kind.picture, "picture of the blade", _write_png),
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
