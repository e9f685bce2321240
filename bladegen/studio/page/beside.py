"""Another blade of the library, as it is, beside the one that is changed."""

from typing import Any

from bladegen.studio.page.tab import Page

__all__ = ["beside"]

WORDS = "Another blade beside it"


def beside(page: Page) -> None:
    """Put the button that picks one."""
    from nicegui import ui

    button = ui.button(icon="compare_arrows", color=None)
    button.props(f'flat dense size=12px padding="2px 6px" aria-label="{WORDS}"').tooltip(WORDS)
    with button:
        menu = ui.menu().props("role=menu")

    def item(label: str, key: str) -> Any:
        one = ui.menu_item(label, on_click=lambda: page.put_beside(key))
        return one.props("role=menuitem")

    def fill() -> None:
        menu.clear()
        with menu:
            item("None", "")
            for key, label in page.studio.library.labels.items():
                item(label, key)

    def follow() -> None:
        button.props(f"aria-pressed={str(bool(page.state.beside)).lower()}")

    button.on_click(fill)
    page.followers.append(follow)
