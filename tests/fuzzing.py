"""A fuzzer: targets with good input, their mutators, and a watchdog that no input escapes.

A `Target` is a row of `TARGETS`: what good input looks like, how it is made bad, and the function
that must answer it with a result or a `BladegenError`, in bounded time and memory, without NaN in
what comes out and without a file outside its folder.  Input `index` of a run depends on the seed
and on the index alone, so that a failure is found again from these two.

Inputs are tried in a worker process.  The parent waits for each answer no longer than `patience`
and the worker's memory is limited, so that a hang, a crash or a hunger for memory is found, noted
and survived.  `scripts/fuzz.py` runs it at length; `test_fuzz.py` in short.
"""

import json
import math
import multiprocessing
import os
import resource
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cache, partial
from multiprocessing.connection import Connection
from pathlib import Path
from random import Random
from typing import Any

import mutators
import numpy as np

import bladegen as bg
from bladegen.airfoils.landmarks import landmarks
from bladegen.airfoils.polars import Polar
from bladegen.blade.edges import AsGiven, MinimumThickness, Sharp
from bladegen.blade.planform import flange_to_axis, normal_to_axis, normal_to_z
from bladegen.errors import BladegenError
from bladegen.exports.options import Options
from bladegen.formats import writing
from bladegen.formats.airfoils.reading import read_airfoil
from bladegen.formats.baselines import baselines
from bladegen.formats.windio.yaml_file import parse_yaml
from bladegen.shapes import cst, database
from bladegen.support import archive
from bladegen.support.files import safe_stem
from strategies import naca

PATIENCE = 240.0  # s for one input on a machine that others use; the slowest needs 0.5 s of a core
MEMORY = 2 * 2**30  # bytes that a worker may take besides what it has when it starts
EXPORTED = 0.08  # of the inputs that make a blade: written as a mesh too
BUILT = 0.01  # and with a report
SPANS = np.array([0.0, 0.03, 0.21, 0.5, 0.77, 0.995, 1.0])


Files = dict[str, bytes]


@dataclass(frozen=True)
class Target:
    """Something that reads what others wrote.

    Parameters
    ----------
    name : str
        What is read.
    make : callable
        From a `Random` to an input: files by name, the one that is read first.
    answer : callable
        What reads the file, given a `Random` and an empty folder for what it writes; returns a
        word for what came of it, raises `BladegenError`, or has failed.
    share : int
        How many inputs it gets for each of another target with a share of 1.
    """

    name: str
    make: Callable[[Random], Files]
    answer: Callable[[Path, Path, Random], str]
    share: int = 1


@dataclass
class Tally:
    """What came of the inputs so far."""

    inputs: int = 0
    outcomes: Counter[str] = field(default_factory=Counter)
    failures: list[tuple[int, str]] = field(default_factory=list)
    slowest: tuple[float, int] = (0.0, -1)
    memory: float = 0.0  # MB, the largest a worker has taken
    seconds: float = 0.0


def trial(targets: tuple[Target, ...], seed: int, index: int) -> tuple[Target, Random, Files]:
    """Return the target of an input, the random numbers that are left for it, and the input."""
    rng = Random(f"{seed}/{index}")
    target = rng.choices(targets, [target.share for target in targets])[0]
    return target, rng, target.make(rng)


def tried(targets: tuple[Target, ...], seed: int, index: int, room: Path) -> str:
    """Try one input; return what came of it, "FAILED ..." if that is not allowed."""
    target, rng, files = trial(targets, seed, index)
    return f"{target.name}: {answered(target, rng, files, room)}"


