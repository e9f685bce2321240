"""What stands on a studio page: the bar, the sliders, the checks, the 3D view and the charts."""

from collections.abc import Awaitable, Callable
from dataclasses import replace
from html import escape
from typing import Any

from bladegen.studio.controls import AFFINE, END, START
from bladegen.studio.page.bar import bar, key
from bladegen.studio.page.beside import beside
from bladegen.studio.page.buttons import looks, toggle
from bladegen.studio.page.elements import curves, stage
from bladegen.studio.page.figures import figures
from bladegen.studio.page.legend import legend
from bladegen.studio.page.numbers import number_of, own_number, shape_number
from bladegen.studio.page.section import section
from bladegen.studio.page.tab import Page, Shown

__all__ = ["build"]

# hints and menus stand outside the page's landmarks; each becomes one of its own
LANDMARKS = """new MutationObserver((records) => {
    for (const { addedNodes } of records) for (const node of addedNodes)
        if (node.id?.startsWith("q-portal")) {
            node.setAttribute("role", "region");
            node.setAttribute("aria-label", node.id.replace("q-portal--", "").replaceAll("-", " "));
        }
}).observe(document.body, { childList: true })"""
ICONS = {"good": "check_circle", "near": "warning_amber", "odd": "info", "bad": "error"}
STATUS = {"good": "good", "near": "near its limit", "odd": "worth a look", "bad": "not usable"}
LOFTS: dict[str, tuple[str, dict[str, dict[str, Any]]]] = {
    "Path": (
        "How stations are joined: smoothly, or by the paper's geodesics",
        {"Smooth": {"path": "spline"}, "Geodesics": {"path": "geodesic"}},
    ),
    "Planform": (
        "Chord, twist and axis as given, or without steps of curvature, at most 0.1 % of the "
        "chord and 0.02 deg away",
        {"As given": {"fair": False}, "Fair": {"fair": True}},
    ),
}


def build(page: Page) -> None:
    """Build a tab's page and show its state."""
    from nicegui import ui

    ui.dark_mode(None)
    with ui.element("div").classes("studio"):
        bar(page)
        with ui.element("section").classes("card panel").props('aria-label="Parameters"'):
            _sliders(page)
            checks = _checks()
        view = _view(page)
        figures(page)
        profile = section(page)
        with ui.element("section").classes("card planform").props('aria-label="Planform"'):
            ui.html("Over span", tag="h2", sanitize=False)
            planform = curves()
            planform.on("drag", lambda event: page.drag(**event.args))
            planform.on("settle", page.pause, [])
    ui.run_javascript(LANDMARKS)
    ui.keyboard(on_key=lambda event: key(page, event), ignore=["input", "select", "textarea"])

    def charts(shown: Shown) -> None:
        profile(shown)
        planform.run_method("put", shown.planform)
        checks(shown)
        view(shown)

    page.charts = charts
    page.follow()
    page.refresh()
    if page.trouble:
        page.client.on_connect(lambda: page.say(page.trouble, bad=True))


def _sliders(page: Page) -> None:
    from nicegui import ui

    ui.html("Shape", tag="h2", sanitize=False)
    for mode in range(page.studio.library.space.dimension):
        shape_number(page, page.controls[f"t{mode + 1}"], mode)
    ui.html("Size and planform", tag="h2", sanitize=False)
    for control in AFFINE:
        own_number(page, control)
    ui.html("Along the span", tag="h2", sanitize=False)
    _window(page)
    _choices(page)


def _window(page: Page) -> None:
    def now() -> tuple[float, float]:
        if page.state.window is not None:
            return page.state.window
        window = page.studio.library.baseline(page.state.blade, page.state.loft).window
        return round(window.start, 2), round(window.end, 2)

    def start(value: Any) -> None:
        page.set_window(value, now()[1])

    def end(value: Any) -> None:
        page.set_window(now()[0], value)

    number_of(page, START, lambda: now()[0], start)
    number_of(page, END, lambda: now()[1], end)


def _choices(page: Page) -> None:
    """Put the choices of how the blade is made, each between named ways."""
    from nicegui import ui

    buttons = []
    for name, (tip, ways) in LOFTS.items():
        with ui.element("div").classes("choice").props(f'role=group aria-label="{name}"'):
            ui.label(name).tooltip(tip)
            ui.element("span")
            for words, way in ways.items():
                button = ui.button(words, color=None, on_click=lambda way=way: take(way))
                button.props(f'flat dense no-caps size=12px padding="2px 8px" aria-label="{words}"')
                buttons.append((button, way))

    def take(way: dict[str, Any]) -> Awaitable[None]:
        return page.remake(replace(page.state.loft, **way))

    def follow() -> None:
        loft = page.state.loft
        for button, way in buttons:
            button.props(f"aria-pressed={str(replace(loft, **way) == loft).lower()}")

    page.followers.append(follow)


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
            looks(page.stage)
            toggle("palette", "Colour what lies off the baseline", True, page.stage, "paint")
            beside(page)
            toggle("grid_on", "Outline of the baseline", False, page.stage, "overlay")
        key = legend(page)

    def show(shown: Shown) -> None:
        scene = shown.scene
        key(shown)
        entry = page.studio.library.entry(scene.state.blade)
        title.set_content(escape(entry.label + (", variant" if scene.state.changed else "")))
        tip = scene.sections[-1].mean(axis=0)
        under.set_content(
            f"{tip[2]:.1f} m long, chord to {scene.curves.chord.max():.2f} m, "
            f"prebend {scene.curves.prebend[-1]:+.2f} m{_beside(page, scene.state.beside)}"
        )

    return show


def _beside(page: Page, key: str) -> str:
    """Say which blade stands beside it."""
    library = page.studio.library
    if key not in library.labels:
        return ""
    length = library.baseline(key).blade.length
    return f"<br>beside it {escape(library.labels[key])}, {length:.1f} m long"
