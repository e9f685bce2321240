"""What colours on the blade mean: which part of the difference from the baseline, and how much."""

from collections.abc import Callable

from bladegen.studio.choices.difference import PARTS
from bladegen.studio.page.tab import Page, Shown

__all__ = ["legend"]

SHORT = {"all": "all", "rigid": "no motion", "affine": "no affine map"}
LEAST = 5e-4  # m, less of which is none


def legend(page: Page) -> Callable[[Shown], None]:
    """Put the legend; return what shows another state."""
    from nicegui import ui

    with ui.element("div").classes("legend"):
        with ui.element("div").classes("choice").props('role=group aria-label="Coloured"'):
            buttons = {}
            for part, words in PARTS.items():
                button = ui.button(SHORT[part], color=None)
                button.props(f'flat dense no-caps size=11px padding="0 6px" aria-label="{words}"')
                button.tooltip(words).on_click(lambda part=part: page.choose(off=part))
                buttons[part] = button
        with ui.element("div") as scale:
            ui.label("off the baseline, along its normal")
            ui.element("i")
            with ui.element("div").classes("ends"):
                into, out = ui.label(), ui.label()
        nothing = ui.label("nowhere off the baseline")

    def follow() -> None:
        for part, button in buttons.items():
            button.props(f"aria-pressed={str(part == page.state.off).lower()}")

    def show(shown: Shown) -> None:
        most = float(abs(shown.scene.deviation).max())
        scale.set_visibility(most >= LEAST)
        nothing.set_visibility(most < LEAST)
        into.set_text(f"\u2212{1e3 * most:.0f} mm")
        out.set_text(f"+{1e3 * most:.0f} mm")

    page.followers.append(follow)
    return show
