"""Runs that write families: block by block, one after the other or side by side.

Blocks do not know of each other, so who makes them and in what order changes nothing.
"""

import logging
import math
from collections.abc import Callable, Generator
from contextlib import closing
from functools import partial
from typing import Any

import numpy as np

from bladegen.errors import FamilyError
from bladegen.families.additions.growth import grow, settle
from bladegen.families.additions.unfinished import require_none
from bladegen.families.dataset.writing import write_dataset
from bladegen.families.folder import FLOAT_TYPES
from bladegen.families.forecasts import Forecast, free_bytes, require_room
from bladegen.families.making import Made, make_block, sections_of
from bladegen.families.order import Order
from bladegen.families.processes import in_processes, in_threads, on_cluster
from bladegen.families.storage.places import folder, told
from bladegen.support.arguments import whole

__all__ = ["run"]

logger = logging.getLogger(__name__)


def run(
    order: Order,
    *,
    jobs: int = 1,
    client: Any = None,
    resume: bool = False,
    append: bool = False,
    progress: Callable[[int], None] = lambda _: None,
    foretold: Callable[[Forecast], None] = lambda _: None,
) -> int:
    """Write a family; return how many variants were made now.

    Parameters
    ----------
    order : Order
        What and where.
    jobs : int
        Threads of this process, or processes of this machine where files are written.
    client : dask.distributed.Client, optional
        A cluster that makes the blocks instead.
    resume : bool
        Go on with what an earlier run left.
    append : bool
        Go on with a family of fewer variants: those that are there stay as they are.
    progress : callable
        Told how many variants are whole, each time some are.
    foretold : callable
        Told once, when the first block is whole, what the others will take.

    Raises
    ------
    FamilyError
        If the folder holds another family, the disk has no room for this one, or workers keep
        dying.
    ExportError
        If a file cannot be written, or another run writes into the folder.
    """
    if whole(jobs, "jobs", FamilyError) < 1:
        raise FamilyError(f"jobs: got {jobs}, must be at least 1")
    place, family = order.place, order.family
    if not (resume or append):
        require_room(order.target, len(family), _bytes(order, len(family)), at_least=True)
    with told(order.target), place.alone(), place.undone_if_refused():
        require_none(place)
        if append:
            grow(order)
        place.begin(order.identity, resume=resume or append)
        settle(place, len(family))
        left = order.blocks()
        before = done = len(family) - _variants(order, left)
        require_room(order.target, len(family) - done, _bytes(order, len(family) - done))
        progress(done)
        logger.info(
            "%s: %d of %d variants are there, %d blocks to make",
            order.target,
            done,
            len(family),
            len(left),
        )
        if left:
            place.make_sections(
                family.eta, family.blade.u, len(family), order.dtype, order.beside()
            )
            if order.suffixes:
                folder(place.blades)
            sections_of(order, np.arange(0))  # compiles, for all workers
            if client is not None:
                made = on_cluster(make_block, order, left, client, order.target)
                several = len(client.nthreads())
            elif jobs > 1 and len(left) > 1:
                several = min(jobs, len(left))
                make = partial(make_block, order)
                threads = not order.suffixes
                made = (
                    in_threads(make, left, several)
                    if threads
                    else in_processes(order, left, several)
                )
            else:
                made, several = (make_block(order, number) for number in left), 1
            with closing(made):
                for number, again, seconds in made:
                    if done == before:
                        foretold(_foreseen(order, left, number, seconds / several))
                    done += _variants(order, [number])
                    progress(done)
                    logger.info(
                        "block %d is whole, %d variants drawn again; %d of %d variants are there",
                        number,
                        len(again),
                        done,
                        len(family),
                    )
                    for said in again:
                        logger.debug("%s", said)
        place.finish(len(family))
        write_dataset(order)
    return done - before


def _beside(order: Order, left: list[int], several: int) -> Generator[Made]:
    """Make blocks side by side on this machine."""
    if order.suffixes:
        return in_processes(order, left, several)
    return in_threads(partial(make_block, order), left, several)


def _bytes(order: Order, variants: int) -> int:
    """Return how many bytes the sections of some variants take."""
    one = len(order.family.eta) * len(order.family.blade.u) * 3
    each = one * np.dtype(FLOAT_TYPES[order.dtype]).itemsize
    beside = sum(4 * math.prod(lengths) for _, lengths in order.beside().values())
    return variants * (each + beside)


def _foreseen(order: Order, left: list[int], made: int, seconds: float) -> Forecast:
    """Return what the blocks that are left take, by one that is whole; raise without room."""
    count, stems = _variants(order, [made]), []
    if order.suffixes:
        first = made * order.block
        each = range(first, first + count)
        stems = [order.home(place) / order.family.name(place) for place in each]
    one = order.place.bytes_of(made, stems) + _bytes(order, count)
    others = _variants(order, left) - count
    needed = one * others // count
    require_room(order.target, others, needed)
    blocks = others / order.block
    return Forecast(others, needed, free_bytes(order.target), seconds * blocks)


def _variants(order: Order, blocks: list[int]) -> int:
    """Return how many variants some blocks hold."""
    size, count = order.block, len(order.family)
    return sum(min(size, count - number * size) for number in blocks)
