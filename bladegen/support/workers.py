"""Worker processes that end when the process that started them does, whatever they are at.

A worker that has lost its parent belongs to another process, which the system tells at once.  A
thread asks for it now and then, in compiled code: Python's lock may be held for many seconds by a
solid in the making, and a thread that needs the lock to look, or to leave, would come too late.
This module loads Numba; so import it late.  Without Numba the thread looks as often as it gets
the lock.
"""

import os
import threading
import time

from bladegen.support.compiled import NUMBA, compiled

__all__ = ["end_with"]

LOOKS = 200_000  # microseconds between two looks; sleeps of a second and more are not portable
STATUS = 1  # of a worker that ends so

if NUMBA:  # functions of the C library; compiled code calls them without Python's lock
    from numba import types

    getppid = types.ExternalFunction("getppid", types.intc())
    usleep = types.ExternalFunction("usleep", types.intc(types.uintc))
    leave = types.ExternalFunction("_exit", types.void(types.intc))
else:
    getppid, leave = os.getppid, os._exit

    def usleep(microseconds: int) -> None:
        """Sleep."""
        time.sleep(1e-6 * microseconds)


@compiled
def watch(parent: int, for_good: bool) -> None:
    """Leave the process once its parent is another one; look once, or return never."""
    while getppid() == parent:
        if not for_good:
            return
        usleep(LOOKS)
    leave(STATUS)


def end_with(parent: int) -> None:
    """Let this process end, without tidying up, within half a second of its parent's end.

    Parameters
    ----------
    parent : int
        The parent's process number, as the parent knows it: it may be gone already.
    """
    watch(parent, False)  # compiled now, for which the thread would need Python's lock
    threading.Thread(target=watch, args=(parent, True), name="parent", daemon=True).start()
