"""What packages of others add to bladegen's tables, by entry points.

In comes a group of entry points and the kind of its rows; out come the rows, and a line on each
entry point that cannot be used.  Nothing that a plug-in does ends in a traceback: what goes wrong
as it is loaded is a line, and what goes wrong as it is called an error of one line (`guarded`).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, wraps
from typing import Any, TypeVar

from bladegen.errors import BladegenError, visible

__all__ = ["Offered", "guarded", "offered"]

Row = TypeVar("Row")
Call = TypeVar("Call", bound=Callable[..., Any])


@dataclass(frozen=True)
class Offered:
    """What the entry points of a group give.

    Parameters
    ----------
    rows : tuple of (str, object)
        The name of each row's entry point, and the row.
    faults : tuple of str
        A line on each entry point that cannot be used.
    """

    rows: tuple[tuple[str, Any], ...]
    faults: tuple[str, ...]

    @property
    def remark(self) -> str:
        """What is to be added to a message where no row fits; "" if no plug-in is broken."""
        return "".join(f"; {fault}" for fault in self.faults)


@cache
def offered(group: str, kind: type, check: Callable[[Any], None] = lambda _: None) -> Offered:
    """Load the entry points of a group, once.

    Parameters
    ----------
    group : str
        Such as ``"bladegen.readers"``.
    kind : type
        What each of them gives: one such value, or a list of them.
    check : callable
        Raises on a row that cannot be used.
    """
    from importlib.metadata import entry_points

    rows: list[tuple[str, Any]] = []
    faults: list[str] = []
    for entry in sorted(entry_points(group=group), key=lambda entry: (entry.name, entry.value)):
        try:
            rows += [(entry.name, row) for row in _rows(entry, kind, check)]
        except (Exception, SystemExit) as error:  # code of others may raise anything
            faults.append(f"plug-in {entry.name} ({entry.value}) is not used: {_said(error)}")
    return Offered(tuple(rows), tuple(faults))


def _rows(entry: Any, kind: type, check: Callable[[Any], None]) -> list[Any]:
    """Return what one entry point gives."""
    given = entry.load()
    rows = list(given) if isinstance(given, list | tuple) else [given]
    for row in rows:
        if not isinstance(row, kind):
            whole = f"{kind.__module__}.{kind.__qualname__}"
            raise TypeError(f"got a {type(row).__name__}, must be a {whole} or a list of them")
        check(row)
    return rows


def guarded(call: Call, name: str, error: Callable[[str], BladegenError]) -> Call:
    """Return a plug-in's function with all that it may raise turned into an error of one line.

    Parameters
    ----------
    call : callable
        The function.
    name : str
        The plug-in's.
    error : callable
        From the line to the error; a `BladegenError` of the function's own stays as it is.
    """

    @wraps(call)
    def safe(*given: Any) -> Any:
        try:
            return call(*given)
        except BladegenError:
            raise
        except (Exception, SystemExit) as fault:  # code of others may raise anything
            raise error(f"plug-in {name}: {_said(fault)}") from fault

    return safe  # type: ignore[return-value]


def _said(error: BaseException) -> str:
    """Return an error in one line."""
    return visible(" ".join(f"{type(error).__name__}: {error}".split()))
