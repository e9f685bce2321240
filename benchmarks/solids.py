"""Solids: time against deviation, of our B-spline net and of OCCT's loft through sections.

    python benchmarks/solids.py

Ours is made at several tolerances, the loft (BRepOffsetAPI_ThruSections) through 20 to 160 sections
of 101 interpolated points.  Each contender lives in a process of its own, which has loaded its
libraries and made and written one solid before; then they take turns, in the same rounds.  Both are
timed from a blade that holds nothing computed yet to the shape, and to the STEP file.  How far a
solid is from the blade is measured alike: by OCCT's projections of 480 points of the blade's sides,
at spans and landmarks that were not used.  What is not done after so many seconds (`--patience`) is
not tried again.
"""

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from concurrent.futures import TimeoutError as NotDone
from pathlib import Path
from typing import Any

import numpy as np
from figures import figure, parser
from scipy.spatial import cKDTree

import bladegen as bg
from bladegen.airfoils.landmarks import landmark_parameters
from bladegen.cad import exchange, shapes, solids

TOLERANCES = (3.0, 1.0, 0.3, 0.1, 0.05)  # mm
SECTIONS = (20, 40, 80, 160)
LOFT_LANDMARKS = 101
RUNS = 3
PATIENCE = 30.0  # s
WARMING = 4.0  # times the patience: libraries are loaded and compiled
SPANS, PLACES = 40, 12  # of the points that are measured
GRID = 160  # points a direction, of a face, from the nearest of which a projection starts
TIGHT = 1e-6  # mm, of OCCT's loft
EXACT = 1e-9  # mm, of OCCT's projections


