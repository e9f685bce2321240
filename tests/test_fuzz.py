"""Bad input ends in a result or in a `BladegenError`: two thousand at random, and named ones."""

import copy
import os
import time
from pathlib import Path
from random import Random
from typing import Any

import fuzzing
import mutators
import numpy as np
import pytest
from fuzzing import TARGETS, Target, answered, documents, fuzz, space
from hypothesis import given, settings
from hypothesis import strategies as st

import bladegen as bg
from bladegen.errors import BladegenError
from bladegen.support import archive
from strategies import few, naca


@pytest.mark.parametrize("count", [40, pytest.param(2000, marks=pytest.mark.nightly)])
def test_bad_inputs_end_well(count):
    tally = fuzz(TARGETS, seed=2026, count=count)
    assert tally.failures == []
    assert tally.inputs == count
    if count >= 2000:  # enough of each target for shares
        for target in TARGETS:
            outcomes = {k: n for k, n in tally.outcomes.items() if k.startswith(target.name)}
            errors = sum(n for k, n in outcomes.items() if k.endswith("Error"))
            assert errors > 0.2 * sum(outcomes.values())  # bad enough
            assert errors < 0.95 * sum(outcomes.values())  # and good enough to get inside


@settings(max_examples=few(15))
@given(st.sampled_from(TARGETS), st.randoms(use_true_random=False))
def test_hypothesis_finds_nothing_either(tmp_path_factory, target, rng):
    room = tmp_path_factory.getbasetemp() / "fuzz" / "room"
    assert "FAILED" not in answered(target, rng, target.make(rng), room)


# ---- the watchdog sees what it should -----------------------------------------------------------


def _one(_: Random) -> dict[str, bytes]:
    return {"a.txt": b"a"}


def _hang(*_: Any) -> str:
    while True:
        time.sleep(1.0)


def _die(*_: Any) -> str:
    os._exit(3)


def _hunger(*_: Any) -> str:
    return str(len(bytearray(2**40)))


def _raise(*_: Any) -> str:
    return mutators.NAMES[999]


def _nan(*_: Any) -> str:
    fuzzing.finite(np.array([0.0, np.nan]))
    return "never"


def _stray(_: Path, out: Path, __: Random) -> str:
    (out.parent / "stray").write_text("")
    return "never"


def _half(_: Path, out: Path, __: Random) -> str:
    (out / ".half.stl").write_text("")
    return "never"


def _warn(*_: Any) -> str:
    return str(np.float64(1e308) * np.float64(10.0))


def _refuse(*_: Any) -> str:
    raise BladegenError("no")


def _babble(*_: Any) -> str:
    raise BladegenError("no" * 50_000)


def _well(*_: Any) -> str:
    return "well"


@pytest.mark.parametrize(
    ("answer", "outcome"),
    [
        (_hunger, "FAILED MemoryError"),
        (_raise, "FAILED IndexError"),
        (_nan, "FAILED ArithmeticError"),
        (_stray, "FAILED left ['stray']"),
        (_half, "FAILED left ['.half.stl']"),
        (_warn, "FAILED RuntimeWarning"),
        (_babble, "FAILED BladegenError of 100000 characters"),
        (_refuse, "BladegenError"),
        (_well, "well"),
    ],
)
def test_what_an_input_does_is_seen(answer, outcome, tmp_path):
    target = Target("t", _one, answer)
    assert answered(target, Random(1), {"a.txt": b"a"}, tmp_path / "room").startswith(outcome)
    assert (
        answered(Target("t", _one, _well), Random(1), {"a.txt": b"a"}, tmp_path / "room") == "well"
    )


