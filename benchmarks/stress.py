"""Geometry under stress: random perturbed blades to solids, each measured as it lies on disk.

Blade i depends on the seed and on i alone: one of the three blades, either path, either tip,
either tolerance, trailing edges of 1, 2 or 5 mm, coordinates drawn from the whole of the space's
data, odd sections among them, and all affine parameters.  A perturbation that is refused is counted
and drawn again.  Each solid is written as STEP and read again: one closed valid solid, within
tolerance, with the volume that was written; every tenth is held against the integral over its
sections and meshed by gmsh besides.

    python benchmarks/stress.py --count 1000 --results stress.jsonl

One line a blade is appended to the results as soon as it is known, so that a run may be broken
off and taken up again, in pieces (`--first`) and by several processes at once, each with results
of its own.  Blades are made in worker processes of ten, under a time limit each: a crash or a
hang is a result like any other.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
from figures import figure
from figures import parser as arguments

import bladegen as bg
from bladegen.blade import edges
from bladegen.cad import exchange, shapes, solids
from bladegen.curves.crossing import crossing_sections
from bladegen.errors import BladegenError, PerturbationError
from bladegen.measures import checks, properties
from bladegen.surface.tips import Tip, flat_tip, round_tip

PIECE = 10  # blades of one worker process
MESHED = 10  # every so many-th solid is meshed by gmsh
PATIENCE = 600.0  # s a blade
DRAWS = 50
TOLERANCES = (1e-3,) * 7 + (0.3e-3,)  # m: --light, and the default for every eighth
EDGES = (edges.MinimumThickness(), edges.MinimumThickness(0.005), edges.MinimumThickness(0.001))
VOLUME = 1e-4  # relative, of the net against the integral over sections
OCCT = 1e-2  # relative, of OCCT's volume, a round tip included, against the net's
READ = 1e-6  # relative, of the volume read against the volume written
SPANS = np.linspace(0.0, 1.0, 101)
ELEMENT = 0.5  # m, of gmsh's triangles
RANGES = {
    "thickness": (0.85, 1.15),
    "camber": (0.95, 1.05),
    "chord": (0.9, 1.1),
    "twist": (-np.radians(5.0), np.radians(5.0)),
    "chord_scale": (0.8, 1.2),
    "twist_scale": (0.5, 1.5),
    "prebend_scale": (0.0, 2.0),
}


def drawn(number: int, seed: int, space: bg.ShapeSpace) -> tuple[bg.Blade, float, Tip, int]:
    """Return blade `number`, its tolerance and tip, and how many draws were refused before it."""
    names = bg.bundled()
    place, name = divmod(number, len(names))
    place, path = divmod(place, 2)
    place, tip = divmod(place, 2)
    base = bg.Blade.from_definition(
        bg.read(names[name]),
        path=("geodesic", "spline")[path],
        trailing_edge=EDGES[place % len(EDGES)],
    )
    rng = np.random.default_rng([seed, number])
    for refused in range(DRAWS):
        t = space.sample(1, rng)[0]
        factors = {key: float(rng.uniform(*ends)) for key, ends in RANGES.items()}
        try:
            variant = base.perturbed(space, t, allow_extrapolation=True, allow_odd=True, **factors)
        except PerturbationError:
            continue
        tolerance = TOLERANCES[place % len(TOLERANCES)]
        return variant, tolerance, (flat_tip, round_tip)[tip], refused
    raise RuntimeError(f"blade {number}: {DRAWS} perturbations refused")


def measured(number: int, seed: int, space: bg.ShapeSpace, folder: Path) -> dict[str, Any]:
    """Make one blade's solid and measure its file."""
    start = time.perf_counter()
    blade, tolerance, tip, refused = drawn(number, seed, space)
    row: dict[str, Any] = {
        "number": number,
        "blade": blade.name,
        "path": blade.path.__name__,
        "tip": tip.__name__,
        "trailing_edge": repr(blade.trailing_edge),
        "tolerance_mm": 1e3 * tolerance,
        "refused": refused,
        "error": "",
    }
    path = folder / "blade.step"
    try:
        solid = solids.solid(blade, tolerance=tolerance, tip=tip)
        exchange.write_step(solid, path)
        before = shapes.quick_volume(solid.shape) / shapes.MILLIMETRES**3
        off = before / solid.net.volume() - 1.0
        if abs(off) >= OCCT:  # twisted blades ask for the slower rule
            off = shapes.volume(solid.shape) / shapes.MILLIMETRES**3 / solid.net.volume() - 1.0
        figures = checks.solid_figures(exchange.read_step(path), quick=True)
        profiles = blade.trailing_edge(blade.profiles(SPANS), blade.chord(SPANS))
    except BladegenError as error:
        return row | {"error": str(error), "seconds": time.perf_counter() - start}
    row |= {
        "valid": figures["valid"],
        "closed": figures["closed"] and figures["one_solid"],
        "deviation_mm": 1e3 * solid.deviation.maximum,
        "within": solid.deviation.maximum <= tolerance,
        "volume_occt": off,
        "volume_read": figures["volume_m3"] / before - 1.0,
        "crossing": len(crossing_sections(profiles)),
        "megabytes": path.stat().st_size / 1e6,
        "seconds": time.perf_counter() - start,
    }
    if number % MESHED == 0:
        row["volume"] = solid.net.volume() / properties.volume(blade) - 1.0
        row |= meshed(path)
    return row


