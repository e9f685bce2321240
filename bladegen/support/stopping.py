"""A command that is told to stop, by Ctrl C or by the system, unwinds and says so in a line.

Signals become an exception that no `except Exception` swallows and that the command line's
library, which ends without a word on `KeyboardInterrupt`, does not know.
"""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

__all__ = ["Stopped", "held_back", "stopped_by_signals"]

SIGNALS = {"SIGINT": "interrupted", "SIGTERM": "terminated", "SIGHUP": "hung up"}
BY_SIGNAL = 128  # shells add a signal's number to it


class Stopped(BaseException):
    """The process was told to stop.

    Parameters
    ----------
    words : str
        What to say of it.
    status : int
        What the process is to exit with.
    """

    def __init__(self, words: str, status: int) -> None:
        super().__init__(words)
        self.status = status

    def saying(self, words: str) -> "Stopped":
        """Return the same with words before its own."""
        return Stopped(f"{words}{self}", self.status)


_waiting: list[list[Stopped]] = []  # of those who hold signals back, what came meanwhile


@contextmanager
def held_back() -> Iterator[None]:
    """Hold signals back for a moment, so that who took something knows that it was taken."""
    came: list[Stopped] = []
    _waiting.append(came)
    try:
        yield
    finally:
        _waiting.pop()
        if came:
            raise came[0]


@contextmanager
def stopped_by_signals() -> Iterator[None]:
    """Raise `Stopped` at the first signal that asks the process to end; the next one ends it.

    A signal that the process was started to ignore, as `nohup` and shells have it, stays ignored.
    """
    before = {}
    for name, words in SIGNALS.items():
        number = getattr(signal, name, None)  # Windows has no SIGHUP
        if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
            before[number] = signal.getsignal(number), words

    def stop(number: int, _frame: FrameType | None) -> None:
        for other in before:
            signal.signal(other, signal.SIG_DFL)
        stopped = Stopped(before[signal.Signals(number)][1], BY_SIGNAL + number)
        if not _waiting:
            raise stopped
        _waiting[-1].append(stopped)

    for number in before:
        signal.signal(number, stop)
    try:
        yield
    finally:
        for number, (handler, _) in before.items():
            signal.signal(number, handler)
