"""CAD files of a blade's solid, its curves and its structure."""

from pathlib import Path

from bladegen.cad import curves, exchange
from bladegen.cad.structure import assembly
from bladegen.exports.products import Products

__all__ = ["write_brep", "write_curves", "write_iges", "write_step", "write_structure"]


def write_step(products: Products, path: Path) -> None:
    """Write the solid as STEP."""
    options = products.options
    exchange.write_step(products.solid, path, schema=options.step_schema, **options.told)


def write_iges(products: Products, path: Path) -> None:
    """Write the solid as IGES."""
    exchange.write_iges(products.solid, path, **products.options.told)


def write_brep(products: Products, path: Path) -> None:
    """Write the solid as OCCT's BREP."""
    exchange.write_brep(products.solid, path)


def write_curves(products: Products, path: Path) -> None:
    """Write stations, edges and axes as STEP curves."""
    options = products.options
    told = {"schema": options.step_schema, **options.told}
    curves.write_curves(products.solid, products.blade, path, **told)


def write_structure(products: Products, path: Path) -> None:
    """Write skin, webs and inner surface as a STEP assembly."""
    options = products.options
    told = {"schema": options.step_schema, **options.told}
    assembly.write_structure(products.inside, products.blade.name, path, **told)