def test_a_hang_and_a_crash_are_survived():
    targets = tuple(Target(f.__name__, _one, f) for f in (_hang, _die, _well, _hunger))
    tally = fuzz(targets, seed=35, count=6, patience=1.0)
    kinds = [fuzzing.trial(targets, 35, index)[0].name for index in range(6)]
    assert {"_hang", "_die", "_well", "_hunger"} == set(kinds)
    assert tally.inputs == 6
    said = {"_hang": "hung", "_die": "died", "_hunger": "MemoryError"}
    assert [index for index, _ in tally.failures] == [i for i, k in enumerate(kinds) if k in said]
    for index, outcome in tally.failures:
        assert said[kinds[index]] in outcome


def test_an_input_is_found_again():
    one, two = (fuzzing.trial(TARGETS, 3, 17)[2] for _ in range(2))
    assert one == two
    assert one != fuzzing.trial(TARGETS, 3, 18)[2]


# ---- cases with a name ---------------------------------------------------------------------------

SHAPE = ("components", "blade", "outer_shape")


def changed(*changes: tuple[tuple[Any, ...], Any]) -> bytes:
    """The NREL 5 MW with places set to other values."""
    document = copy.deepcopy(next(d for d in documents() if d["name"] == "NREL 5 MW"))
    for place, value in changes:
        holder = document
        for key in place[:-1]:
            holder = holder[key]
        holder[place[-1]] = value
    return mutators.written(document).encode()


def contour(*, x: Any = None, y: Any = None, number: int = -1) -> bytes:
    """The same with other coordinates of one of its airfoils."""
    document = next(d for d in documents() if d["name"] == "NREL 5 MW")
    xy = {key: list(document["airfoils"][number]["coordinates"][key]) for key in "xy"}
    xy |= {key: value(xy[key]) for key, value in (("x", x), ("y", y)) if value is not None}
    return changed((("airfoils", number, "coordinates"), xy))


def dented(values: list[float]) -> list[float]:
    """Push one point of the upper side through the lower one."""
    return [*values[:5], -0.5, *values[6:]]


def bomb() -> bytes:
    lines = ["a: &a [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]"]
    for one, two in zip("abcdefghijklmno", "bcdefghijklmnop", strict=True):
        lines.append(f"{two}: &{two} [{', '.join([f'*{one}'] * 9)}]")
    return "\n".join(lines).encode()


def exploded() -> bytes:
    """The same bomb where a list of numbers is expected."""
    head = bomb().replace(b"\n", b"\n  ")
    return (
        b"bomb:\n  "
        + head
        + b"\n"
        + b"components: {blade: {outer_shape: {chord: {grid: *p, values: *p}}}}"
    )


GRID = [0.0, 0.5, 1.0]
CHORD, TWIST = (*SHAPE, "chord"), (*SHAPE, "twist")
NAN = float("nan")
MANY = 100_000
BLADES = {
    "yaml bomb": (bomb(), "holds no blade"),
    "yaml bomb for numbers": (exploded(), "chord"),
    "brackets": (b"[" * 1_000_000, "nest"),
    "python object": (b"!!python/object/apply:os.system ['touch x']", "tag"),
    "too many points": (
        contour(x=lambda _: "MANY").replace(b'"MANY"', b"[" + b"0.5, " * MANY + b"1.0]"),
        "has 100001 entries, allowed are 1 to 100000",
    ),
    "99,999 points": (
        contour(
            x=lambda x: (0.5 + 0.5 * np.cos(np.linspace(0, 2 * np.pi, 99_999))).tolist(),
            y=lambda y: (0.1 * np.sin(np.linspace(0, 2 * np.pi, 99_999))).tolist(),
        ),
        "points that differ, allowed are 3 to 5000",
    ),
    "nan chord": (
        changed((CHORD, {"grid": GRID, "values": [4.0, NAN, 1.0]})),
        "values[1]: got nan",
    ),
    "infinite twist": (
        changed((TWIST, {"grid": GRID, "values": [4.0, float("inf"), 1.0]})),
        "values[1]: got inf",
    ),
    "nan in a contour": (contour(y=lambda y: [y[0], NAN, *y[2:]]), "y[1]: got nan"),
    "reversed grid": (
        changed((CHORD, {"grid": GRID[::-1], "values": [4.0, 3.0, 1.0]})),
        "must increase",
    ),
    "repeated grid": (
        changed((CHORD, {"grid": [0.0, 0.5, 0.5, 1.0], "values": [4.0, 3.0, 2.0, 1.0]})),
        "must increase",
    ),
    "nearly repeated grid": (
        changed((CHORD, {"grid": [0.0, 0.5, 0.5 + 1e-15, 1.0], "values": [4.0, 3.0, 2.0, 1.0]})),
        "must increase",
    ),
    "crossing airfoil": (contour(y=dented), "crosses itself"),
    "flat airfoil": (contour(y=lambda y: [0.0] * len(y)), "thick"),
    "zero chord": (changed((CHORD, {"grid": GRID, "values": [4.0, 0.0, 1.0]})), "1e-06 to 100 m"),
    "airfoil of zero chord": (contour(x=lambda x: [1.0] * len(x)), "x spans 0"),
    "empty": (b"", "is empty"),
    "nothing but a name": (b"name: x", "holds no blade"),
    "binary": (bytes(range(256)) * 40, "is no YAML"),
}


