"""Batches of a family's arrays, as training loops read them: shard by shard, shuffled or not."""

import itertools
import math
import operator
from collections.abc import Iterator
from typing import Any, SupportsIndex

import numpy as np

from bladegen.errors import FamilyError, PlaceError
from bladegen.support.arguments import generator, shown, whole
from bladegen.support.arrays import Indices

__all__ = ["arrays_at", "batches", "chosen", "named", "of_numbers", "place_of"]

NEAR = 2**20  # bytes that are read between two rows that are wanted: one read costs as much as they
POOL = 4  # shards whose variants are shuffled together


def batches(
    family: Any,
    names: Any,
    size: int,
    places: Any,
    rng: np.random.Generator | int | None,
) -> Iterator[dict[str, Any]]:
    """Give batches of a loaded family's arrays (`LoadedFamily.batches`)."""
    size = whole(size, "size", FamilyError)
    if size < 1:
        raise FamilyError(f"size: got {size}, must be at least 1")
    names, wanted = named(family, names), chosen(family, places)
    rng = None if rng is None else generator(rng, "rng", FamilyError)
    shard = (family["sections"].shards or family["sections"].chunks)[0]
    groups = [
        wanted[wanted // shard == number] for number in dict.fromkeys((wanted // shard).tolist())
    ]
    if rng is not None:
        groups = [groups[i] for i in rng.permutation(len(groups))]
    held: dict[str, Any] = {}
    together = 1 if rng is None else POOL
    for first in range(0, len(groups), together):
        pool = np.concatenate(groups[first : first + together])
        pool = pool if rng is None else rng.permutation(pool)
        read = arrays_at(family, names, pool)
        if held and len(next(iter(held.values()))):
            read = {name: np.concatenate([held[name], values]) for name, values in read.items()}
        count = len(next(iter(read.values())))
        for end in range(size, count + 1, size):
            yield {name: values[end - size : end] for name, values in read.items()}
        held = {name: values[count - count % size :] for name, values in read.items()}
    if held and len(next(iter(held.values()))):
        yield held


def arrays_at(family: Any, names: tuple[str, ...], places: Indices) -> dict[str, Any]:
    """Return arrays of some variants, in the order asked for."""
    return {name: _rows(_array(family, name), places) for name in names}


def _array(family: Any, name: str) -> Any:
    return family.parameters if name == "parameters" else family[name]


def _rows(array: Any, places: Indices) -> Any:
    """Return rows of an array in NumPy or of a store: one read where they follow each other."""
    if not len(places):
        return np.asarray(array[:0])
    if isinstance(array, np.ndarray):
        return array[places]
    order = np.argsort(places, kind="stable")
    ordered = places[order]
    near = max(1, NEAR // (array.dtype.itemsize * math.prod(array.shape[1:])))
    ends = [0, *(np.flatnonzero(np.diff(ordered) > near) + 1).tolist(), len(ordered)]
    if len(ends) == 2 and np.array_equal(places, np.arange(places[0], places[0] + len(places))):
        return np.asarray(array[places[0] : places[-1] + 1])
    found = np.empty((len(places), *array.shape[1:]), array.dtype)
    for start, end in itertools.pairwise(ends):
        part = ordered[start:end]
        found[order[start:end]] = np.asarray(array[part[0] : part[-1] + 1])[part - part[0]]
    return found


def chosen(family: Any, places: Any) -> Indices:
    """Return places of variants, (b,), or say what is wrong with them."""
    if places is None:
        return np.arange(len(family))
    found = np.asarray(places)
    if found.dtype == bool and found.shape == (len(family),):
        return np.flatnonzero(found)
    if found.ndim != 1 or (found.size and not np.issubdtype(found.dtype, np.integer)):
        raise FamilyError(
            f"places: got an array of {found.dtype} of shape {found.shape}, must be whole numbers, "
            f'such as family.split("train"), or {len(family)} of True and False'
        )
    outside = found[(found < 0) | (found >= len(family))]
    if outside.size:
        raise FamilyError(f"places: got {outside[0]}, allowed is 0 to {len(family) - 1}")
    return found.astype(np.int64)


def of_numbers(family: Any, names: tuple[str, ...]) -> None:
    """Raise where one of some arrays holds texts."""
    for name in names:
        if _array(family, name).dtype.kind not in "biuf":
            raise FamilyError(f"names: {name!r} holds texts, must be numbers or True and False")


def place_of(key: SupportsIndex, count: int) -> int:
    """Return the place of one of `count` variants, from the end if it is negative."""
    try:
        place = operator.index(key)
    except TypeError:
        raise FamilyError(f"variant: got {shown(key)}, must be a whole number or a name") from None
    if not -count <= place < count:
        raise PlaceError(f"variant: got {place}, allowed is 0 to {count - 1}")
    return place % count


def named(family: Any, names: Any) -> tuple[str, ...]:
    """Return names of arrays, each of which the family holds; one alone may be a text."""
    listed = (names,) if isinstance(names, str) else tuple(names)
    if not listed:
        raise FamilyError('names: got none, must be arrays such as ("parameters", "sections")')
    for name in listed:
        _array(family, name)
    return listed
