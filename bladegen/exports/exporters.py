"""A blade to a file, by suffix: one row a format in `FORMATS`.

A new exporter needs a function that writes a product to a path, and a row that says from
which product: the solid, the mesh, the grid, or the blade itself.  Files appear whole or not
at all.
"""

import logging
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from bladegen.blade.blade import Blade
from bladegen.cad import exchange, solids
from bladegen.errors import ExportError, Finding, SizeError, ToleranceError
from bladegen.exports import marks
from bladegen.exports.options import UNITS, Kind, Options
from bladegen.exports.provenance import Provenance, made_from
from bladegen.formats import writing
from bladegen.support.arguments import instance, path_of, suggestion
from bladegen.support.files import replacing
from bladegen.surface import grid, grid_files, mesh
from bladegen.views import preview

__all__ = [
    "FORMATS",
    "UNITS",
    "Format",
    "Kind",
    "Options",
    "Products",
    "aside",
    "export",
    "format_of",
    "require_size",
    "suffix_of",
    "write",
]

logger = logging.getLogger(__name__)


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


Writer = Callable[[Products, Path], None]


@dataclass(frozen=True)
class Format:
    """A file format: what it is, and how a blade's products are written to it.

    Writers get a temporary path; those of definitions the final one, since they write companions
    named after it and replace all by themselves.
    """

    kind: Kind
    description: str
    write: Writer


def _write_step(products: Products, path: Path) -> None:
    options = products.options
    exchange.write_step(
        products.solid, path, schema=options.step_schema, timestamp=options.timestamp
    )


def _write_iges(products: Products, path: Path) -> None:
    exchange.write_iges(products.solid, path, timestamp=products.options.timestamp)


def _write_brep(products: Products, path: Path) -> None:
    exchange.write_brep(products.solid, path)


def _write_stl(products: Products, path: Path) -> None:
    scaled = mesh.to_trimesh(products.mesh, scale=UNITS[products.options.unit])
    path.write_bytes(scaled.export(file_type="stl"))


def _write_obj(products: Products, path: Path) -> None:
    unit = products.options.unit
    scaled = mesh.to_trimesh(products.mesh, scale=UNITS[unit])
    header = f"bladegen {' '.join(products.blade.name.split())}, unit: {unit}"
    path.write_text(
        scaled.export(file_type="obj", include_normals=False, header=header), encoding="utf-8"
    )


def _write_ply(products: Products, path: Path) -> None:
    scaled = mesh.to_trimesh(products.mesh, scale=UNITS[products.options.unit])
    path.write_bytes(scaled.export(file_type="ply", vertex_normal=False))


def _write_glb(products: Products, path: Path) -> None:
    path.write_bytes(mesh.to_trimesh(products.mesh).export(file_type="glb"))


def _write_3mf(products: Products, path: Path) -> None:
    scaled = mesh.to_trimesh(products.mesh, scale=UNITS["mm"])
    path.write_bytes(mesh.with_steady_ids(scaled.export(file_type="3mf")))


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
    ".stl": Format(Kind.triangles, "STL, binary triangles, m (or mm)", _write_stl),
    ".glb": Format(Kind.triangles, "glTF binary, triangles for the web, m", _write_glb),
    ".ply": Format(Kind.triangles, "PLY, binary triangles, m (or mm)", _write_ply),
    ".obj": Format(Kind.triangles, "Wavefront OBJ, triangles, m (or mm)", _write_obj),
    ".3mf": Format(Kind.triangles, "3MF, triangles for printing, mm", _write_3mf),
    ".vtp": Format(Kind.triangles, "VTK poly data, triangles for ParaView, m (or mm)", _write_vtp),
    ".p3d": Format(
        Kind.grid, "PLOT3D multi-block grid, Fortran unformatted, m (or mm)", _write_p3d
    ),
    ".fmt": Format(Kind.grid, "PLOT3D multi-block grid, text, m (or mm)", _write_fmt),
    ".cgns": Format(
        Kind.grid, "CGNS structured grid with connectivity and families, m", _write_cgns
    ),
    ".vtu": Format(Kind.grid, "VTK unstructured quadrilaterals of the grid, m (or mm)", _write_vtu),
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


