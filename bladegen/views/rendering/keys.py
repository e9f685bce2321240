"""The keys of the window and of the page: what each shows, hides, colours or turns to.

`pressed` maps what is on and a key to what is on then; drawing it is left to others.
"""

from dataclasses import dataclass, replace

__all__ = ["COLOURS", "LAYERS", "OTHERS", "TURNS", "Key", "On", "help_text", "pressed", "usable"]


@dataclass(frozen=True)
class Key:
    """What a key is about, and what help says of it."""

    target: str
    help: str


@dataclass(frozen=True)
class On:
    """What is on: layers, the colours (a field's name or "plain"), the view, the legend."""

    layers: frozenset[str] = frozenset({"stations"})
    colour: str = "plain"
    view: str = "oblique"
    legend: bool = True


LAYERS = {
    "s": Key("sections", "sections, 41 over the span"),
    "w": Key("wireframe", "wireframe instead of the surface"),
    "t": Key("stations", "stations of the definition"),
    "b": Key("frame", "blade frame and reference axis"),
    "g": Key("baseline", "the baseline's sections"),
}
COLOURS = {
    "c": Key("curvature", "mean curvature as colour"),
    "d": Key("distance", "distance to the baseline as colour"),
}
TURNS = {
    "1": Key("oblique", "oblique"),
    "2": Key("suction side", "suction side"),
    "3": Key("pressure side", "pressure side"),
    "4": Key("trailing edge", "trailing edge"),
    "5": Key("leading edge", "leading edge"),
    "6": Key("tip", "from the tip"),
}
OTHERS = {"h": Key("keys", "show or hide the keys"), "q": Key("quit", "close the window")}


def usable(layers: tuple[str, ...], fields: tuple[str, ...]) -> dict[str, Key]:
    """Return the keys that have something to show: of a scene's layers and fields, and views."""
    kept = {key: about for key, about in LAYERS.items() if about.target in layers}
    kept |= {key: about for key, about in COLOURS.items() if about.target in fields}
    return kept | TURNS | OTHERS


def pressed(on: On, key: str) -> On:
    """Return what is on after a key; a layer or colour that is on goes off."""
    if key in LAYERS:
        return replace(on, layers=on.layers ^ {LAYERS[key].target})
    if key in COLOURS:
        colour = COLOURS[key].target
        return replace(on, colour="plain" if on.colour == colour else colour)
    if key in TURNS:
        return replace(on, view=TURNS[key].target)
    if key == "h":
        return replace(on, legend=not on.legend)
    return on


def help_text() -> str:
    """Return all keys in a sentence, for the command line's help."""
    words = [f"{key} {about.help}" for key, about in (LAYERS | COLOURS | TURNS | OTHERS).items()]
    return "Keys in the window and on the page: " + ", ".join(words) + "."
