"""How many threads work: linear algebra in one, large compiled loops on all cores.

Linear algebra of what is small: more threads wait for each other.  On cores that others use as
well, two threads of OpenBLAS took fifty times as long as one for the covariance of 2,000 shapes,
and on free ones hardly less.  Sums also depend in their last digit on how many threads add them up.

Compiled loops run without the interpreter's lock, and a share of one is made as it would be alone.
"""

import os
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache, lru_cache
from itertools import count
from typing import Any

__all__ = ["cores", "one_thread", "shares_of", "side_by_side"]

MOST = 8  # threads; more of them wait for the memory
LEAST = 50_000  # points, whose making takes ten times as long as to start a thread
PARTS = 4  # of each thread
_LOCK = threading.Lock()
_HELD: list[Any] = []  # how to give the threads back, and who still needs one only


@contextmanager
def one_thread() -> Iterator[None]:
    """Keep BLAS to one thread, until all who asked for it have left.

    Who holds it holds it for all threads of the program; OpenBLAS lets its main thread change it
    only, so hold it there around others.
    """
    with _LOCK:
        if not _HELD:
            _HELD.append(
                _controller("scipy.linalg" in sys.modules).limit(limits=1, user_api="blas")
            )
        _HELD.append(None)
    try:
        yield
    finally:
        with _LOCK:
            _HELD.pop()
            if len(_HELD) == 1:
                _HELD.pop().restore_original_limits()


@lru_cache(2)
def _controller(_: bool) -> Any:
    """Return what controls the libraries, which takes milliseconds to find them."""
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()


@cache
def cores() -> int:
    """Return how many threads a call may take: as many as OMP_NUM_THREADS says, or as cores.

    Of the cores, those that the process may run on count; eight at most.
    """
    given = os.environ.get("OMP_NUM_THREADS", "").partition(",")[0].strip()
    if given.isdigit() and int(given):
        return min(int(given), MOST)
    known = hasattr(os, "sched_getaffinity")
    return min(len(os.sched_getaffinity(0)) if known else os.cpu_count() or 1, MOST)


def shares_of(points: int) -> int:
    """Return into how many shares to divide a loop that makes some points."""
    return max(1, min(cores(), points // LEAST))


def side_by_side(call: Callable[[int, int], object], shares: int) -> None:
    """Call ``call(first, step)`` for all parts of a loop, in this thread and as many others.

    A part is every `step`-th of what a loop goes through, from `first` on: neighbours take equally
    long.  Who is free takes the next part, so that nobody waits for a thread that starts late.
    It returns when all have ended; the first error is raised.
    """
    if shares == 1:
        call(0, 1)
        return
    from concurrent.futures import wait

    parts, step = count(), PARTS * shares

    def work() -> None:
        while (first := next(parts)) < step:
            call(first, step)

    others = [_pool().submit(work) for _ in range(shares - 1)]
    try:
        work()
    finally:
        begun = [other for other in others if not other.cancel()]
        wait(begun)
    for other in begun:
        other.result()


@cache
def _pool() -> Any:
    from concurrent.futures import ThreadPoolExecutor

    return ThreadPoolExecutor(MOST - 1, thread_name_prefix="shares")


if hasattr(os, "register_at_fork"):  # threads do not live on in a forked process
    os.register_at_fork(after_in_child=_pool.cache_clear)
