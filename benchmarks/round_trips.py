"""How well a perturbed blade comes back from a windIO file: distances, stations, times.

Run: python benchmarks/round_trips.py.  Each variant is written to windIO 2, read again and built;
the distance is that of the landmarks of its sections to the polylines of the variant's, in space,
at spans that were not used to place the stations.
"""

import tempfile
import time
from pathlib import Path

import numpy as np
from figures import asked, figure

import bladegen as bg
from bladegen.support.arrays import Array

SPANS = np.linspace(0.0, 1.0, 173)
FINER = 4  # points of a polyline per landmark
CHANGES = (
    ("t = (0.06, -0.05, 0.03, 0.02)", {"t": (0.06, -0.05, 0.03, 0.02)}),
    ("t = (-0.02, 0.03, -0.01, 0.015)", {"t": (-0.02, 0.03, -0.01, 0.015)}),
    ("thickness 0.95, twist 2 deg", {"thickness": 0.95, "twist": np.radians(2.0)}),
    (
        "t = (0.02, 0.02, 0, 0), camber 1.03, chord 1.05, prebend 1.2",
        {"t": (0.02, 0.02, 0.0, 0.0), "camber": 1.03, "chord": 1.05, "prebend_scale": 1.2},
    ),
)


def apart(wanted: Array, got: Array) -> Array:
    """Return the distances of points (n, 3) from the polyline through `wanted` (m, 3)."""
    along = np.diff(wanted, axis=0)
    to = got[:, None] - wanted[:-1]
    at = np.sum(to * along, axis=-1) / np.maximum(np.sum(along**2, axis=-1), 1e-30)
    return np.min(np.linalg.norm(to - np.clip(at, 0, 1)[..., None] * along, axis=-1), axis=-1)


def main() -> None:
    """Print how far each variant comes back from itself."""
    quick = asked(__doc__).quick
    space = bg.ShapeSpace.bundled()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "variant.yaml"
        for name in bg.bundled()[: 1 if quick else None]:
            blade = bg.Blade.from_definition(bg.read(name))
            u = np.interp(
                np.linspace(0, 1, FINER * (len(blade.u) - 1) + 1),
                np.linspace(0, 1, len(blade.u)),
                blade.u,
            )
            for said, wanted in CHANGES[-2 if quick else 0 :]:
                change = dict(wanted)
                shape = (space, change.pop("t")) if "t" in change else ()
                variant = blade.perturbed(*shape, allow_odd=True, **change)
                start = time.perf_counter()
                bg.write(variant, path, polars="keep")
                spent = time.perf_counter() - start
                again = bg.Blade.from_definition(bg.read(path))
                pairs = zip(variant.sections(SPANS, u), again.sections(SPANS), strict=True)
                off = 1e3 * np.array([apart(one, other) for one, other in pairs])
                case = f"{name}, {said}"
                figure("windIO round trip, largest distance", case, "mm", off.max())
                figure("windIO round trip, RMS", case, "mm", np.sqrt(np.mean(off**2)))
                figure("windIO stations", case, "", len(again.eta))
                figure("windIO file", case, "kB", path.stat().st_size / 1e3)
                figure("windIO, fitted and written", case, "s", spent)


if __name__ == "__main__":
    main()
