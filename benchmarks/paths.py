"""Geodesics, smooth splines and plain blending: who predicts a station that was left out?

    python benchmarks/paths.py [turbine.yaml ...]

Each inner station of each blade is left out in turn and predicted from the others: RMS distance
of its landmarks in % chord, sections of unit chord brought to the station's own thickness. Paths
run in span or in relative thickness.  Blending is that of coordinates, linear and by monotone
splines (PCHIP).  All inner stations count; the last row is the geometric mean of the blades'
medians and of their largest.  Then how far the spline leaves the geodesics, and the creases: the
largest jump of the surface normal across a station.
"""

from pathlib import Path

import numpy as np
from figures import figure, parser
from scipy.interpolate import PchipInterpolator, interp1d

import bladegen as bg
from bladegen.blade.lofting.parameters import Parameter
from bladegen.blade.lofting.paths import PATHS
from bladegen.measures.smoothness import creases
from bladegen.shapes import affine

WAYS = ("geodesic", "spline", "linear blend", "PCHIP blend")
SPANS = np.linspace(0.0, 1.0, 801)


def predicted(blade, left, way, by_thickness):
    """The left-out station's section, of unit chord and its own thickness."""
    keep = np.arange(len(blade.eta)) != left
    place, wanted = blade.eta[left], blade.wanted_thickness(blade.eta[left : left + 1])
    ruling = blade.definition.relative_thickness if by_thickness else None
    parameter = Parameter(blade.eta[keep], ruling)
    q = parameter(np.array([place]))
    if way in PATHS:
        path, M = PATHS[way](parameter, blade.representatives[keep], blade.M[keep])
        points = affine.restore(path(q), *path.maps(M, blade.b[keep])(q))
    else:
        given = affine.restore(blade.representatives, blade.M, blade.b)[keep]
        make = interp1d if way == "linear blend" else PchipInterpolator
        points = make(parameter.knots, given, axis=0)(q)
    A, c = blade.splines.normalising(points, wanted)
    return affine.restore(points, A, c)[0]


def missed(blade, by_thickness):
    """RMS distances [% chord] of the inner stations, by every way."""
    truth, found = blade.profiles(blade.eta), {}
    for way in WAYS:
        inner = range(1, len(blade.eta) - 1)
        off = [predicted(blade, k, way, by_thickness) - truth[k] for k in inner]
        squares = np.sum(np.square(off), axis=-1)
        found[way] = list(100 * np.sqrt(squares.mean(axis=-1)))
    return found


def mean_of(rows, what):
    """The geometric mean over blades of what is taken of each way's distances."""
    return {way: float(np.exp(np.mean([np.log(what(row[way])) for row in rows]))) for way in WAYS}


def main() -> None:
    """Print each blade's figures."""
    asked = parser(__doc__)
    asked.add_argument("files", nargs="*", type=Path, help="turbine files, besides the bundled")
    given = asked.parse_args()
    sources = [*bg.bundled()[: 1 if given.quick else None], *map(str, given.files)]
    rows = {True: [], False: []}
    for source in sources:
        blade, name = bg.Blade.from_definition(bg.read(source)), Path(source).stem
        for by_thickness, found in rows.items():
            found.append(missed(blade, by_thickness))
            where = "thickness" if by_thickness else "span"
            figure("left-out station missed by", f"{name}, in {where}", "% chord", found[-1])
    for what, word in ((np.median, "medians"), (np.max, "largest")):
        case = f"{len(sources)} blades, in thickness"
        figure(f"geometric mean of {word}", case, "% chord", mean_of(rows[True], what))
    for source in sources:
        name, definition = Path(source).stem, bg.read(source)
        blades = {path: bg.Blade.from_definition(definition, path=path) for path in PATHS}
        apart = blades["spline"].sections(SPANS) - blades["geodesic"].sections(SPANS)
        far = np.linalg.norm(apart, axis=-1)
        worst = SPANS[int(np.argmax(far.max(axis=1)))]
        figure("spline leaves the geodesics", f"{name}, at eta {worst:.3f}", "mm", 1e3 * far.max())
        figure("spline leaves them, RMS", name, "mm", 1e3 * float(np.sqrt(np.mean(far**2))))
        found, places = {}, []
        for path, blade in blades.items():
            eta, angle = creases(blade)
            worst = int(np.argmax(angle))
            found[path] = float(np.degrees(angle[worst]))
            places.append(f"{eta[worst]:.3f}")
        figure("largest crease", f"{name}, eta {' and '.join(places)}", "deg", found)


if __name__ == "__main__":
    main()