def distance_mm(blade: bg.Blade, shape: Any) -> float:
    """Return the largest distance of points of the blade's sides to a shape [mm].

    Each point is projected by OCCT on the surface of each face, from the nearest point of a grid.
    """
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.gp import gp_Pnt, gp_Pnt2d
    from OCP.ShapeAnalysis import ShapeAnalysis_Surface
    from OCP.TopAbs import TopAbs_FACE
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopoDS import TopoDS

    rng = np.random.default_rng(11)
    half = np.sort(rng.uniform(0.0, 0.5, PLACES // 2))
    u = np.concatenate([half, 1.0 - half[::-1]])
    points = 1e3 * blade.sections(rng.uniform(0.0, 1.0, SPANS), u).reshape(-1, 3)
    least = np.full(len(points), np.inf)
    explorer = TopExp_Explorer(shape, TopAbs_FACE)
    while explorer.More():
        face = BRepAdaptor_Surface(TopoDS.Face_s(explorer.Current()))
        surface = ShapeAnalysis_Surface(face.Surface().Surface().Transformed(face.Trsf()))
        ends = face.FirstUParameter(), face.LastUParameter()
        grid_u = np.linspace(*ends, GRID)
        grid_v = np.linspace(face.FirstVParameter(), face.LastVParameter(), GRID)
        grid = [(x, y) for x in grid_u.tolist() for y in grid_v.tolist()]
        seen = np.array([surface.Value(x, y).Coord() for x, y in grid])
        apart, nearest = cKDTree(seen).query(points)
        for k, near in enumerate(nearest):
            surface.NextValueOfUV(gp_Pnt2d(*grid[near]), gp_Pnt(*points[k].tolist()), EXACT)
            least[k] = min(least[k], surface.Gap(), apart[k])
        explorer.Next()
    return float(least.max())


def netted(blade: bg.Blade, tolerance: float) -> tuple[Any, Callable[[Path], None]]:
    """Return our solid's shape, and what writes it."""
    made = solids.solid(blade, tolerance=tolerance * 1e-3)
    return made.shape, lambda path: exchange.write_step(made, path)


def lofted(blade: bg.Blade, sections: float) -> tuple[Any, Callable[[Path], None]]:
    """Return OCCT's loft through interpolated wires, and what writes it."""
    import cadquery as cq
    from OCP.BRepOffsetAPI import BRepOffsetAPI_ThruSections
    from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

    loft = BRepOffsetAPI_ThruSections(True, False, TIGHT)
    u = landmark_parameters(LOFT_LANDMARKS)
    for section in 1e3 * blade.sections(blade.stations(int(sections)), u):
        points = [cq.Vector(*p) for p in section.tolist()]
        edge = cq.Edge.makeSpline(points)
        back = cq.Edge.makeLine(points[-1], points[0])
        loft.AddWire(cq.Wire.assembleEdges([edge, back]).wrapped)
    loft.Build()
    shape = loft.Shape()

    def write(path: Path) -> None:
        writer = STEPControl_Writer()
        writer.Transfer(shape, STEPControl_AsIs)
        writer.Write(str(path))

    return shape, write


CONTENDERS = {
    "bladegen": (netted, TOLERANCES, "to {:g} mm"),
    "OCCT's loft": (lofted, SECTIONS, "of {:g} sections"),
}


def work(contender: str) -> None:
    """Make solids as the parent asks, a line of JSON each way."""
    make = CONTENDERS[contender][0]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "blade.step"
        for line in sys.stdin:
            asked = json.loads(line)
            blade = bg.Blade.from_definition(bg.read(asked["name"]))
            start, work = time.perf_counter(), time.process_time()
            shape, write = make(blade, asked["setting"])
            made = time.perf_counter() - start
            write(path)
            row = {
                "made": made,
                "written": time.perf_counter() - start,
                "processor": time.process_time() - work,
            }
            if asked["measure"]:
                row["mm"] = distance_mm(blade, shape)
                row["MB"] = path.stat().st_size / 1e6
                row["valid"] = float(shapes.is_valid(shape))
            print("\n" + json.dumps(row), flush=True)


class Worker:
    """A contender's process, which is ended when it takes too long and started again."""

    def __init__(self, contender: str, patience: float) -> None:
        self.contender, self.patience = contender, patience
        self.process: subprocess.Popen[str] | None = None

    def ask(self, name: str, setting: float, *, measure: bool) -> dict[str, float] | None:
        """Return what one solid took; None if it took too long or the process died."""
        warmed = self.process is not None
        if self.process is None:
            command = [sys.executable, __file__, "--work", self.contender]
            self.process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
            )
        first: float = CONTENDERS[self.contender][1][0]
        warming = () if warmed else ((first, WARMING * self.patience),)
        for of, patience in (*warming, (setting, self.patience)):
            row = self._answer({"name": name, "setting": of, "measure": measure}, patience)
            if row is None:
                return None
        return row

    def _answer(self, asked: dict[str, Any], patience: float) -> dict[str, float] | None:
        process = self.process
        assert process is not None
        assert process.stdin is not None
        process.stdin.write(json.dumps(asked) + "\n")
        process.stdin.flush()
        with ThreadPoolExecutor(1) as pool:
            line = pool.submit(next, answers(process), "")
            try:
                text = line.result(patience)
            except NotDone:
                process.kill()
                text = ""
        if not text:
            self.end()
            return None
        row: dict[str, float] = json.loads(text)
        return row

    def end(self) -> None:
        """End the process."""
        if self.process is not None:
            self.process.kill()
            self.process.communicate()
            self.process = None


def answers(process: "subprocess.Popen[str]") -> Iterator[str]:
    """Yield the lines of JSON that a worker prints; libraries print others."""
    assert process.stdout is not None
    return (line for line in process.stdout if line.startswith("{"))


def main() -> None:
    """Print each blade's figures."""
    options = parser(__doc__)
    options.add_argument("--runs", type=int, help="rounds")
    options.add_argument("--patience", type=float, default=PATIENCE, help="s a solid")
    options.add_argument("--work", help="for the processes that this one starts")
    asked = options.parse_args()
    if asked.work:
        work(asked.work)
        return
    workers = {name: Worker(name, asked.patience) for name in CONTENDERS}
    runs = asked.runs or (2 if asked.quick else RUNS)
    for name in bg.bundled()[: 1 if asked.quick else None]:
        settings = [
            (contender, setting)
            for contender, (_, all_, _) in CONTENDERS.items()
            for setting in (all_[:2] if asked.quick else all_)
        ]
        rows: dict[tuple[str, float], list[dict[str, float]]] = {key: [] for key in settings}
        late = set()
        for run in range(runs):
            for key in settings:
                if key in late:
                    continue
                row = workers[key[0]].ask(name, key[1], measure=run == 0)
                if row is None:
                    late.add(key)
                else:
                    rows[key].append(row)
        for key in settings:
            of = rows[key] if key not in late else []
            case = f"{name}, {key[0]} {CONTENDERS[key[0]][2].format(key[1])}"
            for what, unit, part in (
                ("made", "s", "made"),
                ("made and written", "s", "written"),
                ("the same, processor", "s", "processor"),
            ):
                figure(what, case, unit, {"": [row[part] for row in of] or None})
            for what, unit, part in (
                ("off the blade by up to", "mm", "mm"),
                ("STEP", "MB", "MB"),
                ("valid", "", "valid"),
            ):
                figure(what, case, unit, {"": of[0][part] if of else None})
    for worker in workers.values():
        worker.end()


if __name__ == "__main__":
    main()