def meshed(path: Path) -> dict[str, Any]:
    """Mesh a STEP file's surface by gmsh; closed if every edge belongs to two triangles."""
    import gmsh

    start = time.perf_counter()
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)
        gmsh.option.setString("Geometry.OCCTargetUnit", "M")
        gmsh.model.occ.importShapes(str(path))
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.MeshSizeMax", ELEMENT)
        gmsh.model.mesh.generate(2)
        _, _, nodes = gmsh.model.mesh.getElements(2)
        triangles = np.concatenate(nodes).reshape(-1, 3).astype(np.int64)
    except Exception as error:  # gmsh raises plain exceptions
        return {"meshable": False, "mesh_error": str(error)}
    finally:
        gmsh.finalize()
    sides = np.sort(np.stack([triangles, np.roll(triangles, 1, axis=1)], axis=-1).reshape(-1, 2))
    _, counts = np.unique(sides, axis=0, return_counts=True)
    return {
        "meshable": bool(np.all(counts == 2)),
        "triangles": len(triangles),
        "mesh_seconds": time.perf_counter() - start,
    }


def sound(row: dict[str, Any]) -> bool:
    """Tell whether all that was measured of a blade is as it should be."""
    return bool(
        not row["error"]
        and row["valid"]
        and row["closed"]
        and row["within"]
        and abs(row.get("volume", 0.0)) < VOLUME
        and abs(row["volume_occt"]) < OCCT
        and abs(row["volume_read"]) < READ
        and not row["crossing"]
        and row.get("meshable", True)
    )


def work(first: int, last: int, seed: int) -> None:
    """Print a line a blade; the parent reads them."""
    space = bg.ShapeSpace.bundled()
    with tempfile.TemporaryDirectory() as folder:
        for number in range(first, last):
            print(json.dumps(measured(number, seed, space, Path(folder))), flush=True)


def piece(first: int, last: int, seed: int) -> list[dict[str, Any]]:
    """Make blades in a process of their own; what is missing of the result crashed or hung."""
    command = [sys.executable, __file__, "--work", f"{first}:{last}", "--seed", str(seed)]
    environment = os.environ | {"OMP_NUM_THREADS": "1"}
    limit = PATIENCE * (last - first)
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=limit, check=False, env=environment
        )
        out, fault = done.stdout, f"the process ended with {done.returncode}: {done.stderr[-300:]}"
    except subprocess.TimeoutExpired as error:
        out, fault = (error.stdout or b"").decode(), f"not done after {limit:g} s"
    rows = [json.loads(line) for line in out.splitlines()]
    if len(rows) < last - first:
        broken = first + len(rows)
        rows.append({"number": broken, "error": fault, "unexpected": True})
        if broken + 1 < last:
            rows += piece(broken + 1, last, seed)
    return rows


def known(results: Path) -> dict[int, dict[str, Any]]:
    """Return the rows of earlier runs by number; a line that a killed run left half is none."""
    rows = {}
    for line in results.read_text().splitlines() if results.exists() else ():
        try:
            row = json.loads(line)
        except ValueError:
            continue
        rows[row["number"]] = row
    return rows


def shown(rows: list[dict[str, Any]]) -> None:
    """Print what the blades came to."""
    made = [row for row in rows if not row["error"]]
    meshes = [row for row in made if "meshable" in row]
    print(f"blades             {len(rows)}")
    print(f"perturbations refused and drawn again  {sum(row.get('refused', 0) for row in rows)}")
    for name, good, of in (
        ("made without error", made, rows),
        ("valid", [r for r in made if r["valid"]], rows),
        ("one closed solid", [r for r in made if r["closed"]], rows),
        ("within tolerance", [r for r in made if r["within"]], rows),
        ("meshed by gmsh", [r for r in meshes if r["meshable"]], meshes),
        ("sound throughout", [r for r in rows if sound(r)], rows),
    ):
        figure(f"perturbed solids: {name}", f"of {len(of)}", "solids", len(good))
    if made:
        case = f"blades {rows[0]['number']} to {rows[-1]['number']}"
        ratio = [row["deviation_mm"] / row["tolerance_mm"] for row in made]
        figure("perturbed solids: deviation over tolerance", case, "", ratio)
        figure("perturbed solids: a blade", case, "s", [row["seconds"] for row in made])
        for key in ("volume", "volume_occt", "volume_read"):
            off = max((abs(row[key]) for row in made if key in row), default=0.0)
            print(f"{key:11s} off by at most  {off:.1e}")
    for error, count in Counter(row["error"] for row in rows if row["error"]).most_common(20):
        print(f"  {count} x {error}")
    for row in rows:
        if not row["error"] and not sound(row):
            print(f"  unsound: {json.dumps(row)}")


def main() -> None:
    """Make what is missing of the blades asked for, then print what all came to."""
    parser = arguments(__doc__)
    parser.add_argument("--count", type=int)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=8)
    parser.add_argument(
        "--results", type=Path, action="append", help="the first grows; more are read"
    )
    parser.add_argument("--work", help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.work:
        first, last = map(int, asked.work.split(":"))
        work(first, last, asked.seed)
        return
    count = asked.count or (1 if asked.quick else 12)
    rows: dict[int, dict[str, Any]] = {}
    for path in asked.results or ():
        rows |= known(path)
    for start in range(asked.first, asked.first + count, PIECE):
        missing = [
            n for n in range(start, min(start + PIECE, asked.first + count)) if n not in rows
        ]
        if not missing:
            continue
        made = piece(missing[0], missing[-1] + 1, asked.seed)
        rows |= {row["number"]: row for row in made}
        if asked.results:
            with asked.results[0].open("a") as stream:
                stream.writelines(json.dumps(row) + "\n" for row in made)
    shown([rows[number] for number in sorted(rows)])


if __name__ == "__main__":
    main()
