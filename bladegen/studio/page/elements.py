"""The page's own elements: the 3D view, the number with its slider, curves with handles.

What they do in the browser stands in ``stage.js``, ``number.js`` and ``curves.js``.  three.js comes
with the web framework, so nothing is fetched from elsewhere.
"""

from functools import cache
from pathlib import Path
from typing import Any

from bladegen.studio.controls import Control

__all__ = ["curves", "number", "stage"]

WORDS = "The blade in 3D. Drag to turn it, scroll to come nearer; the figures stand beside it."


def stage() -> Any:
    """Put a 3D view on the page that is being built.

    Its methods, called by `run_method`: ``show(url, baseline)``, ``paint(colours)``,
    ``overlay(visible)``, ``look(view)``, ``beside(url)``.
    """
    element = _kind("stage")()
    element.props["label"] = WORDS
    return element


def number(control: Control, value: float, *, peeks: bool = False) -> Any:
    """Put a label, a slider and a field for a number on the page that is being built.

    Its events: ``move`` with a value while the slider moves, ``settle`` when it is let go, ``type``
    with the text of the field, ``peek`` when somebody wants to see what it does, if it `peeks`.
    Its methods: ``put(value)`` shows another value, ``picture(html)`` what it does.
    """
    element = _kind("number")()
    element.props.update(
        name=control.name,
        label=control.label,
        hint=control.hint,
        unit=control.unit,
        low=float(control.low),
        high=float(control.high),
        step=float(control.step),
        places=control.places,
        first=value,
        effect=control.effect,
        peeks=peeks,
    )
    return element


def curves() -> Any:
    """Put curves whose handles are dragged on the page that is being built.

    Its events: ``drag`` with curve, knot and the wanted value, none for back to the baseline, and
    ``settle`` when a handle is let go.  Its method: ``put(picture)``.
    """
    return _kind("curves")()


@cache
def _kind(name: str) -> type[Any]:
    """Return an element's class, made once the web framework is loaded."""
    from nicegui import ui

    _ = ui.scene  # whose bundle holds three.js

    class Own(ui.element, component=Path(__file__).parent / f"{name}.js"):
        pass

    return Own
