"""Geodesics, smooth splines and plain blending: who predicts a station that was left out?

    python benchmarks/paths.py

Each inner station of each blade is left out in turn and predicted from the others: RMS distance
of its landmarks in % chord, sections of unit chord brought to the station's own thickness. Paths
run in span or in relative thickness.  Blending is that of coordinates, linear and by monotone
splines (PCHIP).  All inner stations count.  Then the creases: the largest jump of the surface
normal across a station.
"""

import numpy as np
from figures import asked, figure
from scipy.interpolate import PchipInterpolator, interp1d

import bladegen as bg
from bladegen.blade.lofting.parameters import Parameter
from bladegen.blade.lofting.paths import PATHS
from bladegen.measures.smoothness import creases
from bladegen.shapes import affine

WAYS = ("geodesic", "spline", "linear blend", "PCHIP blend")


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


def main() -> None:
    """Print each blade's figures."""
    names = bg.bundled()[: 1 if asked(__doc__).quick else None]
    for name in names:
        blade = bg.Blade.from_definition(bg.read(name))
        truth = blade.profiles(blade.eta)
        inner = range(1, len(blade.eta) - 1)
        for by_thickness in (False, True):
            missed = {}
            for way in WAYS:
                off = [predicted(blade, k, way, by_thickness) - truth[k] for k in inner]
                squares = np.sum(np.square(off), axis=-1)
                missed[way] = list(100 * np.sqrt(squares.mean(axis=-1)))
            where = "thickness" if by_thickness else "span"
            figure("left-out station missed by", f"{name}, in {where}", "% chord", missed)
    for name in names:
        found, places = {}, []
        for path in PATHS:
            eta, angle = creases(bg.Blade.from_definition(bg.read(name), path=path))
            worst = int(np.argmax(angle))
            found[path] = float(np.degrees(angle[worst]))
            places.append(f"{eta[worst]:.3f}")
        figure("largest crease", f"{name}, eta {' and '.join(places)}", "deg", found)


if __name__ == "__main__":
    main()
