"""Blocks of a family made side by side: in threads, in processes, or on a Dask cluster.

Sections are made by threads: nearly all of that is compiled or done by numpy, which leave Python's
lock alone, and a process takes as long to start as hundreds of variants.  Files are made by
processes: OCCT and writers in Python hold the lock.
"""

import logging
import os
import signal
from collections.abc import Callable, Generator
from itertools import islice
from pathlib import Path
from typing import Any, TypeVar

from bladegen.errors import ExportError, FamilyError
from bladegen.families.making import Made, make_block
from bladegen.families.order import Order
from bladegen.support.threads import one_thread

__all__ = ["in_processes", "in_threads", "on_cluster"]

S = TypeVar("S")
T = TypeVar("T")
logger = logging.getLogger(__name__)

AHEAD = 4  # blocks a worker that are handed out before they can begin: plans may be long
RESTARTS = 5  # of a pool whose worker died, without any block done in between
_ORDER: list[Order] = []  # of a worker process, set once when it starts


def _start(order: Order, parent: int) -> None:
    from bladegen.support.workers import end_with

    end_with(parent)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the parent's to deal with
    _ORDER[:] = [order]


def _make_here(number: int) -> Made:
    return make_block(_ORDER[0], number)


def in_threads(make: Callable[[int], T], left: list[int], jobs: int) -> Generator[T]:
    """Make blocks in threads of this process; told to stop, end those at work and no more."""
    from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait

    coming = iter(left)
    with one_thread(), ThreadPoolExecutor(jobs, thread_name_prefix="blocks") as pool:
        try:
            waiting = {pool.submit(make, one) for one in islice(coming, jobs)}
            while waiting:
                finished, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                more = islice(coming, len(finished))
                waiting |= {pool.submit(make, one) for one in more}
                for task in finished:
                    yield task.result()
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def in_processes(order: Order, left: list[int], jobs: int) -> Generator[Made]:
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


def on_cluster(
    make: Callable[[S, int], T], shared: S, left: list[int], client: Any, target: Path
) -> Generator[T]:
    """Make blocks on a Dask cluster; it hands a dead worker's blocks to the others.

    Parameters
    ----------
    make : callable
        Makes a block of what all workers share, by its number.
    shared : object
        What is sent to each worker once.
    left : list of int
        Blocks that are to be made.
    client : dask.distributed.Client
        The cluster.
    target : Path
        The folder that is written into, for messages.
    """
    from distributed import as_completed

    there = client.scatter(shared, broadcast=True)
    coming, tasks = iter(left), as_completed()

    def submit(count: int) -> None:
        for number in islice(coming, count):
            tasks.add(client.submit(make, there, number, pure=False, retries=3))

    submit(AHEAD * max(1, len(client.nthreads())))
    try:
        for task in tasks:
            submit(1)
            yield task.result()
    except (ExportError, FamilyError):
        raise
    except Exception as error:  # a cluster's own failures are of many kinds
        raise FamilyError(
            f"{target}: the cluster failed: {type(error).__name__}: {error}; the same command goes "
            "on, that of a family with --resume"
        ) from None
    finally:
        client.cancel(list(tasks.futures))
