"""What fairing and edge widths do: solids by tolerance, curvature, bulges and inflections.

    python benchmarks/smoothness.py [FILE ...]

For the bundled blades, or for those named: the solid of either path at 0.05 and 1 mm with airfoils
as faired, and as given beside it (poles, STEP size, largest deviation over all faces, RMS); the
airfoils' roughness; and what bends over span that the definition does not, with widths of their
own, and with those that the path happens to have beside it.
"""

import sys
import tempfile
from dataclasses import replace
from pathlib import Path

from figures import figure

import bladegen as bg
from bladegen import cad, cad_files, combs
from bladegen.blade import PATHS
from bladegen.fairing import TOLERANCE
from bladegen.inflections import inflections
from bladegen.smoothness import edge_bulges

TOLERANCES = (0.05e-3, 1e-3)
UNITS = {"poles": "", "STEP": "MB", "largest deviation": "mm", "RMS deviation": "mm"}


def solid(blade: bg.Blade, tolerance: float) -> list[float]:
    """Make a solid and its STEP file; return the figures of `UNITS`."""
    made = cad.solid(blade, tolerance=tolerance)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "blade.step"
        cad_files.write_step(made, path)
        size = path.stat().st_size
    off = made.deviation
    return [made.net.poles.size / 3, size / 1e6, 1e3 * off.maximum, 1e3 * off.rms]


def main() -> None:
    """Print all figures."""
    names = sys.argv[1:] or bg.bundled()
    for name in names:
        for path in PATHS:
            faired, given = (
                bg.Blade.from_definition(bg.read(name), path=path, fairing=fairing)
                for fairing in (TOLERANCE, None)
            )
            for tolerance in TOLERANCES:
                case = f"{faired.name}, {path}, {1e3 * tolerance:g} mm"
                both = zip(
                    UNITS.items(), solid(faired, tolerance), solid(given, tolerance), strict=True
                )
                for (what, unit), value, before in both:
                    figure(what, case, value, unit, beside="not faired", baseline=before)
            own, passing = faired, replace(faired, edge_width=None)
            for what, found in (("bulges of the edge", edge_bulges), ("inflections", inflections)):
                value, before = (float(len(found(blade))) for blade in (own, passing))
                figure(what, f"{own.name}, {path}", value, "")
                figure(f"{what}, path's widths", f"{own.name}, {path}", before, "")
        for one in combs.figures(bg.Blade.from_definition(bg.read(name))):
            figure(
                "roughness of the airfoil",
                one["airfoil"],
                one["roughness_faired"],
                "1/chord",
                beside="not faired",
                baseline=one["roughness_given"],
            )


if __name__ == "__main__":
    main()
