"""Good input made bad: documents, texts, bytes, airfoils and arrays, changed at random.

Each function takes a `random.Random` and something good and returns something that may be good,
odd or broken.  Hypothesis' own `Random` serves as well, and shrinks what it finds.
"""

import copy
import io
import json
import math
import re
import zipfile
from collections.abc import Callable, Iterator
from random import Random
from typing import Any

import numpy as np

NAMES = (
    "", " ", ".", "..", "../../x", "/etc/x", "a/b", "a\\b", "..\\..\\x", "-rf", "x\0y", "\n", "é",
    "翼型", "🌀", "\u202egnp.x", "name " * 60, "CON", "%s%n", "$(touch x)", "'; --", "null", "1e5",
)  # fmt: skip
NUMBERS = (
    0.0, -0.0, 1.0, -1.0, 0.5, 2.0, 1e-9, -1e-9, 1e-17, 5e-324, 1e308, -1e308, 1e22, math.nan,
    math.inf, -math.inf, 2**53, -(2**63), 10**30, 10**400, 1e-3, 1e3, 89.999999, 90.0, 1.0000001,
)  # fmt: skip
ODD: tuple[Any, ...] = (
    None, True, False, [], {}, [[]], [None], [1.0], [[1.0, 2.0]], {"grid": [0, 1]}, [0.0, 1.0],
    {"grid": [0.0, 1.0], "values": [1.0, 1.0]}, "circle", "0.5", "nan", "5e-05", "0x10", "1_000",
)  # fmt: skip
TOKENS = (
    b"[", b"]", b"{", b"}", b":", b"- ", b"&a ", b"*a", b"!!python/object:os.system ", b"<<: *a",
    b"|", b">", b"?", b"'", b'"', b"#", b"%YAML 1.1\n", b"---\n", b"...\n", b"\t", b"\0", b"\xff",
    b"\xef\xbb\xbf", b"\r\n", b"\n", b".nan", b".inf", b"1e999", b"-", b"+", b",", b"~", b"null",
    b"[" * 200, b"{a: " * 80, b" " * 500, b"9" * 500, b"\xe2\x80\xa8", b"\xed\xa0\x80", b"@", b"`",
)  # fmt: skip


