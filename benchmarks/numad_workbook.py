"""Key points and plies of a NuMAD workbook, against pyNuMAD's own.

Run: python benchmarks/numad_workbook.py BLADE.xlsx, with its airfoils in a folder `airfoils` beside
it.  pyNuMAD is no dependency of bladegen, and needs numpy below 2: install it in an environment
of its own, and name its Python in PYNUMAD_PYTHON.

pyNuMAD 1.0.0 and its main branch of March 2026 read a workbook into lists and single figures where
the rest of the package has dicts and figures a station: they are set here.  With a natural
offset the pitch axes differ (docs/structure.md), and the ends of caps with them.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

import bladegen as bg
from bladegen.blade.layup.outlines import Outlines
from bladegen.definition.structure.positions import LEADING_EDGE
from bladegen.formats.common import workbook
from bladegen.formats.common.document import Notes
from bladegen.formats.numad.component_rows import widths
from bladegen.formats.numad.keypoints import places

PYNUMAD = """
import json, sys, warnings
warnings.filterwarnings("ignore")
import numpy as np
from pynumad.objects.blade import Blade
blade = Blade(sys.argv[1])
given = blade.definition
for i, part in enumerate(given.components):
    part.name, part.group, part.materialid = f"{i}", int(part.group), int(part.materialid)
given.components = {part.name: part for part in given.components}
given.materials = {i + 1: one for i, one in enumerate(given.materials)}
every = np.ones(len(given.ispan))
for kind in ("sparcapwidth", "sparcapoffset"):
    for side in ("hp", "lp"):
        setattr(given, f"{kind}_{side}", float(getattr(given, kind)) * every)
for kind in ("leband", "teband"):
    setattr(given, kind, float(np.ravel(getattr(given, kind))[0]) * every)
blade.geometry.generate(given)
blade.keypoints.generate(given, blade.geometry)
blade.bill_of_materials.generate(given.ispan, given.components, given.materials, blade.keypoints)
blade.stackdb.generate(blade.keypoints, blade.bill_of_materials)
areas, weight = blade.keypoints.key_areas, 0.0
for (i, j), stack in np.ndenumerate(blade.stackdb.stacks):
    for ply in stack.plygroups:
        density = given.materials[ply.materialid].density
        weight += areas[i, j] * ply.nPlies * ply.thickness * 1e-3 * density
print("RESULT" + json.dumps({
    "span": list(given.ispan), "arcs": blade.keypoints.key_arcs.tolist(), "skin": float(weight),
}))
"""
ORDER = {"HP": ("te", None, "d", "c", "b", "a"), "LP": ("a", "b", "c", "d", None, "te")}
FIRST = {"HP": 0, "LP": 7}  # in pyNuMAD's list of key points


def main(path: Path) -> None:
    """Print how far key points are apart over the stations, and what both skins weigh."""
    python = os.environ.get("PYNUMAD_PYTHON", sys.executable)
    command = [python, "-c", PYNUMAD, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    found = [line for line in done.stdout.splitlines() if line.startswith("RESULT")]
    if not found:
        sys.exit(f"pyNuMAD did not run ({python}; PYNUMAD_PYTHON): {done.stderr[-500:]}")
    theirs = json.loads(found[0].removeprefix("RESULT"))
    span, arcs = np.array(theirs["span"]), np.array(theirs["arcs"])
    blade = bg.Blade.from_definition(bg.read(path))
    outlines = Outlines.of(blade, np.clip((span - span[0]) / (span[-1] - span[0]), 0.0, 1.0))
    nose = outlines.places(LEADING_EDGE)
    given = widths(dict(workbook.sheets(path, ("Components",))["Components"]), Notes())
    assert given is not None
    print("key point   of the arc: median   most")
    for side, labels in ORDER.items():
        own = places(side, given, "root")
        for i, label in enumerate(labels):
            if label is not None:
                from_nose = nose - outlines.places(own[label])
                apart = np.abs(from_nose - arcs[FIRST[side] + i] / outlines.length)
                print(f"{side} {label:8}{np.median(apart):20.5f}{apart.max():10.5f}")
    layup = blade.layup
    assert layup is not None
    skin = {layer.name for layer in layup.structure.layers if not layer.web}
    own_skin = sum(mass for name, mass in layup.layer_masses.items() if name in skin)
    print(
        f"skin: {own_skin:.0f} kg, by pyNuMAD's plies from station to station {theirs['skin']:.0f}"
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]))
