"""A process of the studio's own, one thing after the other, which ends with the studio."""

import os
from collections.abc import Callable
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import active_children, get_context
from multiprocessing.process import BaseProcess
from typing import TypeVar

__all__ = ["Worker"]

A = TypeVar("A")
B = TypeVar("B")


class Worker:
    """One process that makes things, started when it is first needed.

    Parameters
    ----------
    load : callable
        What it does first: import what is slow to import.
    """

    def __init__(self, load: Callable[[], None]) -> None:
        self._load = load
        self._pool: ProcessPoolExecutor | None = None
        self._processes: set[BaseProcess] = set()

    def begin(self) -> ProcessPoolExecutor:
        """Start the process, if it is not there, and let it load what it will need."""
        if self._pool is None:
            others = set(active_children())
            self._pool = ProcessPoolExecutor(1, mp_context=get_context("spawn"))
            self._pool.submit(_begun, os.getpid(), self._load)
            self._processes = set(active_children()) - others
        return self._pool

    def submit(self, make: Callable[[A], B], given: A) -> "Future[B]":
        """Queue something to make; a process that has died is replaced."""
        try:
            return self.begin().submit(make, given)
        except BrokenProcessPool:
            self.end()
            return self.begin().submit(make, given)

    def end(self) -> None:
        """Stop the process, whatever it is making: nobody waits for it any more."""
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)
            self._pool = None
        for process in self._processes:
            process.terminate()
        self._processes = set()


def _begun(parent: int, load: Callable[[], None]) -> None:
    """Load; leave the other processors to the page."""
    from bladegen.support.workers import end_with

    end_with(parent)
    load()
    from threadpoolctl import threadpool_limits

    threadpool_limits(1)
