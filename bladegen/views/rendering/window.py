"""A window in which a blade is turned by the mouse and looked at by keys.

`Window` holds the plotter and what is on; `keys` says what each key does.
"""

from functools import partial
from typing import Any

import numpy as np

from bladegen.views.plots.style import INK, STATION
from bladegen.views.rendering import keys
from bladegen.views.rendering.cameras import VIEWS
from bladegen.views.rendering.drawing import (
    add_colour_bar,
    add_lines,
    add_surface,
    add_words,
    dress,
    look,
    shaded,
)
from bladegen.views.rendering.renderer import quietly, require_window
from bladegen.views.rendering.scene import Scene

__all__ = ["Window", "show"]

SIZE = (1600, 900)
MARKS = {True: "x", False: " "}


def show(scene: Scene, *, colour: str = "plain") -> None:
    """Open a window and wait until it is closed.

    Raises
    ------
    RenderError
        If there is no display, or no such colour.
    """
    require_window()
    if colour != "plain":
        scene.field(colour)
    with quietly():
        Window(scene, keys.On(colour=colour), off_screen=False).run()


class Window:
    """A scene in a plotter, and what is on.

    Parameters
    ----------
    scene : Scene
        What there is to see.
    on : keys.On
        What is on at first.
    off_screen : bool
        Draw without a window.
    """

    def __init__(
        self, scene: Scene, on: keys.On | None = None, *, off_screen: bool, size: Any = SIZE
    ) -> None:
        import pyvista as pv

        self.scene, self.on = scene, on or keys.On()
        self.keys = keys.usable(scene.names, tuple(field.name for field in scene.fields))
        self.plotter = pv.Plotter(off_screen=off_screen, window_size=list(size))
        self._aspect = size[0] / size[1]
        dress(self.plotter)
        self._surfaces, self._bars = self._add_surfaces()
        self._layers = self._add_layers()
        add_words(self.plotter, f"{scene.title}\n{scene.caption}", (16, size[1] - 70), 11)
        self._turn()
        self._draw()

    def run(self) -> None:
        """Show the window until it is closed."""
        for key in self.keys:
            action = self.close if key == "q" else partial(self.press, key)
            self.plotter.add_key_event(key, action)
        self._own_letters()
        self.plotter.show(title=f"bladegen - {self.scene.title}")

    def _own_letters(self) -> None:
        """Keep VTK from carrying out its own meanings of letters as well."""
        style = self.plotter.iren.interactor.GetInteractorStyle()
        style.AddObserver("CharEvent", lambda *_: None)

    def close(self) -> None:
        """End `run`."""
        self.plotter.iren.terminate_app()

    def press(self, key: str) -> None:
        """Do what a key does."""
        before, self.on = self.on, keys.pressed(self.on, key)
        if key in keys.TURNS or self.on.view != before.view:
            self._turn()
        self._draw()
        self.plotter.render()

    def legend(self) -> str:
        """Return the keys, what each does, and which are on."""
        on = {*self.on.layers, self.on.colour, self.on.view}
        lines = [
            f"{key} [{MARKS[about.target in on]}] {about.help}"
            if key not in keys.OTHERS
            else f"{key}     {about.help}"
            for key, about in self.keys.items()
        ]
        return "\n".join(lines) if self.on.legend else "h     keys"

    def _add_surfaces(self) -> tuple[dict[str, Any], dict[str, Any]]:
        """Add the surface once in each of its colours; return the actors and their legends."""
        shown = shaded(self.scene.surface, self.scene.fields)
        surfaces = {"plain": add_surface(self.plotter, shown)}
        bars = {}
        for field in self.scene.fields:
            actor = add_surface(self.plotter, shown, field)
            surfaces[field.name] = actor
            bars[field.name] = add_colour_bar(self.plotter, actor, field.label)
        return surfaces, bars

    def _add_layers(self) -> dict[str, list[Any]]:
        layers: dict[str, list[Any]] = {name: [] for name in self.scene.names}
        for layer in self.scene.layers:
            actor = add_lines(self.plotter, layer.lines, layer.colour, layer.width)
            layers[layer.name].append(actor)
        for label in self.scene.labels:
            actor = self.plotter.add_point_labels(
                np.array([label.point]),
                [label.text],
                text_color=label.colour,
                font_size=16,
                shape=None,
                show_points=False,
                always_visible=True,
            )
            layers[label.name].append(actor)
        return layers

    def _turn(self) -> None:
        look(self.plotter, self.scene.surface.vertices, VIEWS[self.on.view], self._aspect)

    def _draw(self) -> None:
        """Show what is on and hide the rest."""
        solid = "wireframe" not in self.on.layers
        for name, actor in self._surfaces.items():
            actor.SetVisibility(solid and name == self.on.colour)
        for name, bar in self._bars.items():
            bar.SetVisibility(solid and name == self.on.colour)
        for name, actors in self._layers.items():
            for actor in actors:
                actor.SetVisibility(name in self.on.layers)
        for actor in self._layers.get("stations", ()):
            actor.prop.color = STATION if self.on.colour == "plain" else INK
        self.plotter.add_text(
            self.legend(), position=(16, 16), font_size=9, font="courier", color=INK, name="legend"
        )
