"""Runs that write families: block by block, in this process, in several, or on a Dask cluster.

Blocks do not know of each other, so who makes them and in what order changes nothing.
"""

import logging
import os
import signal
from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from bladegen import exporters, polygons
from bladegen.arrays import Array, Indices
from bladegen.blade import Blade
from bladegen.draws import WIDEST
from bladegen.errors import ExportError, FamilyError, PerturbationError, PromiseError
from bladegen.families import BLOCK, Block, Family
from bladegen.family_files import FLOAT_TYPES, FamilyFolder, sections_digest
from bladegen.files import digest_of, folder
from bladegen.identity import fingerprint, identity
from bladegen.net import fitted
from bladegen.spanwise import UNITS

__all__ = ["Order", "run"]

logger = logging.getLogger(__name__)

TIMESTAMP = "1970-01-01T00:00:00"  # in STEP files, so that the same blade makes the same bytes
FEW = 8  # variants in a block that writes files for each
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
    options: exporters.Options = field(default_factory=exporters.Options)

    def __post_init__(self) -> None:
        if self.dtype not in FLOAT_TYPES:
            raise FamilyError(f"dtype: got {self.dtype!r}, allowed are {', '.join(FLOAT_TYPES)}")
        for suffix in self.suffixes:
            exporters.format_of(Path(f"x{suffix}"))
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

    Raises
    ------
    FamilyError
        If the folder holds another family, or workers keep dying.
    ExportError
        If a file cannot be written, or another run writes into the folder.
    """
    if jobs < 1:
        raise FamilyError(f"jobs: got {jobs}, must be at least 1")
    place, family = order.place, order.family
    with place.alone():
        place.begin(order.identity, resume=resume)
        left = order.blocks()
        before = done = len(family) - _variants(order, left)
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
                made = _on_cluster(order, left, client)
            elif jobs > 1 and len(left) > 1:
                made = _in_processes(order, left, min(jobs, len(left)))
            else:
                made = (_make(order, number) for number in left)
            with closing(made):
                for number, again in made:
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


def _variants(order: Order, blocks: list[int]) -> int:
    """Return how many variants some blocks hold."""
    size, count = order.block, len(order.family)
    return sum(min(size, count - number * size) for number in blocks)


Made = tuple[int, list[str]]  # a block's number, and which variants were drawn again and why


def _make(order: Order, number: int) -> Made:
    """Make one block, whole."""
    from threadpoolctl import threadpool_limits

    family = order.family
    index = np.arange(number * order.block, min((number + 1) * order.block, len(family)))
    with threadpool_limits(1):  # the same sums in the same order, whatever the machine
        block = _block(order, index)
        rows = _rows(family, block)
        faults = _faults(order, block)
        for suffix in order.suffixes:
            rows |= _exported(order, block, suffix, faults)
    order.place.write_block(number, block, rows)
    return number, _drawn_again(family, block)


def _drawn_again(family: Family, block: Block) -> list[str]:
    """Say which variants of a block were drawn more than once, and why."""
    return [
        f"{family.name(int(block.index[row]))}: {block.attempts[row]} draws, the first refused: "
        f"{block.refused[row]}"
        for row in np.flatnonzero(block.attempts > 1)
    ]


def _block(order: Order, index: Indices) -> Block:
    """Make the sections of some variants, in one thread as all that they are made from."""
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1):
        return order.family.block(index, dtype=FLOAT_TYPES[order.dtype], measured=True)


def _rows(family: Family, block: Block) -> dict[str, Any]:
    """Return the manifest's columns for a block."""
    batch = block.batch
    assert batch.measures is not None  # _make asked for them
    count = len(block.index)
    few = (batch.sections[i : i + FEW] for i in range(0, count, FEW))  # bounds memory
    measured = [polygons.volume_and_area(sections.astype(np.float64)) for sections in few]
    volume, surface = (np.concatenate(parts) for parts in zip(*measured, strict=True))
    rows: dict[str, Any] = {
        "index": block.index,
        "name": [family.name(int(place)) for place in block.index],
        "valid": block.valid,
        "reason": list(block.reasons),
        "attempts": block.attempts,
        "seed": _seeds(family.design.seed, count),
    }
    for name, column in zip(family.design.what.names, block.values.T, strict=True):
        degrees = name == "twist"
        rows["twist_deg" if degrees else name] = np.degrees(column) if degrees else column
    rows |= {
        "volume_m3": volume,
        "surface_m2": surface,
        "sections_sha256": [sections_digest(sections) for sections in batch.sections],
        "section_chord_m": batch.chord,
        "section_twist_deg": np.degrees(batch.twist),
        "section_relative_thickness": batch.relative_thickness,
    }
    for name, values in zip(polygons.MEASURES, np.moveaxis(batch.measures, -1, 0), strict=True):
        rows[f"section_{name}_{UNITS[name]}"] = values
    return rows


def _seeds(seed: int, count: int) -> Any:
    """Return a seed's column; as text if it has more digits than a column of numbers holds."""
    return np.full(count, seed, dtype=np.int64) if seed < WIDEST else [str(seed)] * count


def _faults(order: Order, block: Block) -> dict[int, str]:
    """Return by place what is wrong, between a block's sections, with variants to be written."""
    found = {}
    for place in block.index[block.valid].tolist() if order.suffixes else ():
        try:
            order.family.named(block, place).require_sound()
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
        exporters.write(exporters.Products(blade, options), path)
    except PromiseError as error:
        return error.kept or path, str(error).replace(f"{path.parent}/", "")
    return path, ""


_ORDER: list[Order] = []  # of a worker process, set once when it starts


def _start(order: Order, parent: int) -> None:
    from bladegen.orphans import end_with

    end_with(parent)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the parent's to deal with
    _ORDER[:] = [order]


def _make_here(number: int) -> Made:
    return _make(_ORDER[0], number)


def _in_processes(order: Order, left: list[int], jobs: int) -> Generator[Made]:
    """Make blocks in processes of this machine; begin again with what a dead one left."""
    from concurrent.futures import ProcessPoolExecutor, as_completed
    from concurrent.futures.process import BrokenProcessPool
    from multiprocessing import active_children, get_context

    restarts, others = 0, set(active_children())
    while left:
        pool = ProcessPoolExecutor(
            jobs, mp_context=get_context("spawn"), initializer=_start, initargs=(order, os.getpid())
        )
        try:
            for task in as_completed([pool.submit(_make_here, number) for number in left]):
                made = task.result()
                left = [other for other in left if other != made[0]]
                restarts = 0
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
    tasks = [client.submit(_make, shared, number, pure=False, retries=3) for number in left]
    try:
        for task in as_completed(tasks):
            yield task.result()
    except (ExportError, FamilyError):
        raise
    except Exception as error:  # a cluster's own failures are of many kinds
        raise FamilyError(
            f"{order.target}: the cluster failed: {type(error).__name__}: {error}; --resume goes on"
        ) from None
    finally:
        client.cancel(tasks)
