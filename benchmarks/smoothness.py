"""What fairing and edge widths do: solids by tolerance, curvature, bulges and inflections.

    python benchmarks/smoothness.py [FILE ...]

For the bundled blades, or for those named: the solid of either path at 0.05 and 1 mm with airfoils
as faired, and as given beside it (poles, STEP size, largest deviation over all faces, RMS); the
airfoils' roughness; and what bends over span that the definition does not, with widths of their
own, and with those that the path happens to have beside it; and how fair the surface is, with the
planform as given and made fair.
"""

import tempfile
from dataclasses import replace
from pathlib import Path

from figures import figure, parser

import bladegen as bg
from bladegen.blade.lofting.paths import PATHS
from bladegen.cad import exchange, solids
from bladegen.measures.fairness import fairness
from bladegen.measures.inflections import inflections
from bladegen.measures.smoothness import edge_bulges
from bladegen.views.plots import combs

TOLERANCES = (0.05e-3, 1e-3)
UNITS = {"poles": "", "STEP": "MB", "largest deviation": "mm", "RMS deviation": "mm"}


def solid(blade: bg.Blade, tolerance: float) -> list[float]:
    """Make a solid and its STEP file; return the figures of `UNITS`."""
    made = solids.solid(blade, tolerance=tolerance)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "blade.step"
        exchange.write_step(made, path)
        size = path.stat().st_size
    off = made.deviation
    return [made.net.poles.size / 3, size / 1e6, 1e3 * off.maximum, 1e3 * off.rms]


def main() -> None:
    """Print all figures."""
    options = parser(__doc__)
    options.add_argument("files", nargs="*", help="blades; the bundled ones if none is named")
    asked = options.parse_args()
    names = asked.files or bg.bundled()[: 1 if asked.quick else None]
    cases = [(name, path) for name in names for path in PATHS][: 1 if asked.quick else None]
    for name, path in cases:
        definition = bg.read(name)
        blades = {
            "faired": bg.Blade.from_definition(definition, path=path),
            "not faired": bg.Blade.from_definition(definition, path=path, fairing=None),
        }
        for tolerance in TOLERANCES[-1 if asked.quick else 0 :]:
            case = f"{definition.name}, {path}, {1e3 * tolerance:g} mm"
            made = {label: solid(blade, tolerance) for label, blade in blades.items()}
            for k, (what, unit) in enumerate(UNITS.items()):
                figure(what, case, unit, {label: found[k] for label, found in made.items()})
    for name, path in cases:
        own = bg.Blade.from_definition(bg.read(name), path=path)
        both = {"own widths": own, "the path's widths": replace(own, edge_width=None)}
        for what, find in (("bulges of the edge", edge_bulges), ("inflections", inflections)):
            found = {label: len(find(blade)) for label, blade in both.items()}
            figure(what, f"{own.name}, {path}", "", found)
        fair = bg.Blade.from_definition(
            bg.read(name), path=path, fair_planform=bg.PlanformFairing()
        )
        surfaces = {"fair planform": fairness(fair), "as given": fairness(own)}
        jumps = {label: one.jump[0] for label, one in surfaces.items()}
        varies = {label: one.spanwise for label, one in surfaces.items()}
        figure("largest jump of spanwise curvature", f"{own.name}, {path}", "1/m", jumps)
        figure("spanwise curvature varies by", f"{own.name}, {path}", "1/m", varies)
    for name in names:
        blade = bg.Blade.from_definition(bg.read(name))
        for one in combs.figures(blade):
            found = {"faired": one["roughness_faired"], "not faired": one["roughness_given"]}
            case = f"{blade.name}, {one['airfoil']}"
            figure("roughness of the airfoil", case, "1/chord", found)


if __name__ == "__main__":
    main()
