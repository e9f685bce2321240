"""What a rotor's mesh finds on a section: its cells around a section alone, in two dimensions.

    python benchmarks/snapped_section.py BLADE ANGLE [--cells N] [--y-plus Y] [--edges N] [--quick]

snappyHexMesh meshes a stretched section at 70 % span by the dictionaries of a rotor's case, with
cells as long as wide, and extrudeMesh makes one layer of it; simpleFoam solves the flow by the
rotor's schemes.  ANGLE is that of attack, in degrees.  Prints lift and drag beside NeuralFoil's,
whose boundary layers are tripped at 5 % of the chord.  Needs OpenFOAM.
"""

import argparse
import os
import re
import subprocess
import tempfile
from dataclasses import replace
from math import ceil
from pathlib import Path
from typing import Any

import numpy as np
from figures import figure, parser

import bladegen as bg
from bladegen.exports.cases import dictionaries
from bladegen.exports.cases.folder import put_dictionaries, put_fields
from bladegen.exports.cases.guidance import DEBIAN
from bladegen.exports.cases.rotors import dictionaries as rotors
from bladegen.exports.cases.rotors import meshing
from bladegen.exports.cases.rotors.sector import growing
from bladegen.exports.cases.section import SectionCase, section_case
from bladegen.surface.wall_spacing import first_height

SPAN, FAR = 0.7, 40.0  # fraction; chords
NOSE, TAIL = 0.03, 0.997  # chords from the leading edge, between which cells are not finer
EVEN = (-1.0, 2.0), (-0.7, 0.7)  # chords, within which background cells are of one size
LEVEL = 3  # halvings on the section
WIDE = 5  # background cells, of the surface's width
ENDS = "front", "back"
STEPS = "blockMesh", "snappyHexMesh -overwrite", "extrudeMesh", "checkMesh", "simpleFoam"


def surface(path: Path, points: np.ndarray, labels: list[str], kept: np.ndarray, z: float) -> None:
    """Write the strip over the outline (n, 2), from -z on and `WIDE` times as wide."""
    count = len(points)
    rows = [f"v {x:.9g} {y:.9g} {at:.9g}" for at in (-z, WIDE * z - z) for x, y in points]
    last = ""
    for i in np.flatnonzero(kept).tolist():
        if labels[i] != last:
            last = labels[i]
            rows.append(f"g {last}")
        a, b = i + 1, (i + 1) % count + 1
        rows += [f"f {a} {a + count} {b + count}", f"f {a} {b + count} {b}"]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join([*rows, ""]), encoding="ascii")


def graded(low: float, high: float, cell: float, far: float) -> tuple[int, str]:
    """Return how many cells there are from -far to far, and blockMesh's grading."""
    even = ceil((high - low) / cell)
    high = low + even * cell
    (before, nearer), (after, farther) = (growing(far - x, cell, 1.35) for x in (-low, high))
    parts = [
        (far + low, before, 1.0 / nearer),
        (high - low, even, 1.0),
        (far - high, after, farther),
    ]
    shown = " ".join(f"({length / (2.0 * far):.9g} {n} {r:.9g})" for length, n, r in parts)
    return before + even + after, f"({shown})"


