"""Beam properties by WISDEM's PreComp: run by `test_sectors` in an environment that has it.

    python precomp.py

Printed are those of the IEA 15 MW and of a steel tube, as JSON.
"""

import json
import sys
from importlib.util import find_spec
from types import ModuleType

import numpy as np

# PreComp alone: WISDEM itself imports its hundred packages
wisdem = ModuleType("wisdem")
wisdem.__path__ = list(find_spec("wisdem").submodule_search_locations)
sys.modules["wisdem"] = wisdem
from test_sectors import tube  # noqa: E402

import bladegen as bg  # noqa: E402
from bladegen.wisdem import beam_properties  # noqa: E402

FIGURES = ("eta", "mass", "flap", "edge", "torsion", "axial", "stiffness", "inertia")


def main():
    found, own = {}, bg.Blade.from_definition(bg.read("iea15mw"))
    for name, blade in (("iea15mw", own), ("tube", tube())):
        made = beam_properties(blade, np.linspace(0.0, 1.0, 50))
        found[name] = {figure: getattr(made, figure).tolist() for figure in FIGURES}
        found[name] |= {"elastodyn": made.elastodyn(), "beamdyn": made.beamdyn()}
    sys.stdout.write(json.dumps(found))


if __name__ == "__main__":
    main()
