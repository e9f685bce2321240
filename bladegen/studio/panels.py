"""What stands on a studio page: the bar, the sliders, the checks, the 3D view and the charts."""

import json
from collections.abc import Callable
from html import escape
from typing import Any

from bladegen.studio.elements import number, stage
from bladegen.studio.library import UPLOAD_BYTES, UPLOAD_FILES, UPLOADS
from bladegen.studio.page import Page, Shown
from bladegen.studio.state import AFFINE, END, START, Control
from bladegen.studio.worker import formats

__all__ = ["build"]

ICONS = {"good": "check_circle", "odd": "info", "bad": "error"}
STATUS = {"good": "good", "odd": "worth a look", "bad": "not usable"}
VIEWS = {
    "blade": ("Whole blade", "Blade"),
    "root": ("The root", "Root"),
    "tip": ("The tip", "Tip"),
    "flat": ("From the suction side", "Flat"),
    "edge": ("From the trailing edge", "Edge"),
}
KEYS = (
    ("Arrows", "move the slider that has the focus"),
    ("Ctrl Z", "undo"),
    ("Ctrl Shift Z", "redo"),
    ("R", "a random variant"),
    ("0", "back to the baseline"),
    ("?", "this help"),
)


def build(page: Page) -> None:
    """Build a tab's page and show its state."""
    from nicegui import ui

    ui.dark_mode(None)
    with ui.element("main").classes("studio"):
        _bar(page)
        with ui.element("section").classes("card panel").props('aria-label="Parameters"'):
            _sliders(page)
            checks = _checks()
        legend = _view(page)
        section = _section(page)
        with ui.element("section").classes("card planform").props('aria-label="Planform"'):
            ui.html("Over span", tag="h2", sanitize=False)
            planform = ui.html("", sanitize=False).classes("plot")
    ui.keyboard(on_key=lambda event: _key(page, event), ignore=["input", "select", "textarea"])

    def charts(shown: Shown) -> None:
        section.set_content(shown.section)
        planform.set_content(shown.planform)
        checks(shown)
        legend(shown)

    page.charts = charts
    page.follow()
    page.refresh()
    if page.trouble:
        page.client.on_connect(lambda: page.say(page.trouble, bad=True))


def _button(icon: str, words: str, act: Any = None, keys: str = "", label: str = "") -> Any:
    """Put a quiet button: an icon, perhaps a word, and what it does as its name."""
    from nicegui import ui

    button = ui.button(label, icon=icon, on_click=act, color=None)
    button.props(f'flat dense no-caps no-wrap aria-label="{words}"')
    button.props('padding="4px 9px"' if label else "round")
    button.tooltip(f"{words} ({keys})" if keys else words)
    return button


def _bar(page: Page) -> None:
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

        _button(
            "upload_file",
            "Load a blade, with the airfoil files that it names",
            lambda: upload.run_method("pickFiles"),
        )
        ui.element("span").classes("push")
        undo = _button("undo", "Undo", page.undo, "Ctrl Z")
        redo = _button("redo", "Redo", page.redo, "Ctrl Shift Z")
        reset = _button("restart_alt", "Reset to the baseline", page.reset, "0")
        _button("casino", "A random sound variant", page.draw, "R", "Random")
        words = "A link, a command and a script that make this blade"
        _button("link", words, lambda: _share(page), label="Share")
        with (
            ui.dropdown_button("Export", icon="download", auto_close=True, color=None)
            .props('unelevated dense no-caps no-wrap padding="4px 12px" aria-label="Export a file"')
            .classes("primary") as export
        ):
            for suffix, words in formats().items():
                with ui.item(on_click=lambda suffix=suffix: page.export(suffix)) as item:
                    item.props(f'dense aria-label="Export {suffix}: {words}"').classes("format")
                    ui.html(f"<b>{suffix}</b> {escape(words)}", sanitize=False)
        _button("contrast", "Light or dark").on("click", js_handler="() => Quasar.Dark.toggle()")
        _button("help_outline", "Keys", _help, "?")

    def follow() -> None:
        if (select.options, select.value) != (library.labels, page.state.blade):
            select.set_options(library.labels, value=page.state.blade)
        undo.set_enabled(bool(page.history.before))
        redo.set_enabled(bool(page.history.undone))
        reset.set_enabled(page.state != page.state.reset())
        export.set_enabled(page.scene is None or page.scene.valid)

    page.followers.append(follow)
    select.on_value_change(lambda event: page.pick(event.value))


def _sliders(page: Page) -> None:
    from nicegui import ui

    ui.html("Shape", tag="h2", sanitize=False)
    for name, control in page.controls.items():
        if name.startswith("t") and name[1:].isdigit():
            _plain_number(page, control)
    ui.html("Size and planform", tag="h2", sanitize=False)
    for control in AFFINE:
        _plain_number(page, control)
    ui.html("Along the span", tag="h2", sanitize=False)
    _window(page)


