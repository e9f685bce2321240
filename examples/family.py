"""A family of perturbed blades, written, read again, and what its volumes follow.

    python examples/family.py [FOLDER]

Makes 24 variants of the DTU 10 MW blade, reads manifest and sections as a learner would, and fits
the volume by a linear model of the factors.
"""

import sys
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import zarr

import bladegen as bg
from bladegen.families.order import Order
from bladegen.families.run import run


def main(target: Path) -> None:
    """Make a family and look into it."""
    blade = bg.Blade.from_definition(bg.read("dtu10mw"))
    bounds = {"thickness": (0.95, 1.05), "chord": (0.95, 1.05)}
    family = bg.family(
        blade, bg.ShapeSpace.bundled(), count=24, seed=7, bounds=bounds, reach=0.5, spans=40
    )
    run(Order(family, target), resume=True)

    manifest = pq.read_table(target / "manifest.parquet")
    sections = zarr.open_group(target / "sections.zarr", mode="r")["sections"]
    names = family.design.what.names
    factors = np.column_stack([manifest[name].to_numpy() for name in names])
    volume = manifest["volume_m3"].to_numpy()
    model = np.column_stack([np.ones(len(volume)), factors - factors.mean(axis=0)])
    slope, *_ = np.linalg.lstsq(model, volume, rcond=None)
    left = np.std(volume - model @ slope) / np.std(volume)
    print(
        f"wrote {target}: sections {sections.shape}, volume {volume.min():.1f} to "
        f"{volume.max():.1f} m3; a linear model leaves {100 * left:.1f} % of its spread"
    )


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "family"))
