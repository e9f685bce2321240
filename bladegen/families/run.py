"""Runs that write families: block by block, in this process, in several, or on a Dask cluster.

Blocks do not know of each other, so who makes them and in what order changes nothing.
"""

import logging
import os
import signal
import time
from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.errors import ExportError, FamilyError, PerturbationError, PromiseError
from bladegen.exports import exporters
from bladegen.exports.options import Options
from bladegen.exports.products import Products
from bladegen.exports.registry import format_of
from bladegen.families.family import BLOCK, Block, Family
from bladegen.families.folder import FLOAT_TYPES, FamilyFolder
from bladegen.families.forecasts import Forecast, free_bytes, require_room
from bladegen.families.identity import fingerprint, identity
from bladegen.families.manifest_rows import drawn_again, rows_of
from bladegen.support.arguments import whole
from bladegen.support.arrays import Array, Indices
from bladegen.support.files import digest_of, folder
from bladegen.surface.fitting import fitted

__all__ = ["Order", "run"]

logger = logging.getLogger(__name__)

TIMESTAMP = "1970-01-01T00:00:00"  # in STEP files, so that the same blade makes the same bytes
FEW = 8  # variants in a block that writes files for each
AHEAD = 4  # blocks a worker that are handed out before they can begin: plans may be long
RESTARTS = 5  # of a pool whose worker died, without any block done in between


@dataclass(frozen=True, eq=False)
class Order:
    """What is to be written where.

    Parameters
    ----------
    family : Family
        The variants.
    target : Path
        The folder; workers elsewhere must see it under the same name.
    formats : tuple of str
        Suffixes of files for each sound variant; none by default.
    dtype : str
        Of the stored sections: "float32" or "float64".
    options : Options
        How files are made.
    """

    family: Family
    target: Path
    formats: tuple[str, ...] = ()
    dtype: str = "float32"
    options: Options = field(default_factory=Options)

    def __post_init__(self) -> None:
        if self.dtype not in FLOAT_TYPES:
            raise FamilyError(f"dtype: got {self.dtype!r}, allowed are {', '.join(FLOAT_TYPES)}")
        for suffix in self.suffixes:
            format_of(Path(f"x{suffix}"))
        # Sums depend in their last digit on how many threads add them up: what the family has
        # computed so far is left behind, and `_make` computes it again in one thread.
        fresh = replace(self.family, blade=replace(self.family.blade))
        object.__setattr__(self, "family", fresh)

    @property
    def suffixes(self) -> list[str]:
        """The formats' suffixes, with their dots."""
        return [f".{suffix.lower().lstrip('.')}" for suffix in self.formats]

    @property
    def place(self) -> FamilyFolder:
        """The folder."""
        return FamilyFolder(self.target, self.block)

    @property
    def identity(self) -> dict[str, Any]:
        """What the folder will hold."""
        made = {"dtype": self.dtype, "formats": self.suffixes}
        if self.suffixes:
            made["options_fingerprint"] = fingerprint(self.options)
        return identity(self.family) | made

    @property
    def block(self) -> int:
        """How many variants are made at once: fewer where each takes a second."""
        return FEW if self.suffixes else BLOCK

    @cached_property
    def spans(self) -> Array:
        """The sections of the baseline's solid, for the variants' solids to begin with."""
        return fitted(self.family.blade, self.options.tolerance)[0].v

    def blocks(self) -> list[int]:
        """Return the numbers of the blocks that are still to be made."""
        return self.place.open_blocks(len(self.family))


