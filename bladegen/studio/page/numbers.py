"""Numbers of a page: a slider and a field that move its state and follow it."""

from collections.abc import Callable
from typing import Any

from bladegen.studio.controls import Control
from bladegen.studio.page.elements import number
from bladegen.studio.page.tab import Page

__all__ = ["number_of", "own_number"]


def own_number(page: Page, control: Control) -> None:
    """Put a number of the page's state."""
    name = control.name
    number_of(page, control, lambda: page.state.value(name), lambda value: page.set(name, value))


def number_of(
    page: Page, control: Control, now: Callable[[], float], act: Callable[[Any], None]
) -> None:
    """Put a number that shows `now` and acts when it is moved."""
    element = number(control, now())
    shown: dict[str, float | None] = {"value": now()}

    def moved(event: Any) -> None:
        shown["value"] = event.args
        act(event.args)

    def typed(event: Any) -> None:
        shown["value"] = None
        act(event.args)
        follow()

    def follow() -> None:
        if shown["value"] != now():
            shown["value"] = now()
            element.run_method("put", now())

    element.on("move", moved)
    element.on("type", typed)
    element.on("settle", page.pause, [])
    page.followers.append(follow)
