"""The bar of a studio page: its blade, what can be done to it, files to export, and the keys."""

import json
from html import escape
from typing import Any

from bladegen.studio.library import UPLOAD_BYTES, UPLOAD_FILES, UPLOADS
from bladegen.studio.page.buttons import button
from bladegen.studio.page.downloads import export
from bladegen.studio.page.tab import Page
from bladegen.studio.worker import formats

__all__ = ["bar", "key"]

KEYS = (
    ("Arrows", "move the slider that has the focus"),
    ("Ctrl Z", "undo"),
    ("Ctrl Shift Z", "redo"),
    ("R", "a random variant"),
    ("0", "back to the baseline"),
    ("?", "this help"),
)


def bar(page: Page) -> None:
    """Put the bar."""
    from nicegui import ui

    with ui.element("header").classes("bar"):
        ui.html("bladegen <span>studio</span>", tag="h1", sanitize=False)
        library = page.studio.library
        select = ui.select(library.labels, value=page.state.blade)
        select.props('dense options-dense borderless aria-label="Blade"').classes("w-40")

        async def took(event: Any) -> None:
            await page.load(*[(file.name, await file.read()) for file in event.files])
            upload.reset()

        upload = ui.upload(
            multiple=True,
            max_total_size=UPLOAD_BYTES,
            max_files=UPLOAD_FILES,
            auto_upload=True,
            on_multi_upload=took,
            on_rejected=lambda: page.say(
                f"files: must end in {', '.join(UPLOADS)} and have at most {UPLOAD_BYTES >> 20} MB "
                f"together, {UPLOAD_FILES} of them",
                bad=True,
            ),
        ).classes("away")
        upload.props(f'accept="{",".join(UPLOADS)}" aria-hidden=true tabindex=-1')

        button(
            "upload_file",
            "Load a blade, with the airfoil files that it names",
            lambda: upload.run_method("pickFiles"),
        )
        ui.element("span").classes("push")
        undo = button("undo", "Undo", page.undo, "Ctrl Z")
        redo = button("redo", "Redo", page.redo, "Ctrl Shift Z")
        reset = button("restart_alt", "Reset to the baseline", page.reset, "0")
        button("casino", "A random sound variant", page.draw, "R", "Random")
        words = "A link, a command and a script that make this blade"
        button("link", words, lambda: _share(page), label="Share")
        with (
            ui.dropdown_button("Export", icon="download", auto_close=True, color=None)
            .props('unelevated dense no-caps no-wrap padding="4px 12px" aria-label="Export a file"')
            .classes("primary") as menu
        ):
            for suffix, words in formats().items():
                with ui.item(on_click=lambda suffix=suffix: export(page, suffix)) as item:
                    item.props(f'dense aria-label="Export {suffix}: {words}"').classes("format")
                    ui.html(f"<b>{suffix}</b> {escape(words)}", sanitize=False)
        button("contrast", "Light or dark").on("click", js_handler="() => Quasar.Dark.toggle()")
        button("help_outline", "Keys", _help, "?")

    def follow() -> None:
        if (select.options, select.value) != (library.labels, page.state.blade):
            select.set_options(library.labels, value=page.state.blade)
        undo.set_enabled(bool(page.history.before))
        redo.set_enabled(bool(page.history.undone))
        reset.set_enabled(page.state != page.state.reset())
        menu.set_enabled(page.scene is None or page.scene.valid)

    page.followers.append(follow)
    select.on_value_change(lambda event: page.pick(event.value))


def _share(page: Page) -> None:
    from nicegui import ui

    link, shell, python = page.recipe()
    with page.client, ui.dialog() as dialog, ui.card().classes("share w-full"):
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


def _help() -> None:
    from nicegui import ui

    rows = "".join(
        f"<tr><td>{' '.join(f'<kbd>{k}</kbd>' for k in keys.split())}</td><td>{words}</td></tr>"
        for keys, words in KEYS
    )
    with ui.dialog() as dialog, ui.card():
        ui.html(f'<table class="keys">{rows}</table>', sanitize=False)
        ui.button("Close", on_click=dialog.close, color=None).props("flat no-caps").classes(
            "self-end"
        )
    dialog.on("hide", dialog.delete)
    dialog.open()


async def key(page: Page, event: Any) -> None:
    """Do what a key is for."""
    if not event.action.keydown:
        return
    key, control = str(event.key).lower(), event.modifiers.ctrl or event.modifiers.meta
    if control and key == "z":
        (page.redo if event.modifiers.shift else page.undo)()
    elif control and key == "y":
        page.redo()
    elif control or event.modifiers.alt or event.action.repeat:
        return
    elif key == "r":
        await page.draw()
    elif key == "0":
        page.reset()
    elif key == "?":
        with page.client:
            _help()