def answered(target: Target, rng: Random, files: Files, room: Path) -> str:
    """Hand an input to its target, in a folder `room` of its own, and look at what came."""
    given, out = room / "in", room / "a" / "b" / "out"
    given.mkdir(parents=True, exist_ok=True)
    out.mkdir(parents=True, exist_ok=True)
    paths = [given / name for name in files]
    for path, data in zip(paths, files.values(), strict=True):
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(data)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            outcome = target.answer(paths[0], out, rng)
        made = {p for p in room.parent.rglob("*") if not p.is_dir()} - {*paths}
        strays = [p.name for p in made if out not in p.parents or p.name.startswith(".")]
        if strays:
            outcome = f"FAILED left {strays}"
    except BladegenError as error:
        outcome = type(error).__name__
        if len(str(error)) > 20_000:
            outcome = f"FAILED {outcome} of {len(str(error))} characters"
    except Exception as error:
        frames = traceback.extract_tb(error.__traceback__)
        ours = [f for f in frames if "bladegen/" in f.filename.replace(os.sep, "/")] or frames
        place = f"{Path(ours[-1].filename).name}:{ours[-1].lineno}"
        outcome = f"FAILED {type(error).__name__} at {place}: {str(error)[:160]}"
    for left in [p for p in room.parent.rglob("*") if not p.is_dir()]:
        left.unlink()
    return outcome


def fuzz(
    targets: tuple[Target, ...],
    *,
    seed: int,
    count: int,
    first: int = 0,
    seconds: float = math.inf,
    patience: float = PATIENCE,
    memory: int = MEMORY,
    told: Callable[[Tally], None] = lambda _: None,
) -> Tally:
    """Try inputs `first` to `first + count`, or as many as the seconds allow."""
    tally, start, index = Tally(), time.monotonic(), first
    last = first + count
    context = multiprocessing.get_context("spawn")
    while index < last and time.monotonic() - start < seconds:
        ours, theirs = context.Pipe()
        process = context.Process(
            target=_work, args=(theirs, targets, seed, index, last, memory), daemon=True
        )
        process.start()
        theirs.close()
        index = _heard(ours, index, patience, start + seconds, tally, told)
        process.kill()
        process.join()
    tally.seconds = time.monotonic() - start
    return tally


def _heard(
    worker: Connection, index: int, patience: float, end: float, tally: Tally, told: Any
) -> int:
    """Listen to a worker until it is done, silent or dead; return the next input's index."""
    limit = patience + 60.0  # a worker first imports
    while time.monotonic() < end:
        try:
            if not worker.poll(limit):
                outcome, spent, peak = f"FAILED hung for {patience:g} s", patience, 0.0
                _note(tally, index, outcome, spent, peak)
                return index + 1
            message = worker.recv()
        except EOFError:
            _note(tally, index, "FAILED the process died", 0.0, 0.0)
            return index + 1
        if message is None:
            return index
        limit = patience
        _note(tally, index, *message)
        index += 1
        told(tally)
    return index


def _note(tally: Tally, index: int, outcome: str, spent: float, peak: float) -> None:
    tally.inputs += 1
    tally.outcomes[outcome.split(" at ", maxsplit=1)[0] if "FAILED" in outcome else outcome] += 1
    if "FAILED" in outcome:
        tally.failures.append((index, outcome))
    tally.slowest = max(tally.slowest, (spent, index))
    tally.memory = max(tally.memory, peak)


def _work(
    parent: Connection, targets: tuple[Target, ...], seed: int, first: int, last: int, memory: int
) -> None:
    """Try inputs and tell the parent of each."""
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    limit = pages * resource.getpagesize() + memory
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    memory_disk = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(prefix="fuzz-", dir=memory_disk) as folder:
        room = Path(folder) / "room"
        for index in range(first, last):
            start = time.perf_counter()
            outcome = tried(targets, seed, index, room)
            spent = time.perf_counter() - start
            peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
            parent.send((outcome, spent, peak))
    parent.send(None)


# ---- blades -----------------------------------------------------------------------------------


@cache
def documents() -> tuple[Any, ...]:
    """The bundled blades, whole and with fewer points, as windIO 2 and 1."""
    found = []
    for name in bg.bundled():
        whole, _ = parse_yaml(Path(bg.read(name).source).read_bytes())
        small = thinned(whole)
        found += [*[small] * 5, *[windio1(small)] * 3, whole]
    return tuple(found)


