"""The bar of a studio page: its blade, what can be done to it, files to export, and the keys."""

from typing import Any

from bladegen.studio.library import UPLOAD_BYTES, UPLOAD_FILES, UPLOADS
from bladegen.studio.page.buttons import button
from bladegen.studio.page.dialogs.exports import exports
from bladegen.studio.page.dialogs.optimising import optimising
from bladegen.studio.page.dialogs.sharing import keys_help, share
from bladegen.studio.page.tab import Page

__all__ = ["bar", "key"]


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
        words = "Optimise lift over drag of the section"
        button("auto_graph", words, lambda: optimising(page), label="Optimise")
        words = "A link, a command and a script that make this blade"
        button("link", words, lambda: share(page), label="Share")
        menu = ui.button("Export", icon="download", on_click=lambda: exports(page), color=None)
        menu.props('unelevated dense no-caps no-wrap padding="4px 12px" aria-label="Export a file"')
        menu.classes("primary")
        button("contrast", "Light or dark").on("click", js_handler="() => Quasar.Dark.toggle()")
        button("help_outline", "Keys", keys_help, "?")

    def follow() -> None:
        if (select.options, select.value) != (library.labels, page.state.blade):
            select.set_options(library.labels, value=page.state.blade)
        undo.set_enabled(bool(page.history.before))
        redo.set_enabled(bool(page.history.undone))
        reset.set_enabled(page.state != page.state.reset())
        menu.set_enabled(page.scene is None or page.scene.valid)

    page.followers.append(follow)
    select.on_value_change(lambda event: page.pick(event.value))


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
            keys_help()