@pytest.mark.parametrize("name", BLADES)
def test_bad_blades_are_refused_in_a_line(name, tmp_path):
    content, said = BLADES[name]
    path = tmp_path / "blade.yaml"
    path.write_bytes(content)
    with pytest.raises(BladegenError, match=r"blade\.yaml") as refusal:
        bg.read(path)
    assert said in str(refusal.value)
    assert len(str(refusal.value)) < 2_000


@pytest.mark.parametrize("name", mutators.NAMES)
def test_names_stay_inside_their_folder(name, tmp_path):
    content = changed(
        (("name",), name), (("airfoils", 2, "name"), name), ((*SHAPE, "airfoils", 2, "name"), name)
    )

    class Chooser(Random):
        """Draws that give the blade this name and have it written as a mesh."""

        def random(self) -> float:
            return fuzzing.BUILT + 0.5 * fuzzing.EXPORTED

        def choice(self, options: Any) -> Any:
            return name if options is mutators.NAMES else options[0]

    target, rng = Target("named", _one, fuzzing.answer_blade), Chooser(1)
    outcome = answered(target, rng, {"blade.yaml": content}, tmp_path / "room")
    assert outcome in {"meshed", "FileError"}


FOIL = naca(0.18, 0.02, 0.0, 30)


def rows(points: np.ndarray) -> bytes:
    return mutators.airfoil_text(Random(3), points)


AIRFOILS = {
    "too many points": (b"1.0 0.0\n" * 120_000, "points, allowed are 10 to 5000"),
    "too large a file": (b"1.0 0.0\n" * 2 * MANY, "is larger than 1000000 bytes"),
    "nan": (b"foil\n" + b"1 0\n" * 9 + b"nan nan\n1 0\n", "must be finite"),
    "infinity": (b"foil\n" + b"1 0\n" * 9 + b"inf 0\n1 0\n", "must be finite"),
    "crossing": (rows(np.where(np.arange(59)[:, None] == 12, [0.7, -0.5], FOIL)), "crosses itself"),
    "zero chord": (rows(FOIL * [0.0, 1.0]), "x spans 0, allowed is 0.001 to 100000"),
    "huge": (rows(FOIL * 1e30), "x spans 1e+30"),
    "too high": (rows(FOIL * [1.0, 1e6]), "times the chord"),
    "nothing": (b"", "0 points"),
    "prose": (b"These are not the numbers you are looking for.\n" * 20, "0 points"),
    "binary": (bytes(range(256)) * 40, "points"),
}


