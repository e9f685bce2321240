"""Files of a blade's shell model, its sections and its definition."""

import logging
from pathlib import Path

from bladegen.blade.layup.shell.inp import inp_lines
from bladegen.exports.definitions import marking
from bladegen.exports.options import Kind
from bladegen.exports.products import Products
from bladegen.formats import writing
from bladegen.surface import mesh
from bladegen.surface.grids import grid_files

__all__ = ["write_csv", "write_definition", "write_inp"]

logger = logging.getLogger(__name__)


def write_inp(products: Products, path: Path) -> None:
    """Write the shell model."""
    lines = inp_lines(products.shell, laminates=products.options.laminates)
    path.write_text("".join(f"{line}\n" for line in lines), encoding="ascii")


def write_csv(products: Products, path: Path) -> None:
    """Write a table of sections."""
    blade = products.blade
    eta = mesh.spans(blade, products.options.stations)
    grid_files.write_sections(eta, blade.u, blade.sections(eta), path)


def write_definition(products: Products, path: Path) -> None:
    """Write a definition, and note what its format cannot hold."""
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
