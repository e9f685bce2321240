"""A rotor by WISDEM's CCBlade: run by `test_aero` in an environment that has it.

    python ccblade.py FILE.npz

The file holds elements of one rotor and polars; printed are power, thrust and root moment
coefficients, a line each case.
"""

import sys
from importlib.util import find_spec
from types import ModuleType

import numpy as np

# CCBlade alone: WISDEM itself imports its hundred packages
wisdem = ModuleType("wisdem")
wisdem.__path__ = list(find_spec("wisdem").submodule_search_locations)
sys.modules["wisdem"] = wisdem
from wisdem.ccblade.ccblade import CCBlade  # noqa: E402

WIND = 8.0  # m/s; coefficients do not depend on it


class Airfoil:
    """Coefficients straight between given angles; CCBlade's own smooths them."""

    one_Re = True  # noqa: N815 - the name that CCBlade asks for

    def __init__(self, alpha, cl, cd):
        self.given = alpha, cl, cd

    def evaluate(self, alpha, Re, return_cm=False):
        alpha = (alpha + np.pi) % (2.0 * np.pi) - np.pi
        return tuple(float(np.interp(alpha, self.given[0], part)) for part in self.given[1:])


def main(path):
    given = dict(np.load(path))
    cone = float(given["cone"])
    c, s = np.cos(cone), np.sin(cone)
    precurve = given["axial"] * c + given["radius"] * s
    along = given["radius"] * c - given["axial"] * s
    inner = slice(1, -1)
    airfoils = [
        Airfoil(given["alpha"], lift, drag)
        for lift, drag in zip(given["cl"][inner], given["cd"][inner], strict=True)
    ]
    rotor = CCBlade(
        along[inner],
        given["chord"][inner],
        np.degrees(given["twist"][inner]),
        airfoils,
        along[0],
        along[-1],
        B=int(given["blades"]),
        rho=1.225,
        mu=1.8e-5,
        precone=np.degrees(cone),
        nSector=4,
        hubHt=150.0,  # no blade goes below the ground
        shearExp=0.0,
        precurve=precurve[inner],
        precurveTip=precurve[-1],
    )
    wind = np.full(len(given["ratios"]), WIND)
    turns = given["ratios"] * WIND / rotor.rotorR * 30.0 / np.pi
    found, _ = rotor.evaluate(wind, turns, np.degrees(given["pitch"]), coefficients=True)
    np.savetxt(sys.stdout, np.stack([found[name] for name in ("CP", "CT", "CMb")], axis=1))


if __name__ == "__main__":
    main(sys.argv[1])
