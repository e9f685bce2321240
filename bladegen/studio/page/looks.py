"""Buttons that look at the blade from named places; the last one is pressed."""

from typing import Any

__all__ = ["looks"]

VIEWS = {
    "blade": ("Whole blade", "Blade"),
    "root": ("The root", "Root"),
    "tip": ("The tip", "Tip"),
    "flat": ("From the suction side", "Flat"),
    "edge": ("From the trailing edge", "Edge"),
}


def looks(stage: Any) -> None:
    """Put the buttons of a 3D view."""
    from nicegui import ui

    buttons: dict[str, Any] = {}

    def look(view: str) -> None:
        stage.run_method("look", view)
        for name, button in buttons.items():
            button.props(f"aria-pressed={str(name == view).lower()}")

    for view, (words, label) in VIEWS.items():
        button = ui.button(label, color=None, on_click=lambda view=view: look(view))
        button.props(f'flat dense no-caps size=12px padding="2px 8px" aria-label="{words}"')
        button.props(f"aria-pressed={str(view == 'blade').lower()}")
        buttons[view] = button
