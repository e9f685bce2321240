"""A state to share: as a link, as a command, as a script; and what keys do."""

import json
from html import escape

from bladegen.studio.page.buttons import button
from bladegen.studio.page.tab import Page

__all__ = ["keys_help", "share"]

KEYS = (
    ("Arrows", "move the slider that has the focus"),
    ("Ctrl Z", "undo"),
    ("Ctrl Shift Z", "redo"),
    ("R", "a random variant"),
    ("0", "back to the baseline"),
    ("?", "this help"),
)


def share(page: Page) -> None:
    """Show the state as a link, a command and a script."""
    from nicegui import ui

    link, shell, python = page.recipe()
    with page.client, ui.dialog() as dialog, ui.card().classes("share w-full"):
        dialog.props('aria-label="Share"')
        for title, words in (
            ("Link", link),
            ("In a shell", shell),
            ("In Python", python.rstrip()),
        ):
            ui.html(title, tag="h2", sanitize=False)
            with ui.row().classes("w-full items-start no-wrap"):
                text = ui.element("pre").props(f'data-recipe="{title}" tabindex=0')
                with text:
                    shown = ui.html("", tag="span", sanitize=False)
                shown.set_content(escape(words))
                code = f"() => navigator.clipboard.writeText({json.dumps(words)})"
                button("content_copy", f"Copy: {title}").on("click", js_handler=code)
        ui.button("Close", on_click=dialog.close, color=None).props("flat no-caps").classes(
            "self-end"
        )
    dialog.on("hide", dialog.delete)
    dialog.open()


def keys_help() -> None:
    """Show what keys do."""
    from nicegui import ui

    rows = "".join(
        f"<tr><td>{' '.join(f'<kbd>{k}</kbd>' for k in keys.split())}</td><td>{words}</td></tr>"
        for keys, words in KEYS
    )
    with ui.dialog() as dialog, ui.card():
        dialog.props('aria-label="Keys"')
        ui.html(f'<table class="keys">{rows}</table>', sanitize=False)
        ui.button("Close", on_click=dialog.close, color=None).props("flat no-caps").classes(
            "self-end"
        )
    dialog.on("hide", dialog.delete)
    dialog.open()