def written(value: Any) -> str:
    """Write a document as YAML in flow style, much faster than a YAML library."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{written(str(k))}: {written(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(written, value)) + "]"
    if isinstance(value, float) and not math.isfinite(value):
        return ".nan" if math.isnan(value) else ".inf" if value > 0 else "-.inf"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=not value.isprintable())
    return (
        repr(value)
        if isinstance(value, int | float) and not isinstance(value, bool)
        else (json.dumps(value))
    )


def document(rng: Random, good: Any) -> Any:
    """Change a few places of a document of dicts, lists, texts and numbers."""
    changed = copy.deepcopy(good)
    for _ in range(1 + int(3 * rng.random() ** 2)):
        change: Callable[[Random, Any], None] = rng.choice(
            (_anywhere, _anywhere, _distribution, _distribution, _airfoil, _airfoil)
        )
        change(rng, changed)
    return changed


def text(rng: Random, good: bytes, other: bytes = b"") -> bytes:
    """Change a few places of a text or of any bytes."""
    data = bytearray(good)
    for _ in range(1 + int(5 * rng.random() ** 2)):
        start = rng.randrange(len(data) + 1)
        length = int(40 * rng.random() ** 2) + 1
        kind = rng.randrange(9)
        if kind == 0:
            data[start : start + length] = b""
        elif kind == 1:
            data[start:start] = rng.choice(TOKENS)
        elif kind == 2:
            data[start : start + length] = rng.choice(TOKENS)
        elif kind == 3 and data:
            data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
        elif kind == 4:
            data[start:start] = data[start : start + 10 * length] * rng.randrange(1, 4)
        elif kind == 5:
            data[start : start + length] = repr(_number(rng)).encode()
        elif kind == 6:
            place = rng.randrange(len(other) + 1)
            data[start : start + length] = other[place : place + 10 * length]
        elif kind == 7 and rng.random() < 0.3:
            del data[start:]
        elif kind == 8:
            digits = [i for i in range(start, min(start + 200, len(data))) if 48 <= data[i] < 58]
            for i in digits[:1]:
                data[i] = rng.choice(b"0123456789.e-")
    return bytes(data)


def words(rng: Random, good: bytes) -> bytes:
    """Change a few words of a text: numbers become odd numbers, others names or numbers."""
    changed = bytearray(good)
    for _ in range(1 + int(3 * rng.random() ** 2)):
        found = list(re.finditer(rb"[^\s,;=]+", changed))
        if not found:
            break
        word = rng.choice(found)
        new = rng.choice(NAMES) if rng.random() < 0.2 else repr(_number(rng))
        changed[word.start() : word.end()] = new.encode("utf-8", "replace")
    return bytes(changed)


def packed(rng: Random, good: bytes) -> bytes:
    """Change a member of a zip file, packed again as it should be."""
    with zipfile.ZipFile(io.BytesIO(good)) as archive:
        members = {info.filename: archive.read(info) for info in archive.infolist()}
    name = rng.choice([n for n in members if "sheet" in n or rng.random() < 0.2] or [*members])
    if rng.random() < 0.05:
        del members[name]
    elif rng.random() < 0.6:
        found = list(re.finditer(rb"(?<=>)[^<>]+(?=<)", members[name]))
        if found:
            word, data = rng.choice(found), bytearray(members[name])
            new = rng.choice(NAMES) if rng.random() < 0.2 else repr(_number(rng))
            data[word.start() : word.end()] = new.encode("utf-8", "replace")
            members[name] = bytes(data)
    else:
        members[name] = text(rng, members[name], members[name])
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for key, value in members.items():
            archive.writestr(zipfile.ZipInfo(key), value)
    return stream.getvalue()


def points(rng: Random, good: np.ndarray) -> np.ndarray:
    """Change an airfoil's points (m, 2), sometimes past use."""
    xy = np.array(good, dtype=np.float64)
    m = len(xy)
    if not m:
        return xy
    i, j = sorted((rng.randrange(m), rng.randrange(m)))
    kind = rng.randrange(20)
    if kind == 0:  # crossing: a piece turned round, or mirrored
        xy[i:j] = xy[i:j][::-1]
    elif kind == 1:
        xy[i:j, 1] *= -1.0
    elif kind == 2:
        xy[:, rng.randrange(2)] *= rng.choice((0.0, 1e-12, 1e-6, 0.1, -1.0, 10.0, 1e200))
    elif kind == 3:  # repeated points
        xy = np.insert(xy, i, np.repeat(xy[i][None], rng.randrange(1, 5), axis=0), axis=0)
    elif kind == 4:
        xy[i] = [_number(rng, plain=True), _number(rng, plain=True)]
    elif kind == 5:  # the other way round, or begun elsewhere
        xy = xy[::-1] if rng.random() < 0.5 else np.roll(xy, i, axis=0)
    elif kind == 6:
        xy = np.delete(xy, slice(i, j), axis=0)
    elif kind == 7:
        xy = xy[:: max(1, m // rng.randrange(1, 12))]
    elif kind == 8:
        size = 10.0 ** rng.uniform(-12.0, 0.0)
        xy += size * np.array([[rng.uniform(-1, 1), rng.uniform(-1, 1)] for _ in range(m)])
    elif kind == 9:
        angle = rng.uniform(-math.pi, math.pi) * rng.choice((1.0, 0.1, 0.01))
        c, s = math.cos(angle), math.sin(angle)
        xy = xy @ np.array([[c, -s], [s, c]])
    elif kind == 10:  # a straight line, or one side alone
        xy[:, 1] = rng.choice((0.0, 1e-10)) * xy[:, 0]
    elif kind == 11:
        xy = xy[: m // 2 + 1]
    elif kind == 12:
        xy[:, 1] *= rng.uniform(0.0, 6.0)
    elif kind == 13:
        xy[:, 1] += rng.uniform(-1.0, 1.0) * xy[:, 0] * (1.0 - xy[:, 0]) * rng.choice((1, 5))
    elif kind == 14:  # close together
        xy[i:j] = xy[i] + 10.0 ** rng.uniform(-18.0, -3.0) * (xy[i:j] - xy[i])
    elif kind == 15:
        xy = np.round(xy, rng.randrange(4))
    elif kind == 16:
        xy = np.concatenate([xy, xy])
    elif kind == 17:
        xy += [rng.uniform(-2, 2), rng.uniform(-2, 2)]
    elif kind == 18:  # a blunt base, closed or open
        edge = rng.uniform(-0.2, 0.5)
        xy[:, 1] += np.sign(np.arange(m) - m / 2) * edge * xy[:, 0] * -0.5
        xy = np.concatenate([[[1.0, 0.0]], xy, [[1.0, 0.0]]]) if rng.random() < 0.5 else xy
    else:
        xy[i, rng.randrange(2)] += rng.choice((-1, 1)) * 10.0 ** rng.uniform(-8.0, 1.0)
    return xy


def array(rng: Random, good: np.ndarray) -> np.ndarray:
    """Change an array's values, shape or type."""
    changed = np.array(good)
    kind = rng.randrange(12)
    if kind == 0 and changed.size:
        changed.reshape(-1)[rng.randrange(changed.size)] = _number(rng, plain=True)
    elif kind == 1:
        changed = changed * rng.choice((0.0, -1.0, 1e-200, 1e200, math.nan, 1.0 + 1e-6))
    elif kind == 2:
        changed = changed[:-1] if changed.ndim and len(changed) else changed
    elif kind == 3:
        changed = changed[None] if rng.random() < 0.5 else changed.reshape(-1)
    elif kind == 4:
        changed = changed.astype(rng.choice(("f2", "f4", "i8", "c16", "U8", "?", ">f8", "S4")))
    elif kind == 5:
        changed = np.zeros(rng.choice(((), (0,), (0, 2), (3,), (1, 1, 1), (2, 0, 2))))
    elif kind == 6:
        changed = changed[::-1] if changed.ndim else changed
    elif kind == 7:
        changed = np.concatenate([changed, changed]) if changed.ndim else changed
    elif kind == 8:
        changed = np.moveaxis(changed, 0, -1) if changed.ndim else changed
    elif kind == 9:
        changed = np.full(changed.shape, rng.choice(NAMES))
    elif kind == 10 and changed.size:
        changed = changed + rng.choice((1e-12, 1e-6, 1e-2)) * np.cos(
            np.arange(changed.size)
        ).reshape(changed.shape)
    elif kind == 11:
        changed = np.full(changed.shape, _number(rng, plain=True))
    return changed


def _number(rng: Random, *, plain: bool = False) -> Any:
    number = rng.choice(NUMBERS) if rng.random() < 0.7 else rng.uniform(-2.0, 2.0)
    return float(min(number, 10**300)) if plain and isinstance(number, int) else number


def _value(rng: Random, now: Any) -> Any:
    """Return something that may stand for a value: alike but odd, or quite another thing."""
    if rng.random() < 0.5:
        if isinstance(now, bool | None):
            return rng.choice((True, 1, 0, "", None))
        if isinstance(now, int | float):
            if rng.random() < 0.5:
                near = now if isinstance(now, float) else min(max(now, -(10**300)), 10**300)
                return near * rng.choice((-1.0, 0.0, 0.5, 0.999, 1.001, 2.0, 10.0))
            return _number(rng)
        if isinstance(now, str):
            return rng.choice(NAMES)
    kind = rng.randrange(4)
    if kind == 0:
        return _number(rng)
    if kind == 1:
        return rng.choice(NAMES)
    if kind == 2:
        deep: Any = 0
        for _ in range(rng.choice((3, 70))):
            deep = [deep] if rng.random() < 0.5 else {"a": deep}
        return deep
    return copy.deepcopy(rng.choice(ODD))


def _anywhere(rng: Random, root: Any) -> None:
    """Change one place, found by walking down at random."""
    holder, key = root, None
    here = root
    while isinstance(here, dict | list) and here and (key is None or rng.random() < 0.85):
        holder = here
        key = rng.choice(list(here)) if isinstance(here, dict) else rng.randrange(len(here))
        here = holder[key]
    if key is None:
        return
    kind = rng.randrange(8)
    if kind == 0:
        del holder[key]
    elif kind == 1 and isinstance(holder, list):
        holder.insert(key, copy.deepcopy(here))
    elif kind == 2 and isinstance(holder, list):
        _list(rng, holder)
    elif kind == 3 and isinstance(holder, dict):
        holder[rng.choice((*NAMES, "Grid", str(key).upper()))] = holder.pop(key)
    elif kind == 4 and isinstance(here, list) and here:
        _list(rng, here)
    elif kind == 5 and isinstance(holder, dict):
        holder[key] = copy.deepcopy(rng.choice(list(holder.values())))
    else:
        holder[key] = _value(rng, here)


def _list(rng: Random, values: list[Any]) -> None:
    """Change a list as a whole."""
    kind = rng.randrange(9)
    numeric = all(isinstance(v, int | float) and not isinstance(v, bool) for v in values)
    if kind == 0:
        values.reverse()
    elif kind == 1:
        rng.shuffle(values)
    elif kind == 2:
        values[:] = values[: rng.randrange(len(values) + 1)]
    elif kind == 3:
        values.extend(copy.deepcopy(values))
    elif kind == 4 and values:
        values[:] = [copy.deepcopy(rng.choice(values)) for _ in values]
    elif kind == 5 and values:
        i = rng.randrange(len(values))
        values.insert(i, copy.deepcopy(values[i]))
    elif numeric:
        factor = rng.choice((-1.0, 0.0, 0.5, 2.0, 1e-12, 1e-3, 1e3, 1e200))
        shift = rng.choice((0.0, 0.0, 1.0, -1.0, 1e-7, 1e3))
        with np.errstate(over="ignore"):
            values[:] = (np.array(values, dtype=np.float64) * factor + shift).tolist()


def _distribution(rng: Random, root: Any) -> None:
    """Change a grid, its values, or both so that they still agree in length."""
    found = [d for d in _mappings(root) if isinstance(d.get("grid"), list) and "values" in d]
    if not found:
        return
    chosen = rng.choice(found)
    grid, values = chosen["grid"], chosen["values"]
    if not (isinstance(values, list) and len(grid) == len(values) and len(grid) > 1):
        return
    i = rng.randrange(len(grid))
    kind = rng.randrange(10)
    if kind == 0:
        grid.reverse()
    elif kind == 1:
        grid.insert(i, grid[i])
        values.insert(i, values[i] if rng.random() < 0.5 else _number(rng))
    elif kind == 2:
        grid[1:-1], values[1:-1] = [], []
    elif kind == 3:
        grid[i] = _number(rng)
    elif kind == 4:
        values[i] = _value(rng, values[i])
    elif kind == 5 and i:  # a step
        grid[i] = _nextafter(grid[i - 1])
    elif kind == 6 and all(isinstance(g, float) for g in grid):
        power = rng.choice((0.01, 0.1, 3.0, 30.0))
        grid[:] = [abs(g) ** power for g in grid]
    elif kind == 7:
        value = rng.choice((0.0, 1e-300, 1e-9, 1e-3, 1.0, 50.0, _number(rng)))
        values[:] = [value] * len(values)
    elif kind == 8:
        values[:] = [rng.uniform(-1.0, 1.0) * rng.choice((0.1, 1.0, 80.0)) for _ in values]
    else:
        values[i], values[0] = values[0], values[i]


def _nextafter(value: Any) -> Any:
    return math.nextafter(value, math.inf) if isinstance(value, float) else value


def _airfoil(rng: Random, root: Any) -> None:
    """Change the coordinates or the name of one airfoil, or the schedule."""
    found = [d for d in _mappings(root) if isinstance(d.get("coordinates"), dict)]
    if not found:
        return
    chosen = rng.choice(found)
    if rng.random() < 0.1:
        chosen["name"] = rng.choice(NAMES)
        return
    x, y = chosen["coordinates"].get("x"), chosen["coordinates"].get("y")
    try:
        good = np.array([x, y], dtype=np.float64).T.reshape(-1, 2)
    except (ValueError, TypeError, OverflowError):
        return
    changed = points(rng, good)
    chosen["coordinates"] = {"x": changed[:, 0].tolist(), "y": changed[:, 1].tolist()}


def _mappings(value: Any) -> Iterator[dict[str, Any]]:
    if isinstance(value, dict):
        yield value
    for member in value.values() if isinstance(value, dict) else value:
        if isinstance(member, dict) or (
            isinstance(member, list) and member and isinstance(member[0], dict)
        ):
            yield from _mappings(member)


def airfoil_text(rng: Random, good: np.ndarray) -> bytes:
    """Write an airfoil as a Selig or Lednicer file, in one of the ways that people do."""
    title = rng.choice(("NACA 4-digit", "", "# x y", *NAMES)).encode("utf-8", "replace")
    form = rng.choice(("%.6f", "%.3f", "%g", "%.17g", "%e"))
    gap = rng.choice((b" ", b"  ", b"\t", b",", b"; "))
    rows = [(form % x).encode() + gap + (form % y).encode() for x, y in good]
    middle = len(rows) // 2
    if rng.random() < 0.3 and middle:
        counts = f"{middle + 1}. {len(rows) - middle}.".encode()
        rows = [counts, b"", *rows[middle::-1], b"", *rows[middle:]]
    return rng.choice((b"\n", b"\r\n")).join([title, *rows]) + b"\n"


def zipped(arrays: dict[str, np.ndarray]) -> bytes:
    """Return the bytes of an npz file with these arrays."""
    stream = io.BytesIO()
    np.savez_compressed(stream, **arrays)  # type: ignore[arg-type]
    return stream.getvalue()
