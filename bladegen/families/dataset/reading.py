"""Batches of a family's arrays, as training loops read them: shard by shard, shuffled or not."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from bladegen.errors import FamilyError
from bladegen.support.arguments import whole
from bladegen.support.arrays import Indices

__all__ = ["arrays_at", "batches"]

POOL = 4  # shards whose variants are shuffled together


def batches(
    family: Any,
    names: tuple[str, ...],
    size: int,
    places: Indices | None,
    rng: np.random.Generator | None,
) -> Iterator[dict[str, Any]]:
    """Give batches of a loaded family's arrays (`LoadedFamily.batches`)."""
    if whole(size, "size", FamilyError) < 1:
        raise FamilyError(f"size: got {size}, must be at least 1")
    for name in names:
        _array(family, name)
    wanted = np.arange(len(family)) if places is None else np.asarray(places)
    shard = (family["sections"].shards or family["sections"].chunks)[0]
    groups = [
        wanted[wanted // shard == number] for number in dict.fromkeys((wanted // shard).tolist())
    ]
    if rng is not None:
        groups = [groups[i] for i in rng.permutation(len(groups))]
    held: dict[str, Any] = {}
    for first in range(0, len(groups), POOL):
        pool = np.concatenate(groups[first : first + POOL])
        pool = pool if rng is None else rng.permutation(pool)
        read = arrays_at(family, names, pool)
        if held:
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
    first, last = int(places.min()), int(places.max())
    if isinstance(array, np.ndarray):
        return array[places]
    if last - first + 1 <= 2 * len(places):
        return np.asarray(array[first : last + 1])[places - first]
    unique, back = np.unique(places, return_inverse=True)
    return np.asarray(array.oindex[unique])[back]
