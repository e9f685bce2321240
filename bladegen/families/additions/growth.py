"""More variants in a family's folder: what is there stays, and becomes the beginning.

A variant depends on the seed and its place alone, so a family of 1,000 begins with the family of
100.  The last block, if it was not full, is made again.  Steps follow each other so that a run
killed between any two goes on: parts first, then what the family is, then the manifest.
"""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

from bladegen.errors import FamilyError
from bladegen.families.dataset.store import opened
from bladegen.families.folder import GRAPH, FamilyFolder
from bladegen.families.identity import require_same
from bladegen.families.labels.figures import STORED
from bladegen.families.order import Order
from bladegen.families.storage.layout import MOST
from bladegen.families.storage.places import folder, replacing
from bladegen.families.storage.tables import parquet

__all__ = ["grow", "settle"]

WHOLE = ("lhs", "sweep")  # designs whose variants depend on how many there are


def grow(order: Order) -> None:
    """Make a smaller family of a folder the beginning of the one that is asked for.

    Raises
    ------
    FamilyError
        If the folder holds no family, another one, or more variants than are asked for.
    """
    place, family = order.place, order.family
    count = len(family)
    try:
        found = json.loads(place.description.read_text(encoding="utf-8"))
        there = int(found["count"])
    except (OSError, ValueError, KeyError, TypeError):
        raise FamilyError(f"{place.path}: holds no family to add to; leave --append out") from None
    if there == count:
        return
    if there > count:
        raise FamilyError(
            f"{place.path}: holds {there} variants, {count} are asked for; --count is how many "
            "there shall be in all"
        )
    if family.design.kind in WHOLE:
        raise FamilyError(
            f"design: the variants of {family.design.kind!r} depend on how many there are; "
            "sobol, box, ellipsoid and others can be added to"
        )
    table = family.design.table
    fewer = replace(family.design, count=there, table=None if table is None else table[:there])
    before = json.loads(json.dumps(replace(order, family=replace(family, design=fewer)).identity))
    require_same(place.path, before, found)
    if family.name(0) != replace(family, design=fewer).name(0):
        raise FamilyError(
            f"{place.path}: {count} variants have names of more digits than the {there} that are "
            "there; take another folder"
        )
    if -(-count // place.block) > MOST:
        raise FamilyError(
            f"{place.path}: has {place.block} variants in a shard, and a folder holds {MOST} "
            f"shards; take another folder for more than {MOST * place.block} variants in all"
        )
    _keep_parts(place)
    if there % place.block:
        place.part(there // place.block).unlink(missing_ok=True)
    with replacing(place.description) as temporary:
        temporary.write_text(json.dumps(order.identity, indent=2) + "\n", encoding="utf-8")


def settle(place: FamilyFolder, count: int) -> None:
    """Open a folder for more variants than its manifest holds; nothing if it holds them all."""
    if place.manifest.exists() and _rows(place.manifest) < count:
        _keep_parts(place)
        place.manifest.unlink()
    if place.store.exists():
        store = opened(place.store, writing=True)
        for name in ("sections", *GRAPH, *STORED):
            if name in store and store[name].shape[0] < count:
                store[name].resize((count, *store[name].shape[1:]))


def _rows(manifest: Path) -> int:
    with parquet(manifest) as file:
        return int(file.metadata.num_rows)


def _keep_parts(place: FamilyFolder) -> None:
    """Write the full blocks of a manifest as the parts that they were joined from."""
    import pyarrow.parquet as pq

    if not place.manifest.exists():
        return
    folder(place.parts)
    with parquet(place.manifest) as file:
        for number in range(file.num_row_groups):
            rows: Any = file.read_row_group(number)
            if len(rows) == place.block:
                with replacing(place.part(number)) as temporary:
                    pq.write_table(rows, temporary, compression="zstd")