def run(
    order: Order,
    *,
    jobs: int = 1,
    client: Any = None,
    resume: bool = False,
    progress: Callable[[int], None] = lambda _: None,
    foretold: Callable[[Forecast], None] = lambda _: None,
) -> int:
    """Write a family; return how many variants were made now.

    Parameters
    ----------
    order : Order
        What and where.
    jobs : int
        Processes on this machine.
    client : dask.distributed.Client, optional
        A cluster that makes the blocks instead.
    resume : bool
        Go on with what an earlier run left.
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
    if not resume:
        require_room(order.target, len(family), _bytes(order, len(family)), at_least=True)
    with place.alone(), place.undone_if_refused():
        place.begin(order.identity, resume=resume)
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
            place.make_sections(family.eta, family.blade.u, len(family), order.dtype)
            if order.suffixes:
                folder(place.blades)
            _block(order, np.arange(0))  # compiles, for all workers
            if client is not None:
                made, several = _on_cluster(order, left, client), len(client.nthreads())
            elif jobs > 1 and len(left) > 1:
                several = min(jobs, len(left))
                made = _in_processes(order, left, several)
            else:
                made, several = (_make(order, number) for number in left), 1
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
    return done - before


def _bytes(order: Order, variants: int) -> int:
    """Return how many bytes the sections of some variants take."""
    one = len(order.family.eta) * len(order.family.blade.u) * 3
    return variants * one * np.dtype(FLOAT_TYPES[order.dtype]).itemsize


def _foreseen(order: Order, left: list[int], made: int, seconds: float) -> Forecast:
    """Return what the blocks that are left take, by one that is whole; raise without room."""
    count, names = _variants(order, [made]), []
    if order.suffixes:
        first = made * order.block
        names = [order.family.name(place) for place in range(first, first + count)]
    one = order.place.bytes_of(made, names) + _bytes(order, count)
    others = _variants(order, left) - count
    needed = one * others // count
    require_room(order.target, others, needed)
    blocks = others / order.block
    return Forecast(others, needed, free_bytes(order.target), seconds * blocks)


def _variants(order: Order, blocks: list[int]) -> int:
    """Return how many variants some blocks hold."""
    size, count = order.block, len(order.family)
    return sum(min(size, count - number * size) for number in blocks)


Made = tuple[int, list[str], float]  # a block's number, what was drawn again and why, seconds


def _make(order: Order, number: int) -> Made:
    """Make one block, whole."""
    from threadpoolctl import threadpool_limits

    family, start = order.family, time.monotonic()
    index = np.arange(number * order.block, min((number + 1) * order.block, len(family)))
    with threadpool_limits(1):  # the same sums in the same order, whatever the machine
        block = _block(order, index)
        rows = rows_of(family, block)
        faults = _faults(order, block)
        for suffix in order.suffixes:
            rows |= _exported(order, block, suffix, faults)
    order.place.write_block(number, block, rows)
    return number, drawn_again(family, block), time.monotonic() - start


def _block(order: Order, index: Indices) -> Block:
    """Make the sections of some variants, in one thread as all that they are made from."""
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1):
        return order.family.block(index, dtype=FLOAT_TYPES[order.dtype], measured=True)


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
    for place, valid in zip(block.index, block.valid, strict=True):
        name, digest, problem = "", "", ""
        if valid and place in faults:
            problem = faults[place]
        elif valid:
            path = order.place.blades / f"{order.family.name(int(place))}{suffix}"
            made, problem = _export(order, order.family.named(block, int(place)), path)
            name, digest = f"{order.place.blades.name}/{made.name}", digest_of(made)
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


_ORDER: list[Order] = []  # of a worker process, set once when it starts


def _start(order: Order, parent: int) -> None:
    from bladegen.support.workers import end_with

    end_with(parent)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the parent's to deal with
    _ORDER[:] = [order]


def _make_here(number: int) -> Made:
    return _make(_ORDER[0], number)


def _in_processes(order: Order, left: list[int], jobs: int) -> Generator[Made]:
    """Make blocks in processes of this machine; begin again with what a dead one left."""
    from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
    from concurrent.futures.process import BrokenProcessPool
    from multiprocessing import active_children, get_context

    restarts, others = 0, set(active_children())
    open_blocks = dict.fromkeys(left)
    while open_blocks:
        pool = ProcessPoolExecutor(
            jobs, mp_context=get_context("spawn"), initializer=_start, initargs=(order, os.getpid())
        )
        coming = iter(list(open_blocks))
        try:
            waiting = {pool.submit(_make_here, number) for number in islice(coming, AHEAD * jobs)}
            while waiting:
                finished, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                for task in finished:
                    made = task.result()
                    del open_blocks[made[0]]
                    restarts = 0
                    waiting |= {pool.submit(_make_here, number) for number in islice(coming, 1)}
                    yield made
        except BrokenProcessPool:
            restarts += 1
            logger.warning("%s: a worker process died, another one goes on", order.target)
            if restarts > RESTARTS:
                raise FamilyError(
                    f"{order.target}: worker processes died {restarts} times in a row (out of "
                    "memory?); fewer --jobs and --resume go on"
                ) from None
        except BaseException:  # told to stop: nobody waits for what is at work
            for process in set(active_children()) - others:
                process.terminate()
            raise
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def _on_cluster(order: Order, left: list[int], client: Any) -> Generator[Made]:
    """Make blocks on a Dask cluster; it hands a dead worker's blocks to the others."""
    from distributed import as_completed

    shared = client.scatter(order, broadcast=True)
    coming, tasks = iter(left), as_completed()

    def submit(count: int) -> None:
        for number in islice(coming, count):
            tasks.add(client.submit(_make, shared, number, pure=False, retries=3))

    submit(AHEAD * max(1, len(client.nthreads())))
    try:
        for task in tasks:
            submit(1)
            yield task.result()
    except (ExportError, FamilyError):
        raise
    except Exception as error:  # a cluster's own failures are of many kinds
        raise FamilyError(
            f"{order.target}: the cluster failed: {type(error).__name__}: {error}; --resume goes on"
        ) from None
    finally:
        client.cancel(list(tasks.futures))