def thinned(document: Any) -> Any:
    """Return a blade's document with the airfoils it uses, of some 25 points each."""
    shape = document["components"]["blade"]["outer_shape"]
    used = {item["name"] for item in shape["airfoils"]}
    library = []
    for airfoil in document["airfoils"]:
        if airfoil["name"] in used:
            xy = [airfoil["coordinates"][key] for key in ("x", "y")]
            step = max(1, len(xy[0]) // 24)
            kept = [[*values[:-1:step], values[-1]] for values in xy]
            library.append(airfoil | {"coordinates": {"x": kept[0], "y": kept[1]}})
    return document | {"airfoils": library}


def windio1(document: Any) -> Any:
    """Return the same blade in windIO 1's layout, near enough for a start."""
    blade = document["components"]["blade"]
    shape = dict(blade["outer_shape"])
    items, twist = shape.pop("airfoils"), shape["twist"]
    shape.pop("section_offset_y", None)
    placed = all("spanwise_position" in item for item in items)
    etas = [item["spanwise_position"] for item in items] if placed else None
    shape |= {
        "airfoil_position": {
            "grid": etas or np.linspace(0.0, 1.0, len(items)).tolist(),
            "labels": [item["name"] for item in items],
        },
        "twist": {"grid": twist["grid"], "values": np.radians(twist["values"]).tolist()},
        "pitch_axis": {"grid": [0.0, 1.0], "values": [0.5, 0.3]},
        "reference_axis": blade["reference_axis"],
    }
    library = [
        {"relative_thickness" if k == "rthick" else k: v for k, v in airfoil.items()}
        for airfoil in document["airfoils"]
    ]
    return {
        "windIO_version": "1.0",
        "name": document.get("name"),
        "components": {"blade": {"outer_shape_bem": shape}},
        "airfoils": library,
    }


@cache
def texts() -> tuple[bytes, ...]:
    """Blade files as people lay them out: the head of a bundled one, and small ones whole."""
    small = [mutators.written(document).encode() for document in documents()[::9]]
    spaced = [text.replace(b"}, ", b"},\n  ").replace(b"], ", b"],\n    ") for text in small]
    return (*spaced, *small, Path(bg.read("nrel5mw").source).read_bytes())


def changed_blade(rng: Random) -> Files:
    """A blade's document with a few places changed."""
    changed = mutators.document(rng, rng.choice(documents()))
    return {_file_name(rng, ".yaml"): mutators.written(changed).encode("utf-8", "replace")}


def changed_text(rng: Random) -> Files:
    """A blade's file with a few bytes changed."""
    return {_file_name(rng, ".yaml"): mutators.text(rng, rng.choice(texts()), rng.choice(texts()))}


def _file_name(rng: Random, suffix: str) -> str:
    odd = rng.choice(mutators.NAMES).replace("/", "_").replace("\0", "")
    return (odd[:50] if rng.random() < 0.1 else "blade") + suffix


def answer_blade(path: Path, out: Path, rng: Random) -> str:
    """Read a file, make its blade and sections, and now and then its files."""
    definition = bg.read(path)
    if rng.random() < 0.2:
        definition = replace(definition, name=rng.choice(mutators.NAMES))
    blade = bg.Blade.from_definition(
        definition,
        landmarks=rng.choice((5, 7, 11, 21, 41)),
        path=rng.choice(("geodesic", "spline")),
        planes=rng.choice((flange_to_axis, normal_to_axis, normal_to_z)),
        trailing_edge=rng.choice((AsGiven(), MinimumThickness(), Sharp())),
    )
    finite(blade.profiles(SPANS), blade.sections(SPANS))
    chance = rng.random()
    if chance < BUILT:
        from bladegen.exports.build import build

        build(blade, out, formats=["stl"], options=Options(stations=len(blade.eta) + 9))
        for file in out.glob("*.json"):
            json.loads(file.read_text(), parse_constant=_no_constant)
        return "built"
    if chance < BUILT + EXPORTED:
        file = out / f"{safe_stem(blade.name)}.stl"
        bg.export(blade, file, stations=len(blade.eta) + 9)
        facets = np.frombuffer(file.read_bytes()[84:], dtype=np.dtype("<12f4, <u2"))
        finite(facets["f0"])
        return "meshed"
    return "blade"


def finite(*arrays: np.ndarray) -> None:
    """Raise unless all numbers are finite."""
    for values in arrays:
        if not np.isfinite(values).all():
            raise ArithmeticError("a result holds NaN or infinity")


def _no_constant(text: str) -> float:
    raise ArithmeticError(f"a report holds {text}")


# ---- other formats of blades -------------------------------------------------------------------


def sparse(value: Any) -> Any:
    """Return a document with some ten entries in each of its longer tables over span."""
    if isinstance(value, list):
        return (
            [sparse(member) for member in value] if value and isinstance(value[0], dict) else value
        )
    if not isinstance(value, dict):
        return value
    if isinstance(value.get("grid"), list) and isinstance(value.get("values"), list):
        step = max(1, len(value["grid"]) // 10)
        return {k: [*v[:-1:step], v[-1]] for k, v in value.items() if isinstance(v, list)}
    return {key: sparse(member) for key, member in value.items()}


@cache
def converted(form: str, suffix: str) -> tuple[Files, ...]:
    """The NREL 5 MW in another format: its files by name, the main one first."""
    found = []
    for document in documents()[18:19]:
        with tempfile.TemporaryDirectory() as folder:
            source, target = Path(folder) / "small.yaml", Path(folder) / "made" / f"blade{suffix}"
            source.write_text(mutators.written(sparse(document)), encoding="utf-8")
            target.parent.mkdir()
            writing.write(bg.read(source), target, format=form)
            others = sorted(p for p in target.parent.rglob("*") if p.is_file() and p != target)
            found.append(
                {str(p.relative_to(target.parent)): p.read_bytes() for p in (target, *others)}
            )
    return tuple(found)


def changed_files(form: str, suffix: str, rng: Random) -> Files:
    """A blade in another format, with one or two of its files changed or left out."""
    files = dict(rng.choice(converted(form, suffix)))
    names, first = list(files), next(iter(files.values()))
    for _ in range(rng.choice((1, 1, 2))):
        name = names[0] if rng.random() < 0.7 else rng.choice(names)
        other = rng.choice(list(files.values()))
        if name.endswith(".xlsx") and files[name] is first and rng.random() < 0.85:
            files[name] = mutators.packed(rng, files[name])
        elif rng.random() < 0.05 and name != names[0]:
            del files[name]
            names.remove(name)
        elif rng.random() < 0.6:
            files[name] = mutators.words(rng, files[name])
        else:
            files[name] = mutators.text(rng, files[name], other)
    return files


def answer_other(path: Path, out: Path, rng: Random) -> str:
    """Read and use a blade of any format, and now and then write it in another."""
    outcome = answer_blade(path, out, rng)
    if rng.random() < 0.1:
        row = rng.choice(writing.FORMATS)
        writing.write(bg.read(path), out / f"again{row.suffixes[0]}", format=row.name)
        return "converted"
    return outcome


# ---- polars in files of OpenFAST and HAWC2, and models that lead to a blade ---------------------

PLATE = np.radians(np.arange(-180.0, 181.0, 30.0))


def flown(definition: bg.BladeDefinition) -> bg.BladeDefinition:
    """A blade whose airfoils have polars, at two Reynolds numbers."""
    lift, drag = np.sin(2.0 * PLATE), 0.01 + np.sin(PLATE) ** 2
    polars = tuple(Polar(PLATE, re / 1e6 * lift, drag, -lift, re) for re in (1e6, 3e6))
    made = {
        station.airfoil.name: replace(station.airfoil, polars=polars)
        for station in definition.stations
    }
    stations = tuple(replace(s, airfoil=made[s.airfoil.name]) for s in definition.stations)
    return replace(definition, stations=stations)


def plain(definition: bg.BladeDefinition) -> bg.BladeDefinition:
    """A blade of one airfoil, which OpenFAST holds in a few files."""
    tip = definition.stations[-1].airfoil
    stations = tuple(replace(station, airfoil=tip) for station in definition.stations)
    return replace(definition, stations=stations, relative_thickness=None)


@cache
def flown_files(suffix: str) -> Files:
    """The NREL 5 MW with polars: its files by name, the main one first."""
    with tempfile.TemporaryDirectory() as folder:
        source, room = Path(folder) / "small.yaml", Path(folder) / "made"
        source.write_text(mutators.written(sparse(documents()[18])), encoding="utf-8")
        (room / "shared").mkdir(parents=True)
        target = room / "shared" / f"blade{'.dat' if suffix == '.fst' else suffix}"
        blade = flown(bg.read(source))
        writing.write(blade if suffix == ".htc" else plain(blade), target)
        if suffix == ".fst":
            target = _model(room)
        others = sorted(p for p in room.rglob("*") if p.is_file() and p != target)
        return {str(p.relative_to(room)): p.read_bytes() for p in (target, *others)}


def _model(room: Path) -> Path:
    """Write a turbine's files beside the folder of a blade's; return the .fst file."""
    part = (room / "shared" / "blade_AeroDyn_part.dat").read_text()
    (room / "land").mkdir()
    (room / "land" / "AeroDyn.dat").write_text(part.replace('"blade', '"../shared/blade'))
    facts = "3 NumBl\n63 TipRad\n1.5 HubRad\n-2.5 PreCone(1)\n-5 ShftTilt\n"
    (room / "land" / "ElastoDyn.dat").write_text(facts)
    target = room / "land" / "turbine.fst"
    target.write_text('2 CompAero\n"ElastoDyn.dat" EDFile\n"AeroDyn.dat" AeroFile\n')
    return target


def changed_model(suffix: str, few: tuple[str, ...], rng: Random) -> Files:
    """A blade with polars, with one to three of its files changed: most often of a few names."""
    files = dict(flown_files(suffix))
    names = [name for name in files if name.endswith(few)]
    for _ in range(rng.choice((1, 2, 3))):
        name = rng.choice(names if rng.random() < 0.8 else list(files))
        if rng.random() < 0.05 and name != next(iter(files)):
            files[name] = b""
        elif rng.random() < 0.6:
            files[name] = mutators.words(rng, files[name])
        else:
            files[name] = mutators.text(rng, files[name], rng.choice(list(files.values())))
    return files


# ---- airfoil files ----------------------------------------------------------------------------


@cache
def airfoils() -> tuple[np.ndarray, ...]:
    """Airfoils of published files and others."""
    own = tuple(naca(t, c, gap, m) for t, c, gap, m in ((0.12, 0.0, 0, 20), (0.3, 0.04, 0.01, 60)))
    return (*own, *baselines().values())


def changed_airfoil(rng: Random) -> Files:
    """An airfoil file with some points or bytes changed, or both."""
    xy = rng.choice(airfoils())
    with np.errstate(all="ignore"):
        for _ in range(rng.randrange(4)):
            xy = mutators.points(rng, xy)
    data = mutators.airfoil_text(rng, xy)
    if rng.random() < 0.4:
        data = mutators.text(rng, data, b"1.0 0.0\n0.0 0.0\n")
    return {_file_name(rng, rng.choice((".dat", ".txt", ".csv"))): data}


def answer_airfoil(path: Path, out: Path, rng: Random) -> str:
    """Read an airfoil file, put landmarks on it, and now and then learn a space with it."""
    n = rng.choice((5, 21, 51))
    placed = landmarks(read_airfoil(path), n)
    finite(placed)
    if rng.random() < 0.1:
        others = dict(zip("abc", airfoils(), strict=False))
        found = others | {path.stem: read_airfoil(path)}
        space, _ = database.build_space(found, count=rng.choice((0, 3)), modes=2, n=51, seed=1)
        finite(space.mean, space.modes, space.variances, space.coordinates)
        space.save(out / "space.npz")
        return "space"
    return "airfoil"


# ---- saved spaces -----------------------------------------------------------------------------


@cache
def space() -> bg.ShapeSpace:
    """A small space."""
    coefficients = np.stack([cst.fit(landmarks(xy, 51))[0] for xy in airfoils()[:6]])
    drawn = cst.perturbations(coefficients, 4, np.random.default_rng(3))
    return bg.ShapeSpace.fit(cst.standardised_shapes(drawn, 21), modes=3, about="fuzz")


@cache
def blade_of_space() -> bg.Blade:
    return bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=21)


def changed_space(rng: Random) -> Files:
    """A saved space with bytes changed, or arrays changed under a checksum that is right."""
    arrays = {name: np.array(getattr(space(), name)) for name in ARRAYS}
    about = rng.choice(("fuzz", *mutators.NAMES)).replace("\0", "")
    chance = rng.random()
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        if chance < 0.65:
            for name in rng.sample(ARRAYS, rng.randrange(1, 3)):
                arrays[name] = mutators.array(rng, arrays[name])
        labels: dict[str, Any] = {"version": archive.VERSION, "about": about}
        labels["checksum"] = archive.checksum(arrays, about)
    if 0.6 < chance < 0.7:
        changed = rng.choice(sorted(labels))
        labels[changed] = rng.choice((*mutators.NUMBERS[:9], *mutators.NAMES, [1], [[2.0]]))
    if 0.7 < chance < 0.75:
        del arrays[rng.choice(ARRAYS)]
    data = mutators.zipped({k: np.array(v) for k, v in (labels | arrays).items()})
    if chance > 0.75:
        data = mutators.text(rng, data, data[-400:])
    return {_file_name(rng, ".npz"): data}


def answer_space(path: Path, out: Path, rng: Random) -> str:
    """Load a space, use it in every way, and save it."""
    loaded = bg.ShapeSpace.load(path)
    t = loaded.sample(3, np.random.default_rng(1))
    finite(t, loaded.decode(t), loaded.variance_ratio, loaded.lower, loaded.upper)
    finite(loaded.encode(loaded.decode(t)), loaded.extent)
    loaded.save(out / "again.npz")
    if rng.random() < 0.1:
        coordinates = np.clip(0.3 * t[0], loaded.lower, loaded.upper)
        blade = blade_of_space().perturbed(loaded, coordinates)
        finite(blade.sections(SPANS))
        return "perturbed"
    return "space"


ARRAYS = ("u", "mean", "modes", "variances", "coordinates")
TARGETS = (
    Target("blade document", changed_blade, answer_blade, 5),
    Target("blade text", changed_text, answer_blade, 2),
    Target("OpenFAST", partial(changed_files, "openfast", ".dat"), answer_other, 1),
    Target("HAWC2", partial(changed_files, "hawc2", ".htc"), answer_other, 1),
    Target("table", partial(changed_files, "csv", ".csv"), answer_other, 1),
    Target("workbook", partial(changed_files, "xlsx", ".xlsx"), answer_other, 1),
    Target(
        "AeroDyn airfoils",
        partial(changed_model, ".dat", ("blade.dat", "_AF001.dat", "_part.dat")),
        answer_other,
    ),
    Target(
        "turbine .fst",
        partial(changed_model, ".fst", (".fst", "AeroDyn.dat", "ElastoDyn.dat")),
        answer_other,
    ),
    Target(
        "HAWC2 pc", partial(changed_model, ".htc", (".htc", "_pc.dat", "_ae.dat")), answer_other
    ),
    Target("airfoil file", changed_airfoil, answer_airfoil, 4),
    Target("saved space", changed_space, answer_space, 3),
)