def format_of(path: Path) -> Format:
    """Return the format that a path's suffix names.

    Raises
    ------
    ExportError
        If no format has that suffix.
    """
    return FORMATS[suffix_of(path)]


def suffix_of(path: Path) -> str:
    """Return the suffix by which a path names its format: .sections.csv before .csv.

    Raises
    ------
    ExportError
        If no format has that suffix.
    """
    for suffix in sorted(FORMATS, key=len, reverse=True):
        if path.name.lower().endswith(suffix):
            return suffix
    raise ExportError(
        f"{path}: suffix {path.suffix!r}, allowed are {', '.join(FORMATS)}"
        f"{suggestion(path.suffix, FORMATS)}"
    )


def export(blade: Blade, path: str | Path, **options: Any) -> Path:
    """Write a blade to a file in the format of its suffix.

    Parameters
    ----------
    blade : Blade
        What to write.
    path : str or Path
        Where to; an existing file is replaced once the new one is whole.
    **options
        Fields of `Options`.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ExportError
        If the suffix or an option is unknown, an argument is of another kind, or the file
        cannot be written.
    CadError
        If the solid is not valid; `ToleranceError` if it misses its tolerance, with the file
        kept beside the target as ``<name>.out-of-tolerance.step``; `SizeError` if it is larger
        than `Options.largest`, kept as ``<name>.too-large.step``.
    """
    must = "a Blade; bladegen.Blade.from_definition(bladegen.read('iea15mw')) makes one"
    instance(blade, Blade, "blade", must, ExportError)
    path = path_of(path, "path", ExportError)
    write(Products(blade, Options.named(options)), path)
    return path


def aside(path: Path) -> Path:
    """Return where a solid is kept that misses its tolerance."""
    return path.with_suffix(f".out-of-tolerance{path.suffix}")


def write(products: Products, path: Path) -> None:
    """Write one file from products that may serve several."""
    row = format_of(path)
    target, miss = path, None
    if row.kind is Kind.solid:
        solid, tolerance = products.solid, products.options.tolerance
        if products.options.sections is None and solid.deviation.maximum > tolerance:
            target = aside(path)
            miss = ToleranceError(
                f"{path}: the solid is {solid.deviation.maximum * 1e3:.3f} mm off the blade at "
                f"eta = {solid.deviation.eta:.4f}, allowed is {tolerance * 1e3:g} mm; kept as "
                f"{target.name}; more landmarks than {len(products.blade.u)} may help",
                target,
            )
    suffix = suffix_of(path)
    if row.kind is Kind.definition:
        row.write(products, target)
        with replacing(target) as temporary:
            temporary.write_bytes(target.read_bytes())
            products.mark(temporary, row.kind, suffix)
    else:
        with replacing(target) as temporary:
            row.write(products, temporary)
            products.mark(temporary, row.kind, suffix)
    if miss is not None:
        raise miss
    if row.kind is Kind.solid:
        require_size(products, target)


def require_size(products: Products, path: Path) -> None:
    """See that a solid's file is no larger than asked for; keep it under another name if it is.

    Raises
    ------
    SizeError
        If it is larger.
    """
    size, largest = path.stat().st_size, products.options.largest
    if largest is None or size <= largest:
        return
    kept = path.replace(path.with_suffix(f".too-large{path.suffix}"))
    raise SizeError(
        f"{path}: takes {size / 1e6:.2f} MB at {products.options.tolerance * 1e3:g} mm, allowed "
        f"are {largest / 1e6:g} MB (--light); kept as {kept.name}; --tolerance with a larger "
        "length, or --fairing 1e-4 where airfoils are noisy, makes it smaller",
        kept,
    )
