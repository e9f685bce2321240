"""Tolerances: how far solids are from their blade, and what they cost, as less and less is asked.

    python benchmarks/tolerances.py [FILE ...]

For the bundled blades, or for those named, on the geodesic path and at tolerances from 1 to
0.02 mm: the largest deviation over all faces, whether it is within the tolerance, the size of
the STEP file, creases that the surface keeps, and the time from a blade that holds nothing
computed yet to the file.  Beside the deviation that the solid states stands one that is measured
at 300 spans and 600 places along the chord that nobody saw before.
"""

import tempfile
import time
from pathlib import Path

import numpy as np
from figures import figure, parser

import bladegen as bg
from bladegen.cad import exchange, solids
from bladegen.surface.net import SurfaceNet

TOLERANCES = (1.0, 0.5, 0.3, 0.1, 0.05, 0.02)  # mm


def unseen(net: SurfaceNet, blade: bg.Blade) -> float:
    """Return the largest distance of points of a blade to its net [mm]."""
    rng = np.random.default_rng(17)
    half = np.sort(rng.uniform(0.0, 0.5, 300))
    u, v = np.concatenate([half, 1.0 - half[::-1]]), np.sort(rng.uniform(0.0, 1.0, 300))
    return 1e3 * float(np.abs(net.offsets(blade.sections(v, u), u, v)).max())


def main() -> None:
    """Print each blade's figures."""
    options = parser(__doc__)
    options.add_argument("files", nargs="*", help="blades; the bundled ones if none is named")
    asked = options.parse_args()
    names = asked.files or bg.bundled()[: 1 if asked.quick else None]
    for name in names:
        definition = bg.read(name)
        stated: list[float] = []
        for tolerance in TOLERANCES[: 2 if asked.quick else None]:
            blade = bg.Blade.from_definition(definition, path="geodesic")
            with tempfile.TemporaryDirectory() as folder:
                start, path = time.perf_counter(), Path(folder) / "blade.step"
                solid = solids.solid(blade, tolerance=1e-3 * tolerance)
                exchange.write_step(solid, path)
                spent, size = time.perf_counter() - start, path.stat().st_size
            off = solid.deviation
            stated.append(1e3 * off.maximum)
            case = f"{definition.name}, {tolerance:g} mm"
            both = {"stated": stated[-1], "unseen": unseen(solid.net, blade)}
            figure("off the blade by up to", case, "mm", both)
            figure("within the tolerance", case, "", float(stated[-1] <= tolerance))
            figure("largest at eta", case, "", off.eta)
            figure("STEP", case, "MB", size / 1e6)
            figure("creases", case, "", len(solid.net.creases))
            figure("made and written", case, "s", spent)
        fall = float(np.all(np.diff(stated) <= 0.0))
        figure("deviation falls with the tolerance", definition.name, "", fall)


if __name__ == "__main__":
    main()