def blocks(chord: float, cell: float) -> dict[str, Any]:
    """Return the entries of blockMeshDict: one block, fine around the section."""
    far = FAR * chord
    (nx, gx), (ny, gy) = (graded(chord * low, chord * high, cell, far) for low, high in EVEN)
    corners = [(x * far, y * far) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    around = "faces ((0 4 7 3) (1 2 6 5) (0 1 5 4) (3 7 6 2));"
    return {
        "scale": 1,
        "vertices": [(*corner, z) for z in (0.0, cell) for corner in corners],
        "blocks": [f"hex (0 1 2 3 4 5 6 7) ({nx} {ny} 1) simpleGrading ({gx} {gy} 1)"],
        "boundary": [
            f"far_field {{ type patch; {around} }}",
            "front { type patch; faces ((0 3 2 1)); }",
            "back { type patch; faces ((4 5 6 7)); }",
        ],
    }


def fields(made: SectionCase) -> dict[str, tuple[str, dict[str, Any]]]:
    """Return the fields of a section's case, with the walls and the stream of a rotor's."""
    speed, chord = made.flow.speed, made.flow.chord
    omega = rotors.OMEGA * speed / chord
    kinetic = rotors.EDDIES * made.flow.viscosity * omega
    given = {
        "U": (f"({speed} 0 0)", "freestreamVelocity", {"type": "noSlip"}),
        "p": ("0", "freestreamPressure", {"type": "zeroGradient"}),
        "k": (kinetic, "freestream", {"type": "kqRWallFunction"}),
        "omega": (omega, "freestream", {"type": "omegaWallFunction"}),
        "nut": (kinetic / omega, "freestream", {"type": "nutUSpaldingWallFunction"}),
    }
    found = {}
    for name, (value, far, wall) in given.items():
        held = {"value": f"uniform {value}"} if name in ("k", "omega", "nut") else {}
        found[name] = (
            "volVectorField" if name == "U" else "volScalarField",
            {
                "dimensions": dictionaries.DIMENSIONS[name],
                "internalField": f"uniform {value}",
                "boundaryField": {
                    "blade": wall | held,
                    "far_field": {"type": far, "freestreamValue": f"uniform {value}"},
                    **{end: {"type": "empty"} for end in ENDS},
                },
            },
        )
    return found


def system(made: SectionCase, end: int) -> dict[str, dict[str, Any]]:
    """Return the dictionaries of the run, by the rotor's schemes and solvers."""
    chord = made.flow.chord
    level = replace(made.flow, alpha=0.0)  # it is the section that is turned
    return {
        "controlDict": dictionaries.system(level, chord, end)["controlDict"],
        **rotors.numerics(),
        "extrudeMeshDict": {
            "constructFrom": "patch",
            "sourceCase": '"."',
            "sourcePatches": ENDS[:1],
            "exposedPatchName": ENDS[1],
            "flipNormals": "false",
            "extrudeModel": "linearNormal",
            "nLayers": 1,
            "expansionRatio": 1,
            "linearNormalCoeffs": {"thickness": chord},
            "mergeFaces": "false",
        },
    }


def write(made: SectionCase, folder: Path, asked: argparse.Namespace) -> None:
    """Write the case."""
    chord, around = made.flow.chord, made.layers[0]
    size = 2.0 * chord / asked.cells
    cell = size * 2**LEVEL
    c, s = np.cos(made.flow.alpha), np.sin(made.flow.alpha)
    points = around @ np.array([[c, -s], [s, c]])
    labels = [name for name, count in made.outline.sides.items() for _ in range(count)]
    ends = (around[:, 0] < NOSE * chord) | (around[:, 0] > TAIL * chord)
    for name, kept in ((meshing.SURFACE, np.full(len(points), True)), (meshing.EDGES, ends)):
        surface(folder / "constant/triSurface" / name, points, labels, kept, 2.0 * cell)
    height = 2.0 * float(first_height(made.flow.reynolds, chord, asked.y_plus))
    layers = meshing.Layers.under(size, height, asked.growth)
    inside = np.array([-0.613 * chord, 0.411 * chord, 0.37 * cell])
    snappy = meshing.snappy(LEVEL, size, layers, inside, list(made.outline.sides))
    regions = snappy["castellatedMeshControls"]["refinementRegions"]
    regions["edges"]["levels"] = regions["edges"]["levels"][-asked.edges :]
    if not asked.edges:
        del regions["edges"]
    files = system(made, asked.end)
    files |= {"blockMeshDict": blocks(chord, cell), "snappyHexMeshDict": snappy}
    put_dictionaries(folder / "system", files, "")
    put_dictionaries(folder / "constant", dictionaries.fluid(made.flow.viscosity), "")
    put_fields(folder, fields(made))


def run(folder: Path) -> tuple[int, float, float]:
    """Run the case; return how many cells it has, lift and drag."""
    environment = {**os.environ, "WM_PROJECT_DIR": os.environ.get("WM_PROJECT_DIR", DEBIAN)}
    said = {}
    for step in STEPS:
        words = step.split()
        done = subprocess.run(
            words, cwd=folder, env=environment, check=True, capture_output=True, text=True
        )
        said[words[0]] = done.stdout
        if words[0] == "extrudeMesh":
            patches = folder / "constant/polyMesh/boundary"
            text = patches.read_text(encoding="ascii")
            empty = re.sub(r"((?:front|back)\s*\{\s*type\s+)patch;", r"\1empty;", text)
            patches.write_text(empty, encoding="ascii")
    found = re.search(r"cells: +(\d+)", said["checkMesh"])
    assert found is not None
    lines = (folder / "postProcessing/forces/0/coefficient.dat").read_text().splitlines()
    names = next(line for line in lines if line.startswith("# Time")).split()[1:]
    last = dict(zip(names, lines[-1].split(), strict=True))
    return int(found[1]), float(last["Cl"]), float(last["Cd"])


def main() -> None:
    """Print what the section's flow came to."""
    options = parser(__doc__)
    options.add_argument("blade")
    options.add_argument("angle", type=float)
    options.add_argument("--cells", type=int, default=48)
    options.add_argument("--y-plus", type=float, default=300.0)
    options.add_argument("--growth", type=float, default=1.6)
    options.add_argument("--edges", type=int, default=2, help="halvings at both edges, 0 to 2")
    options.add_argument("--end", type=int, default=300)
    asked = options.parse_args()
    if asked.quick:
        asked.cells, asked.end = 24, 50
    import neuralfoil

    blade = bg.Blade.from_definition(bg.read(asked.blade))
    made = section_case(blade, SPAN, alpha=np.radians(asked.angle))
    with tempfile.TemporaryDirectory() as name:
        write(made, Path(name), asked)
        cells, lift, drag = run(Path(name))
    beside = neuralfoil.get_aero_from_coordinates(
        blade.profiles([SPAN])[0],
        asked.angle,
        made.flow.reynolds,
        xtr_upper=0.05,
        xtr_lower=0.05,
        model_size="xlarge",
    )
    case = f"{asked.blade}, {asked.angle:g} degrees, {asked.cells} around, y+ {asked.y_plus:g}"
    case += f", edges halved {asked.edges} times, {cells} cells"
    figure("lift", case, "", {"OpenFOAM": lift, "NeuralFoil, tripped": float(beside["CL"][0])})
    figure("drag", case, "", {"OpenFOAM": drag, "NeuralFoil, tripped": float(beside["CD"][0])})


if __name__ == "__main__":
    main()
