"""Files of a blade's beam properties: of ElastoDyn and BeamDyn, and a table."""

from pathlib import Path
from typing import Any

from bladegen.blade.layup.beam import table
from bladegen.blade.layup.layup import Layup
from bladegen.errors import Finding
from bladegen.exports import marks
from bladegen.exports.options import Kind
from bladegen.exports.products import Products
from bladegen.formats.openfast import beams

__all__ = ["figures", "write_beam", "write_beamdyn", "write_beamdyn_blade", "write_elastodyn_blade"]

MAIN, BLADE = ".beamdyn.dat", ".beamdyn_blade.dat"


def write_elastodyn_blade(products: Products, path: Path) -> None:
    """Write ElastoDyn's blade file."""
    lines = beams.elastodyn_blade(products.beam, products.options.openfast)
    _write(products, path, lines, ".elastodyn_blade.dat")
    _note_damping(products)


def write_beamdyn_blade(products: Products, path: Path) -> None:
    """Write BeamDyn's blade file."""
    lines = beams.beamdyn_blade(products.beam, products.options.openfast)
    _write(products, path, lines, BLADE)
    _note_damping(products)


def write_beamdyn(products: Products, path: Path) -> None:
    """Write BeamDyn's main input, which names the blade file that stands beside it."""
    blade = f"{path.name[: -len(MAIN)]}{BLADE}"
    lines = beams.beamdyn_main(products.beam, blade, products.options.openfast)
    _write(products, path, lines, MAIN)


def write_beam(products: Products, path: Path) -> None:
    """Write a table of beam properties."""
    _write(products, path, table.table_lines(products.beam), ".beam.csv")


def figures(products: Products) -> dict[str, Any]:
    """Return what a report says of the beam."""
    beam = products.beam
    layup: Layup = products.blade.layup
    flap, edge, torsion = beams.frequencies(beam)
    return {
        "stations": len(beam.eta),
        "mass_kg": beam.whole_mass,
        "mass_of_layers_kg": layup.mass,
        "flap_hz": flap,
        "edge_hz": edge,
        "torsion_hz": torsion,
    }


def _write(products: Products, path: Path, lines: list[str], suffix: str) -> None:
    with marks.marked(path, products.made_from(Kind.beam, suffix)) as temporary:
        temporary.write_text("".join(f"{line}\n" for line in lines), encoding="ascii")


def _note_damping(products: Products) -> None:
    said = Finding(
        "beam",
        f"damping is no result: {beams.DAMPING:g} % of critical, as of NREL 5 MW; yours goes in",
    )
    if said not in products.remarks:
        products.remarks.append(said)
