"""One block of a family, whole: sections, rows of the manifest, and files of its variants."""

import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.errors import PerturbationError, PromiseError
from bladegen.exports import exporters
from bladegen.exports.products import Products
from bladegen.families.block import Block, joined
from bladegen.families.dataset.graphs import surface
from bladegen.families.family import BLOCK
from bladegen.families.folder import FLOAT_TYPES, GRAPH
from bladegen.families.manifest_rows import drawn_again, rows_of
from bladegen.families.order import Order
from bladegen.families.storage.places import filled
from bladegen.support.arrays import Indices
from bladegen.support.files import digest_of, folder
from bladegen.support.threads import one_thread

__all__ = ["Made", "make_block", "sections_of"]

TIMESTAMP = "1970-01-01T00:00:00"  # in STEP files, so that the same blade makes the same bytes
Made = tuple[int, list[str], float]  # a block's number, what was drawn again and why, seconds


def make_block(order: Order, number: int) -> Made:
    """Make one block, whole."""
    family, start = order.family, time.monotonic()
    index = np.arange(number * order.block, min((number + 1) * order.block, len(family)))
    with one_thread():  # the same sums in the same order, whatever the machine
        block = sections_of(order, index)
        rows = rows_of(family, block)
        faults = _faults(order, block)
        for suffix in order.suffixes:
            rows |= _exported(order, block, suffix, faults)
        labels = order.labelling.computed(block)
    stored = {name: labels.pop(name) for name in order.labelling.arrays()}
    stored |= _graph(block) if order.graph else {}
    stored["sections"] = block.batch.sections
    order.place.write_block(number, stored, rows | labels, order.place.part(number))
    return number, drawn_again(family, block), time.monotonic() - start


def _graph(block: Block) -> dict[str, Any]:
    """Return normals and areas of a block's points."""
    each = [surface(sections) for sections in block.batch.sections]  # one fits in a cache
    return {name: np.stack(part) for name, part in zip(GRAPH, zip(*each, strict=True), strict=True)}


def sections_of(order: Order, index: Indices) -> Block:
    """Make the sections of some variants, in one thread as all that they are made from.

    So many at a time, since what lies between draws and sections takes as much memory as they.
    """
    some = [index[start : start + BLOCK] for start in range(0, max(1, len(index)), BLOCK)]
    how: dict[str, Any] = {"dtype": FLOAT_TYPES[order.dtype], "measured": True}
    with one_thread():
        return joined([order.family.block(part, **how) for part in some])


def _faults(order: Order, block: Block) -> dict[int, str]:
    """Return by place what is wrong, between a block's sections, with variants to be written."""
    found = {}
    for place in block.index[block.valid].tolist() if order.suffixes else ():
        try:
            order.family.named(block, place).require_sound(allow_odd=order.family.allow_odd)
        except PerturbationError as error:
            found[place] = str(error)
    return found


def _exported(order: Order, block: Block, suffix: str, faults: dict[int, str]) -> dict[str, Any]:
    """Write the sound variants in one format; return the columns that say so."""
    names, digests, problems = [], [], []
    blades = order.place.blades
    with filled(blades) as room:
        for place, valid in zip(block.index, block.valid, strict=True):
            name, digest, problem = "", "", ""
            if valid and place in faults:
                problem = faults[place]
            elif valid:
                home = folder(room / order.home(int(place)).relative_to(blades))
                path = home / f"{order.family.name(int(place))}{suffix}"
                made, problem = _export(order, order.family.named(block, int(place)), path)
                name = f"{blades.name}/{made.relative_to(room).as_posix()}"
                digest = digest_of(made)
            names.append(name)
            digests.append(digest)
            problems.append(problem)
    kind = suffix.lstrip(".")
    return {f"{kind}_file": names, f"{kind}_sha256": digests, f"{kind}_problem": problems}


def _export(order: Order, blade: Blade, path: Path) -> tuple[Path, str]:
    """Write one file; return it, under another name if something is wrong, and what, or ""."""
    options = replace(order.options, timestamp=TIMESTAMP, spans=order.spans)
    try:
        exporters.write(Products(blade, options), path)
    except PromiseError as error:
        return error.kept or path, str(error).replace(f"{path.parent}/", "")
    return path, ""
