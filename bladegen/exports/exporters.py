"""A blade to a file, in the format of its suffix: those of the table in `registry`.

Files appear whole or not at all; a solid that misses what was asked for is kept under another
name.
"""

from pathlib import Path
from typing import Any

from bladegen.blade.blade import Blade
from bladegen.errors import ExportError, MissingLibraryError, SizeError, ToleranceError
from bladegen.exports.options import Kind, Options
from bladegen.exports.products import Products
from bladegen.exports.registry import format_of, suffix_of
from bladegen.support.arguments import instance, path_of
from bladegen.support.files import replacing

__all__ = ["aside", "export", "require_size", "write"]


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
    try:
        if row.kind is Kind.definition:
            row.write(products, target)
            with replacing(target) as temporary:
                temporary.write_bytes(target.read_bytes())
                products.mark(temporary, row.kind, suffix)
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
