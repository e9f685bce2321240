"""A blade to a file, in the format of its suffix: those of the table in `registry`.

Files appear whole or not at all; a solid that misses what was asked for is kept under another
name.
"""

from pathlib import Path
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.spans import both_sides
from bladegen.errors import ExportError, MissingLibraryError, SizeError, ToleranceError
from bladegen.exports.options import Kind, Options
from bladegen.exports.products import Products
from bladegen.exports.registry import format_of, suffix_of
from bladegen.support.arguments import instance, path_of
from bladegen.support.arrays import Array
from bladegen.support.files import replacing
from bladegen.support.threads import one_thread
from bladegen.surface.deviation import Deviation
from bladegen.surface.grids import grid
from bladegen.surface.tips import Tip, flat_tip
from bladegen.surface.volumes.volume import Extrusion

__all__ = ["aside", "export", "require_size", "write"]


def export(
    blade: Blade,
    path: str | Path,
    *,
    tolerance: float = Options.tolerance,
    sections: int | None = None,
    split: bool = Options.split,
    stations: int = Options.stations,
    tip: "Tip | None" = None,
    unit: str = Options.unit,
    step_schema: str = Options.step_schema,
    timestamp: str | None = None,
    author: str = Options.author,
    organisation: str = Options.organisation,
    largest: int | None = None,
    spans: "Array | None" = None,
    spacing: grid.Spacing | None = None,
    extrusion: Extrusion | None = None,
    element: float = Options.element,
    laminates: bool = Options.laminates,
    openfast: int = Options.openfast,
    polars: str | None = None,
    reynolds: float | None = None,
    command: str = "",
    **others: Any,
) -> Path:
    """Write a blade to a file in the format of its suffix.

    Parameters
    ----------
    blade : Blade
        What to write.
    path : str or Path
        Where to; an existing file is replaced once the new one is whole.
    tolerance : float
        Solids: largest distance to the blade's sections [m], 1e-6 to 0.05.
    sections : int, optional
        Solids: exactly so many sections instead of as many as the tolerance needs.
    split : bool
        Solids: cut the sides in pieces, so that CAD systems find the volume to 1e-5 and make
        sections in a tenth of the time; else each side is one face.
    stations : int
        Meshes and tables of sections: how many sections.
    tip : callable, optional
        Solids, meshes and grids: `bladegen.surface.tips.flat_tip`, the default, or `round_tip`.
    unit : str
        STL, PLY, OBJ, VTP, PLOT3D and VTU: "m" or "mm".  STEP, IGES, BREP and 3MF are always in
        millimetres, GLB and CGNS in metres.
    step_schema : str
        STEP: "ap242" or "ap214".
    timestamp : str, optional
        STEP and IGES: the time in the header, ISO 8601, instead of now.
    author : str
        STEP and IGES: who the file says made it; nobody if not given.
    organisation : str
        The author's, in the same files.
    largest : int, optional
        Solids: the most bytes that a file may take.
    spans : (k,) array, optional
        Solids: span fractions of sections to begin with, such as those of a blade that is alike.
    spacing : bladegen.surface.grids.grid.Spacing, optional
        Grids and volumes: how many points, and cell sizes as fractions of a side and of the axis.
    extrusion : bladegen.surface.volumes.volume.Extrusion, optional
        Volumes: first height, growth, distance and smoothing.
    element : float
        Shell models: size of the elements [m], 0.02 to 20.
    laminates : bool
        Shell models: composite sections, layer by layer, which Abaqus takes and CalculiX does not.
    openfast : int
        Beam properties for OpenFAST: 5, or 4 for it and what was before.
    polars : str, optional
        Definitions: where polars are from, as for `bladegen.write`.
    reynolds : float, optional
        Definitions: the Reynolds number of estimated polars.
    command : str
        What was typed, for the file to say.
    **others
        None: another name is an `ExportError` that tells which is meant.

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
        than `largest`, kept as ``<name>.too-large.step``.
    """
    must = "a Blade; bladegen.Blade.from_definition(bladegen.read('iea15mw')) makes one"
    instance(blade, Blade, "blade", must, ExportError)
    path = path_of(path, "path", ExportError)
    given: dict[str, Any] = {
        "tolerance": tolerance,
        "sections": sections,
        "split": split,
        "stations": stations,
        "tip": flat_tip if tip is None else tip,
        "unit": unit,
        "step_schema": step_schema,
        "timestamp": timestamp,
        "author": author,
        "organisation": organisation,
        "largest": largest,
        "spans": spans,
        "spacing": grid.Spacing() if spacing is None else spacing,
        "extrusion": Extrusion() if extrusion is None else extrusion,
        "element": element,
        "laminates": laminates,
        "openfast": openfast,
        "polars": polars,
        "reynolds": reynolds,
        "command": command,
    }
    write(Products(blade, Options.named(given | others)), path)
    return path


def aside(path: Path) -> Path:
    """Return where a solid is kept that misses its tolerance."""
    return path.with_suffix(f".out-of-tolerance{path.suffix}")


def write(products: Products, path: Path) -> None:
    """Write one file from products that may serve several."""
    with one_thread():
        _write(products, path)


def _write(products: Products, path: Path) -> None:
    row = format_of(path)
    target, miss = path, None
    if row.kind is Kind.solid:
        solid, tolerance = products.solid, products.options.tolerance
        if products.options.sections is None and solid.deviation.maximum > tolerance:
            target = aside(path)
            miss = ToleranceError(
                f"{path}: the solid is {solid.deviation.maximum * 1e3:.3f} mm off the blade at "
                f"{_place(products.blade, solid.deviation)}, allowed is {tolerance * 1e3:g} mm; "
                f"kept as {target.name}; a larger tolerance or, where airfoils are noisy, more "
                "fairing may help",
                target,
            )
    suffix = suffix_of(path)
    try:
        if row.kind in (Kind.definition, Kind.beam):
            row.write(products, target)
        else:
            with replacing(target) as temporary:
                row.write(products, temporary)
                products.mark(temporary, row.kind, suffix)
    except ModuleNotFoundError as error:
        raise MissingLibraryError(error) from None
    if miss is not None:
        raise miss
    if row.kind is Kind.solid:
        require_size(products, target)


def _place(blade: Blade, deviation: Deviation) -> str:
    """Say where on a blade a deviation is largest."""
    u, at = both_sides(np.array([deviation.u]))
    x = float(blade.profiles(np.array([deviation.eta]), u)[0, at[0], 0])
    return f"eta = {deviation.eta:.4f}, {100.0 * x:.1f} % of the chord, on the {deviation.face}"


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