def _plain_number(page: Page, control: Control) -> None:
    name = control.name
    _number(page, control, lambda: page.state.value(name), lambda value: page.set(name, value))


def _number(
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


def _window(page: Page) -> None:
    def now() -> tuple[float, float]:
        if page.state.window is not None:
            return page.state.window
        window = page.studio.library.baseline(page.state.blade).window
        return round(window.start, 2), round(window.end, 2)

    def start(value: Any) -> None:
        page.set_window(value, now()[1])

    def end(value: Any) -> None:
        page.set_window(now()[0], value)

    _number(page, START, lambda: now()[0], start)
    _number(page, END, lambda: now()[1], end)


def _checks() -> Callable[[Shown], None]:
    from nicegui import ui

    ui.html("Checks", tag="h2", sanitize=False)
    rows: list[tuple[Any, Any, Any]] = []
    board = ui.element("ul").classes("checks").props('aria-label="Checks"')

    def show(shown: Shown) -> None:
        checks = shown.scene.checks
        with board:
            while len(rows) < len(checks):
                with ui.element("li") as row:
                    icon = ui.icon("check_circle").props("role=img")
                    ui.label(checks[len(rows)].what)
                    rows.append((row, icon, ui.label().classes("figure")))
        for (row, icon, figure), check in zip(rows, checks, strict=True):
            row.classes(replace=check.status)
            row.props(f'data-check="{check.what}"')
            icon.set_name(ICONS[check.status])
            icon.props(f'aria-label="{STATUS[check.status]}"')
            figure.set_text(check.figure)

    return show


def _view(page: Page) -> Callable[[Shown], None]:
    from nicegui import ui

    with ui.element("section").classes("card view").props('aria-label="3D view"'):
        page.stage = stage()
        with ui.element("div").classes("caption"):
            title = ui.html("", tag="b", sanitize=False)
            under = ui.html("", tag="span", sanitize=False)
        with ui.element("div").classes("views").props('role=toolbar aria-label="View"'):
            for view, (words, label) in VIEWS.items():
                button = ui.button(label, color=None)
                button.props(f'flat dense no-caps size=12px padding="2px 8px" aria-label="{words}"')
                button.on_click(lambda view=view: page.stage.run_method("look", view))
            _toggle("palette", "Colour what lies off the baseline", True, page.stage, "paint")
            _toggle("grid_on", "Outline of the baseline", False, page.stage, "overlay")
        with ui.element("div").classes("legend") as legend:
            ui.label("off the baseline, along its normal")
            ui.element("i")
            with ui.element("div").classes("ends"):
                into, out = ui.label(), ui.label()

    def show(shown: Shown) -> None:
        scene = shown.scene
        most = float(abs(scene.deviation).max())
        legend.set_visibility(most >= 5e-4)
        into.set_text(f"\u2212{1e3 * most:.0f} mm")
        out.set_text(f"+{1e3 * most:.0f} mm")
        entry = page.studio.library.entry(scene.state.blade)
        title.set_content(escape(entry.label + (", variant" if scene.state.changed else "")))
        tip = scene.sections[-1].mean(axis=0)
        under.set_content(
            f"{tip[2]:.1f} m long, chord to {scene.curves.chord.max():.2f} m, "
            f"prebend {scene.curves.prebend[-1]:+.2f} m"
        )

    return show


def _toggle(icon: str, words: str, on: bool, view: Any, method: str) -> None:
    from nicegui import ui

    button = ui.button(icon=icon, color=None)
    button.props(f'flat dense size=12px padding="2px 6px" aria-label="{words}"')
    button.props(f"aria-pressed={str(on).lower()}").tooltip(words)
    state = {"on": on}

    def act() -> None:
        state["on"] = not state["on"]
        button.props(f"aria-pressed={str(state['on']).lower()}")
        view.run_method(method, state["on"])

    button.on_click(act)


def _section(page: Page) -> Any:
    from nicegui import ui

    with ui.element("section").classes("card section").props('aria-label="Section"'):
        with ui.element("div").classes("head"):
            _plain_number(page, page.controls["at"])
            words = ui.label().classes("figure")
            placed = _button("straighten", "As it stands in the blade, in metres")
            placed.props("aria-pressed=false")
        drawing = ui.html("", sanitize=False).classes("plot")

    def turn() -> None:
        page.place(not page.placed)
        placed.props(f"aria-pressed={str(page.placed).lower()}")

    placed.on_click(turn)

    def follow() -> None:
        length = page.studio.library.baseline(page.state.blade).blade.length
        words.set_text(f"{page.state.at * length:.1f} m")

    page.followers.append(follow)
    return drawing


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
                _button("content_copy", f"Copy: {title}").on("click", js_handler=code)
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


async def _key(page: Page, event: Any) -> None:
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
