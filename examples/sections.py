"""Sections of a blade between its stations, as points in space: sections.py [FILE.csv]."""

import sys
from pathlib import Path

import numpy as np

import bladegen as bg


def main(target: Path) -> None:
    """Write 20 sections of the IEA 15 MW blade as rows of eta, x, y, z."""
    blade = bg.Blade.from_definition(bg.read("iea15mw"))
    eta = blade.stations(20)
    points = blade.sections(eta)
    rows = np.concatenate(
        [np.broadcast_to(eta[:, None, None], (*points.shape[:2], 1)), points], axis=-1
    )
    np.savetxt(target, rows.reshape(-1, 4), delimiter=",", header="eta,x_m,y_m,z_m", comments="")
    print(f"wrote {target}: {len(eta)} sections of {points.shape[1]} landmarks")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "sections.csv"))
