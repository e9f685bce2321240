"""Optimise this: lift over drag of the section looked at, over the shape coordinates."""

import asyncio
from tempfile import mkdtemp
from typing import Any

from bladegen.errors import StudioError
from bladegen.studio.page.tab import Page
from bladegen.studio.results.aerodynamics import USUAL, Lift
from bladegen.studio.results.optimum import LIMITS, Optimum, Wish, optimise
from bladegen.studio.results.question import Question

__all__ = ["optimising"]

POLL = 0.2  # s, between two looks at how far it is
REYNOLDS = 8e6  # where no section says it
FIELDS = {  # name: label, factor, step, decimals, unit
    "angle": ("Angle of attack", 1.0, 0.1, "deg"),
    "band": ("as much on either side", 1.0, 0.5, "deg"),
    "reach": ("Of the data's range at most", 100.0, 5, "%"),
    "area": ("Area may grow by", 100.0, 1, "%"),
}


def optimising(page: Page) -> None:
    """Let a run be wished for, watched and cancelled; what it finds is one step to undo."""
    from nicegui import ui

    lift = _known(page)
    wished = {
        "angle": round(lift.at if lift else USUAL, 1),
        "band": Wish.band,
        "reach": Wish.reach,
        "area": Wish.area,
    }
    run: dict[str, Any] = {"wish": None}
    with page.client, ui.dialog() as dialog, ui.card().classes("optimising"):
        dialog.props('aria-label="Optimise"')
        title = f"Optimise the section at {100 * page.state.at:.0f} %"
        ui.html(title, tag="h2", sanitize=False)
        ui.html(
            "The most lift over drag, by NeuralFoil, over the four shape coordinates; all else "
            "stays as it is, and no section of the blade shall be odd.",
            tag="p",
            sanitize=False,
        )
        fields = {name: _field(name, wished[name]) for name in FIELDS}
        said = ui.label("").classes("told").props("role=status")
        with ui.row().classes("self-end"):
            start = ui.button("Start", color=None).props("unelevated no-caps").classes("primary")
            stop = ui.button("Close", color=None).props("flat no-caps")

    def close() -> None:
        if run["wish"] is not None:
            run["wish"].cancel()
            said.set_text("ending ...")
        else:
            dialog.close()

    async def begin() -> None:
        state, library = page.state, page.studio.library
        entry = library.entry(state.blade)
        try:
            given = {name: fields[name]() for name in FIELDS}
            wish = Wish(
                Question(entry.source, entry.airfoils, state),
                mkdtemp(prefix="optimum-", dir=page.studio.folder),
                reynolds=lift.reynolds if lift else REYNOLDS,
                **given,
            )
        except (StudioError, ValueError) as error:
            said.set_text(str(error))
            return
        run["wish"] = wish
        start.set_enabled(False)
        stop.set_text("Cancel")
        said.set_text("starting ...")
        try:
            found = await _awaited(page, wish, said)
        except (StudioError, RuntimeError) as error:
            said.set_text(" ".join(str(error).split()))
        else:
            _take(page, found, said)
        run["wish"] = None
        start.set_enabled(True)
        stop.set_text("Close")

    def gone() -> None:
        if run["wish"] is not None:
            run["wish"].cancel()
        dialog.delete()

    start.on_click(begin)
    stop.on_click(close)
    dialog.on("hide", gone)
    dialog.open()


def _known(page: Page) -> Lift | None:
    """Return lift and drag of the section looked at, if they are known."""
    answer = page.live.section
    return answer.lift.now if answer is not None and answer.state.at == page.state.at else None


def _field(name: str, value: float) -> Any:
    """Put a number; return what reads it."""
    from nicegui import ui

    label, factor, step, unit = FIELDS[name]
    low, high = (factor * end for end in LIMITS[name])
    now = {"text": f"{factor * value:g}"}
    with ui.element("div").classes("choice"):
        ui.html(label, tag="label", sanitize=False).props(f"for=wish-{name}")
        ui.element("span")
        field = ui.element("input").props(
            f"id=wish-{name} type=number min={low:g} max={high:g} step={step} value={now['text']}"
        )
        ui.label(unit)

    def take(event: Any) -> None:
        now["text"] = event.args

    field.on("change", take, js_handler="(event) => emit(event.target.value)")
    return lambda: float(now["text"]) / factor


async def _awaited(page: Page, wish: Wish, said: Any) -> Optimum:
    """Wait for a run, saying how far it is."""
    future = page.studio.knower.submit(optimise, wish)
    while not future.done():
        await asyncio.sleep(POLL)
        if page.client.is_deleted:
            wish.cancel()
        if wish.progress is not None:
            count, first, best = wish.progress
            said.set_text(f"evaluation {count}: lift over drag {first:.1f} \u2192 {best:.1f}")
    return future.result()


def _take(page: Page, found: Optimum, said: Any) -> None:
    """Show what was found, a step of the history, and say what it is worth."""
    if found.cancelled:
        said.set_text("cancelled; nothing has changed")
    elif found.state == page.state:
        said.set_text(f"nothing better was found than lift over drag of {found.before:.1f}")
    else:
        page.move(page.history.moved(found.state))
        said.set_text(
            f"lift over drag {found.before:.1f} \u2192 {found.after:.1f} in {found.evaluations} "
            "evaluations; Undo takes it back"
        )
