"""How much of a blade each file format keeps: out, in again, and the surfaces compared.

    python benchmarks/formats.py

Largest distance between the sections of both blades at 121 spans, each to the other's polygon of
401 landmarks; the swept blade is the NREL 5 MW with 4 m of sweep at its tip.
"""

import tempfile
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from figures import asked, figure, seconds

import bladegen as bg
from bladegen.definition.blade_definition import BladeDefinition, Distribution
from bladegen.support.arrays import Array

FILES = ("blade.csv", "blade.xlsx", "blade.htc", "blade.dat", "blade.yaml")
RUNS = 5
SPANS = np.linspace(0.0, 1.0, 121)


def swept() -> BladeDefinition:
    """The NREL 5 MW, swept back."""
    plain = bg.read("nrel5mw")
    sweep = Distribution(np.linspace(0.0, 1.0, 5), np.array([0.0, 0.1, 0.5, 2.0, 4.0]))
    return replace(plain, name="nrel5mw, swept", axis=replace(plain.axis, y=sweep))


def farthest(points: Array, polygon: Array) -> float:
    """The largest distance from points (n, 3) to a polygon (m, 3)."""
    side = np.diff(polygon, axis=0)
    length = np.maximum(np.einsum("mk,mk->m", side, side), 1e-30)
    to = points[:, None] - polygon[:-1]
    along = np.clip(np.einsum("nmk,mk->nm", to, side) / length, 0.0, 1.0)
    return float(np.sqrt(((to - along[..., None] * side) ** 2).sum(axis=-1).min(axis=1)).max())


def off(one: BladeDefinition, other: BladeDefinition) -> float:
    """How far two blades lie apart at equal z [mm]."""
    fine = np.linspace(0.0, 1.0, 20_001)
    at = np.interp(one.axis.z(SPANS), other.axis.z(fine), fine)
    first = bg.Blade.from_definition(one).sections(SPANS)
    second = bg.Blade.from_definition(other).sections(at)
    pairs = [*zip(first, second, strict=True), *zip(second, first, strict=True)]
    return 1e3 * max(farthest(mine[::4], yours) for mine, yours in pairs)


def main() -> None:
    """Print what each format keeps of each blade."""
    quick = asked(__doc__).quick
    blades = [*map(bg.read, bg.bundled()), swept()][: 1 if quick else None]
    for file in FILES:
        for first in blades:
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / file
                written = seconds({"": partial(bg.write, first, path)}, 2 if quick else RUNS)
                read = seconds({"": partial(bg.read, path)}, 2 if quick else RUNS)
                second = bg.read(path)
                case = f"{file}, {first.name}"
                figure("out and in again, off by", case, "mm", off(first, second))
                figure("rows of chord", case, "", len(second.chord.grid))
                figure("written", case, "s", written)
                figure("read", case, "s", read)


if __name__ == "__main__":
    main()
