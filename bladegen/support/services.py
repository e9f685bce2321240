"""What values offer though it stands above them: the package's top says where it is found.

A `Blade` shows itself in a notebook and writes itself to files, but neither pictures nor files
are what it is made of.  So it asks for a service by name, and `bladegen/__init__.py`, which stands
above all rooms, registers what does it.
"""

from collections.abc import Callable
from typing import Any

__all__ = ["provide", "service", "shown_by"]

_SERVICES: dict[str, Callable[[], Callable[..., Any]]] = {}


def provide(name: str, find: Callable[[], Callable[..., Any]]) -> None:
    """Register a service.

    Parameters
    ----------
    name : str
        By which it is asked for.
    find : callable
        Imports and returns it, when it is first needed.
    """
    _SERVICES[name] = find


def service(name: str) -> Callable[..., Any]:
    """Return the service of a name."""
    return _SERVICES[name]()


def shown_by(name: str) -> Callable[[Any], str]:
    """Return a method `_repr_html_`, for notebooks, that a service does."""

    def html(value: Any) -> str:
        shown: str = service(name)(value)
        return shown

    return html
