"""The section looked at: its outline, its lift and drag, or its layers, over the baseline's."""

from collections.abc import Callable
from html import escape
from typing import Any

from bladegen.studio.page.buttons import button
from bladegen.studio.page.drawing.layers import layers
from bladegen.studio.page.drawing.lift import lift
from bladegen.studio.page.live import Live
from bladegen.studio.page.numbers import own_number
from bladegen.studio.page.tab import Page, Shown

__all__ = ["section"]

VIEWS = {
    "outline": ("Outline", "gesture"),
    "lift": ("Lift and drag", "show_chart"),
    "layers": ("Layers and webs", "layers"),
}
AWAITED = "computing ..."


def section(page: Page) -> Callable[[Shown], None]:
    """Put the card; return what shows another state."""
    from nicegui import ui

    with ui.element("section").classes("card section").props('aria-label="Section"'):
        with ui.element("div").classes("head"):
            own_number(page, page.controls["at"])
            words = ui.label().classes("figure")
            placed = button("straighten", "As it stands in the blade, in metres")
            placed.props("aria-pressed=false")
        with ui.element("div").classes("ways").props('role=toolbar aria-label="What is drawn"'):
            ways = {name: button(icon, title) for name, (title, icon) in VIEWS.items()}
        drawing = ui.html("", sanitize=False).classes("plot")
    shown: dict[str, Any] = {"view": "outline", "outline": ""}

    def draw() -> None:
        view = shown["view"]
        drawing.set_content(shown["outline"] if view == "outline" else _answered(view, page.live))
        drawing.classes(**{"add" if view != "outline" and page.live.stale else "remove": "stale"})

    def take(view: str) -> None:
        shown["view"] = view
        for name, way in ways.items():
            way.props(f"aria-pressed={str(name == view).lower()}")
        placed.set_enabled(view == "outline")
        draw()

    def turn() -> None:
        page.place(not page.placed)
        placed.props(f"aria-pressed={str(page.placed).lower()}")

    def follow() -> None:
        length = page.studio.library.baseline(page.state.blade, page.state.loft).blade.length
        words.set_text(f"{page.state.at * length:.1f} m")

    def answered() -> None:
        if shown["view"] != "outline":
            draw()

    def show(now: Shown) -> None:
        shown["outline"] = now.section
        if shown["view"] == "outline":
            draw()

    for name, way in ways.items():
        way.on_click(lambda name=name: take(name))
    placed.on_click(turn)
    page.followers.append(follow)
    page.live.followers.append(answered)
    take("outline")
    return show


def _answered(view: str, live: Live) -> str:
    """Return the chart of the latest answer, or why there is none."""
    found = live.section
    if found is None or live.trouble:
        return _said(live.trouble or AWAITED)
    beside = found.lift if view == "lift" else found.inside
    if beside.now is None or beside.before is None:
        return _said(beside.trouble)
    if view == "lift":
        assert found.lift.now is not None
        assert found.lift.before is not None
        return lift(found.lift.now, found.lift.before)
    assert found.inside.now is not None
    assert found.inside.before is not None
    now, before = found.inside.now, found.inside.before
    return layers(now.section, before.section, now.mass, before.mass)


def _said(words: str) -> str:
    return f'<p class="said">{escape(words)}</p>'
