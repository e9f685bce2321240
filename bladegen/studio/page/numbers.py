"""Numbers of a page: a slider and a field that move its state and follow it."""

from collections.abc import Callable
from typing import Any

from bladegen.studio.controls import Control
from bladegen.studio.page.drawing import modes
from bladegen.studio.page.elements import number
from bladegen.studio.page.tab import Page

__all__ = ["number_of", "own_number", "shape_number"]


def own_number(page: Page, control: Control) -> None:
    """Put a number of the page's state."""
    name = control.name
    number_of(page, control, lambda: page.state.value(name), lambda value: page.set(name, value))


def shape_number(page: Page, control: Control, mode: int) -> None:
    """Put a shape coordinate, which shows what its mode does when a pointer rests on it."""
    from nicegui import run

    name = control.name
    element = number_of(
        page,
        control,
        lambda: page.state.value(name),
        lambda value: page.set(name, value),
        peeks=True,
    )

    async def peek() -> None:
        state = page.state

        def drawn() -> str:
            baseline = page.studio.library.baseline(state.blade, state.loft)
            profiles, step = baseline.peek(state, mode)
            title = f"<b>{control.label}</b> {control.hint}"
            ends = (
                f'<span class="less">\u2212{step:.3f} rad</span>, as it is (dashed), '
                f'<span class="more">+{step:.3f} rad</span>: one standard deviation of the data'
            )
            return f"{title}{modes.mode(profiles, control.effect, step)}<small>{ends}</small>"

        picture = await run.io_bound(drawn)
        if picture is not None:  # which it is when the studio ends
            element.run_method("picture", picture)

    element.on("peek", peek, [])


def number_of(
    page: Page,
    control: Control,
    now: Callable[[], float],
    act: Callable[[Any], None],
    *,
    peeks: bool = False,
) -> Any:
    """Put a number that shows `now` and acts when it is moved."""
    element = number(control, now(), peeks=peeks)
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
    return element
