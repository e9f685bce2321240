"""Quiet buttons of a studio page: an icon, perhaps a word, and what it does as its name."""

from typing import Any

__all__ = ["button", "looks", "toggle"]

VIEWS = {
    "blade": ("Whole blade", "Blade"),
    "root": ("The root", "Root"),
    "tip": ("The tip", "Tip"),
    "flat": ("From the suction side", "Flat"),
    "edge": ("From the trailing edge", "Edge"),
}


def button(icon: str, words: str, act: Any = None, keys: str = "", label: str = "") -> Any:
    """Put a quiet button: an icon, perhaps a word, and what it does as its name."""
    from nicegui import ui

    button = ui.button(label, icon=icon, on_click=act, color=None)
    button.props(f'flat dense no-caps no-wrap aria-label="{words}"')
    button.props('padding="4px 9px"' if label else "round")
    button.tooltip(f"{words} ({keys})" if keys else words)
    return button


def toggle(icon: str, words: str, on: bool, view: Any, method: str) -> None:
    """Put a button that is pressed or not, and tells a view which."""
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


def looks(stage: Any) -> None:
    """Put buttons that look at the blade from named places; the last one is pressed."""
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
