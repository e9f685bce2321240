"""What to export: formats by what they are for, with their unit and the tolerance of solids."""

from dataclasses import replace
from html import escape
from typing import Any

from bladegen.errors import StudioError
from bladegen.exports.options import UNITS
from bladegen.studio.page.downloads import export
from bladegen.studio.page.tab import Page
from bladegen.studio.worker import grouped

__all__ = ["exports"]

EITHER = "m (or mm)"  # in descriptions of formats that take either unit


def exports(page: Page) -> None:
    """Let a format be picked, and its file be made."""
    from nicegui import ui

    with page.client, ui.dialog() as dialog, ui.card().classes("exports w-full"):
        dialog.props('aria-label="Export"')
        ui.html("Export", tag="h2", sanitize=False)
        with ui.element("div").classes("how"):
            units = _units()
            _tolerance(page)
        board = ui.element("div").classes("groups")
        ui.button("Close", on_click=dialog.close, color=None).props("flat no-caps").classes(
            "self-end"
        )

    async def take(suffix: str) -> None:
        dialog.close()
        await export(page, suffix)

    def fill() -> None:
        board.clear()
        unit = page.state.files.unit
        with board:
            for title, known in grouped().items():
                with ui.element("section").props(f'aria-label="{title}"'):
                    ui.html(title, tag="h3", sanitize=False)
                    for suffix, words in known.items():
                        said = words.replace(EITHER, unit)
                        button = ui.element("button").props(f'aria-label="Export {suffix}: {said}"')
                        button.on("click", lambda suffix=suffix: take(suffix))
                        with button:
                            ui.html(f"<b>{suffix}</b> {escape(said)}", sanitize=False)
        for name, one in units.items():
            one.props(f"aria-pressed={str(name == unit).lower()}")

    def follow() -> None:
        fill()

    for name, one in units.items():
        one.on_click(lambda name=name: page.choose(files=replace(page.state.files, unit=name)))
    page.followers.append(follow)

    def gone() -> None:
        page.followers.remove(follow)
        dialog.delete()

    fill()
    dialog.on("hide", gone)
    dialog.open()


def _units() -> dict[str, Any]:
    """Put the choice of the unit; return its buttons."""
    from nicegui import ui

    buttons = {}
    with ui.element("div").classes("choice").props('role=group aria-label="Unit"'):
        ui.label("Meshes and grids in")
        for name in UNITS:
            buttons[name] = ui.button(name, color=None)
            buttons[name].props('flat dense no-caps padding="2px 10px"')
    return buttons


def _tolerance(page: Page) -> None:
    """Put the tolerance of solids; what is not allowed is said, and not taken."""
    from nicegui import ui

    def take(event: Any) -> None:
        try:
            files = replace(page.state.files, tolerance=float(event.args))
        except (StudioError, ValueError) as error:
            page.say(str(error), bad=True)
            field.props(f"value={page.state.files.tolerance:g}")
        else:
            page.choose(files=files)

    with ui.element("div").classes("choice"):
        ui.html("Solids within", tag="label", sanitize=False).props("for=tolerance")
        field = ui.element("input").props(
            f"id=tolerance type=number step=any value={page.state.files.tolerance:g}"
        )
        field.on("change", take, js_handler="(event) => emit(event.target.value)")
        ui.label("mm of the blade")