@pytest.mark.parametrize("name", AIRFOILS)
def test_bad_airfoil_files_are_refused_in_a_line(name, tmp_path):
    from bladegen.formats.airfoils.reading import read_airfoil

    content, said = AIRFOILS[name]
    path = tmp_path / "foil.dat"
    path.write_bytes(content)
    with pytest.raises(BladegenError, match=r"foil\.dat") as refusal:
        read_airfoil(path)
    assert said in str(refusal.value)


def saved(path: Path, **arrays: Any) -> None:
    """Save the small space with some arrays changed, under a checksum that is right."""
    held = {name: getattr(space(), name) for name in fuzzing.ARRAYS} | arrays
    archive.save_arrays(path, held, "changed")


SPACES = {
    "nan": ({"mean": np.full((21, 2), NAN)}, "mean must be finite"),
    "infinity": ({"variances": np.full(24, np.inf)}, "variances must be finite"),
    "text": ({"mean": np.full((21, 2), "../../x")}, "mean must be finite"),
    "integers": ({"u": np.arange(21)}, "u must be finite numbers in double precision"),
    "transposed": ({"mean": np.zeros((2, 21))}, "mean has the shape (2, 21), must be (21, 2)"),
    "a number": ({"modes": np.zeros(())}, "modes has the shape"),
    "empty": ({"coordinates": np.zeros((0, 3))}, "too few"),
    "not orthonormal": ({"mean": np.ones((21, 2))}, "mean must be an orthonormal basis"),
    "long modes": ({"modes": 1.5 * np.ones((3, 21, 2))}, "modes must be orthonormal"),
    "huge": ({"modes": np.full((3, 21, 2), 1e300)}, "modes must be orthonormal"),
    "no spread": ({"variances": np.zeros(24)}, "variances of its modes"),
    "rising": ({"variances": np.linspace(0.1, 0.2, 24)}, "variances must fall"),
    "far": ({"coordinates": np.full((5, 3), 9.0)}, "coordinates must lie within"),
    "u reversed": ({"u": np.linspace(1.0, 0.0, 21)}, "u must increase"),
}


@pytest.mark.parametrize("name", SPACES)
def test_spaces_whose_arrays_are_none_are_refused(name, tmp_path):
    arrays, said = SPACES[name]
    saved(tmp_path / "space.npz", **arrays)
    with pytest.raises(BladegenError, match=r"space\.npz: is no shape space") as refusal:
        bg.ShapeSpace.load(tmp_path / "space.npz")
    assert said in str(refusal.value)


def test_modes_must_be_tangent_at_the_mean(tmp_path):
    modes = np.array(space().modes)
    modes[0] = space().mean / np.sqrt(2.0)
    saved(tmp_path / "space.npz", modes=np.linalg.qr(modes.reshape(3, -1).T).Q.T.reshape(3, -1, 2))
    with pytest.raises(BladegenError, match="tangent at the mean"):
        bg.ShapeSpace.load(tmp_path / "space.npz")


def test_a_space_that_is_saved_is_loaded(tmp_path):
    saved(tmp_path / "space.npz")
    assert bg.ShapeSpace.load(tmp_path / "space.npz").dimension == 3


def test_a_zip_bomb_is_refused(tmp_path, monkeypatch):
    path = tmp_path / "space.npz"
    saved(path, coordinates=np.zeros((1_000_000, 3)))
    assert path.stat().st_size < 100_000
    monkeypatch.setattr(archive, "MAX_BYTES", 2**20)
    with pytest.raises(BladegenError, match="unpacks to more than 1 MB"):
        bg.ShapeSpace.load(path)


@pytest.mark.parametrize(
    "data",
    [b"", b"PK\x03\x04", b"\x93NUMPY\x01\x00", b"\x80\x04K\x01.", bytes(range(256)) * 9],
    ids=["empty", "zip", "npy", "pickle", "binary"],
)
def test_what_is_no_archive_is_refused(data, tmp_path):
    (tmp_path / "space.npz").write_bytes(data)
    with pytest.raises(BladegenError, match="is no shape space"):
        bg.ShapeSpace.load(tmp_path / "space.npz")
