"""pyNuMAD's shells of a windIO 1 file, as JSON: python pynumad_mesh.py blade.yaml SIZE

It runs in an environment of its own: pyNuMAD needs numpy below 2.
"""

import contextlib
import json
import sys

from pynumad.mesh_gen.mesh_gen import get_shell_mesh
from pynumad.objects.blade import Blade

with contextlib.redirect_stdout(sys.stderr):
    blade = Blade(sys.argv[1])
    blade.update_blade()
    mesh = get_shell_mesh(blade, 0, float(sys.argv[2]))
found = {
    "nodes": [[float(x) for x in node] for node in mesh["nodes"]],
    "elements": [[int(i) for i in element] for element in mesh["elements"]],
    "sets": {one["name"]: [int(i) for i in one["labels"]] for one in mesh["sets"]["element"]},
    "plies": {
        one["elementSet"]: [(str(ply[0]), float(ply[1])) for ply in one["layup"]]
        for one in mesh["sections"]
    },
}
sys.stdout.write(json.dumps(found))
