"""Standard output that cannot be written ends a command in one line, as it ends other tools.

A full disk or a closed file is an error (`OutputError`, exit code 1).  A reader that closed its
pipe, such as `head`, has what it wants: the command ends without a word and with `CLOSED_PIPE`,
the code that a shell gives to a program that the signal SIGPIPE ended.
"""

import errno
import os
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from typing import Any, TextIO, cast

from bladegen.errors import BladegenError

__all__ = ["CLOSED_PIPE", "OutputError", "guarded"]

CLOSED_PIPE = 141  # 128 + SIGPIPE


class OutputError(BladegenError):
    """Standard output cannot be written."""

    def __init__(self, error: OSError) -> None:
        super().__init__(f"standard output: cannot be written: {error.strerror or error}")
        self.closed_pipe = error.errno == errno.EPIPE


@contextmanager
def guarded() -> Iterator[None]:
    """Raise `OutputError` within where standard output cannot be written."""
    before = sys.stdout
    sys.stdout = cast(TextIO, _Guarded(before))
    try:
        yield
    except OutputError:
        with suppress(OSError, AttributeError, ValueError):  # or Python tries again at its end
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, before.fileno())
            os.close(nowhere)
        raise
    finally:
        sys.stdout = before


class _Guarded:
    """A stream whose failures are no `OSError`: libraries deal with these in ways of their own.

    `stream` is None where the program was started without standard output.
    """

    def __init__(self, stream: Any) -> None:
        self._stream = stream

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    @property
    def buffer(self) -> "_Guarded":
        """The bytes below a text stream, which libraries write to besides."""
        return _Guarded(self._stream.buffer)

    def write(self, data: Any) -> int:
        with self._told():
            if self._stream is None:
                raise OSError(errno.EBADF, os.strerror(errno.EBADF))
            return int(self._stream.write(data))

    def writelines(self, lines: Iterable[Any]) -> None:
        for line in lines:
            self.write(line)

    def flush(self) -> None:
        if self._stream is not None:
            with self._told():
                self._stream.flush()

    def isatty(self) -> bool:
        return self._stream is not None and self._stream.isatty()

    @contextmanager
    def _told(self) -> Iterator[None]:
        """Turn an `OSError` into an `OutputError`."""
        try:
            yield
        except OSError as error:
            raise OutputError(error) from None
