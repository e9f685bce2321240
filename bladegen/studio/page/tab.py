"""One tab of the studio: its controls, what they do, and what it shows.

Every tab has a `Page` of its own and shares nothing with others but the library.  Moves of a
slider run through `move`; the geometry is made on a thread, one at a time and always the latest,
and what comes out is shown at once: surface, charts, checks, buttons and the tab's address.
"""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, replace
from math import isfinite
from secrets import token_urlsafe
from typing import Any

import numpy as np

from bladegen.errors import BladegenError, StudioError
from bladegen.studio import recipes
from bladegen.studio.choices.drawn import CURVES, KNOTS
from bladegen.studio.choices.loft import Loft
from bladegen.studio.controls import Control, controls
from bladegen.studio.page import charts
from bladegen.studio.page.live import Live
from bladegen.studio.scene import Scene
from bladegen.studio.shared import Studio
from bladegen.studio.state import History, State, from_query, to_query

__all__ = ["Page", "Shown"]


@dataclass(frozen=True, eq=False)
class Shown:
    """What is sent to a tab for a state."""

    scene: Scene
    packets: tuple[bytes, bytes, bytes]
    section: str
    planform: str


class Page:
    """A tab's state, and the elements that show it; `panels.build` makes these."""

    def __init__(self, studio: Studio, query: str) -> None:
        from nicegui import context

        self.studio = studio
        self.client = context.client
        self.name = token_urlsafe(12)
        self.controls: dict[str, Control] = controls(studio.library.space)
        self.trouble = ""
        try:
            state = from_query(query, self.controls, studio.first)
        except StudioError as error:
            self.trouble = str(error)
            state = from_query("", self.controls, studio.first)
        self.history = History(state)
        self.placed = False
        self.scene: Scene | None = None
        self.followers: list[Callable[[], None]] = []
        self.stage: Any = None
        self.charts: Callable[[Shown], None] = lambda _: None
        self.live = Live(studio, lambda: self.client.is_deleted)
        self._wanted: State | None = None
        self._working = False
        self._beside = ""
        self._count = 0
        self._rng = np.random.default_rng()
        self.client.on_delete(lambda: studio.packets.pop(self.name, None))

    @property
    def state(self) -> State:
        """What is shown, or will be in a moment."""
        return self.history.present

    def set(self, name: str, value: object) -> None:
        """Move a control; a value that is not allowed is said and changes nothing."""
        self._try(lambda: self.state.having(self.controls[name], value), name)

    def set_window(self, start: object, end: object) -> None:
        """Move the window."""
        self._try(lambda: self.state.within(start, end), "window")

    def drag(self, curve: str, knot: int, value: float | None) -> None:
        """Drag a curve over span at a knot; without a value back to where it was."""
        state = self.state
        if not (curve in CURVES and knot in range(len(KNOTS)) and isfinite(value or 0.0)):
            return
        if value is None:
            found = state.dragged(curve, knot, CURVES[curve].identity)
        else:
            baseline = self.studio.library.baseline(state.blade, state.loft)
            found = baseline.dragged(state, curve, knot, value)
        self.move(self.history.moved(found, f"{curve} {knot}"))

    def _try(self, make: Callable[[], State], control: str) -> None:
        try:
            self.move(self.history.moved(make(), control))
        except StudioError as error:
            self.say(str(error), bad=True)
            self.follow()

    def pause(self) -> None:
        """A control was let go: what comes next is a step of its own."""
        self.history = self.history.paused()

    def undo(self) -> None:
        """Go one step back."""
        self.move(self.history.undo())

    def redo(self) -> None:
        """Go one step forth."""
        self.move(self.history.redo())

    def reset(self) -> None:
        """Go back to the baseline; a step that can be undone."""
        self.move(self.history.moved(self.state.reset()))

    async def prepared(self) -> None:
        """Prepare the blade that a link names; one that cannot be is said and not shown."""
        from nicegui import run

        try:
            await run.io_bound(self.studio.library.baseline, self.state.blade, self.state.loft)
            if self.state.beside:
                await run.io_bound(self.studio.library.baseline, self.state.beside)
        except BladegenError as error:
            self.trouble = str(error)
            self.history = History(from_query("", self.controls, self.studio.first))

    async def pick(self, key: str) -> None:
        """Show another blade of the library."""
        if key != self.state.blade:
            await self._take(self.state.baseline(key))

    async def put_beside(self, key: str) -> None:
        """Show another blade beside this one, or none; what cannot be prepared is said."""
        from nicegui import run

        try:
            if key:
                await run.io_bound(self.studio.library.baseline, key)
        except BladegenError as error:
            self.say(str(error), bad=True)
        else:
            self.choose(beside=key)

    async def remake(self, loft: Loft) -> None:
        """Make the blade another way; its changes stay."""
        if loft != self.state.loft:
            await self._take(replace(self.state, loft=loft))

    async def _take(self, state: State) -> None:
        """Show a state whose blade is first prepared; one that cannot be is said."""
        from nicegui import run

        try:
            await run.io_bound(self.studio.library.baseline, state.blade, state.loft)
        except BladegenError as error:
            self.say(str(error), bad=True)
            self.follow()
        else:
            self.move(self.history.moved(state))

    def choose(self, **choices: Any) -> None:
        """Choose what colours mean, or how files are written; not a step of the history."""
        self._try(lambda: replace(self.state, **choices), "")

    async def draw(self) -> None:
        """Show a random sound variant."""
        from nicegui import run

        state = self.state

        def drawn() -> State:
            baseline = self.studio.library.baseline(state.blade, state.loft)
            return baseline.drawn(state, self._rng)

        found = await run.io_bound(drawn)
        if found is not None:  # which it is when the studio ends
            self.move(self.history.moved(found))

    async def load(self, *files: tuple[str, bytes]) -> None:
        """Take a blade's files that were uploaded; what is no blade is said and changes nothing."""
        from nicegui import run

        try:
            key = await run.io_bound(self.studio.library.upload, *files)
        except BladegenError as error:
            self.say(str(error), bad=True)
            return
        if key is None:
            return
        await self.pick(key)
        self.say(f"loaded {self.studio.library.entry(key).label}")

    def place(self, placed: bool) -> None:
        """Draw the section as it stands in the blade, or along its own chord."""
        self.placed = placed
        self.refresh()

    def move(self, history: History) -> None:
        """Take a new history and show its present."""
        self.history = history
        self.follow()
        self.refresh()

    def follow(self) -> None:
        """Let the controls show the state."""
        for follower in self.followers:
            follower()

    def refresh(self) -> None:
        """Show the state; while one is being made, only the latest of the others waits."""
        from nicegui import background_tasks

        self._wanted = self.state
        if not self._working:
            self._working = True
            background_tasks.create(self._work())

    async def _work(self) -> None:
        from nicegui import run

        before = (self.scene.state.blade, self.scene.state.loft) if self.scene else None
        try:
            while self._wanted is not None:
                state, self._wanted = self._wanted, None
                shown = await run.io_bound(self.made, state)
                if shown is None:  # the studio ends
                    return
                now = state.blade, state.loft
                await self._show(shown, refit=now != before)
                before = now
        except BladegenError as error:
            self.say(str(error), bad=True)
            self.history = self.history.undo()
            self.follow()
        finally:
            self._working = False

    def made(self, state: State) -> Shown:
        """Make all that a state shows; on a thread."""
        baseline = self.studio.library.baseline(state.blade, state.loft)
        scene = baseline.scene(state)
        plain = baseline.at(state.at)
        other = b""
        if state.beside in self.studio.library.labels:  # an upload may be gone
            other = self.studio.library.baseline(state.beside).at(state.at).packet()
        return Shown(
            scene,
            (scene.packet(), plain.packet(), other),
            charts.section(scene, plain, placed=self.placed),
            charts.planform(scene, plain),
        )

    async def _show(self, shown: Shown, *, refit: bool) -> None:
        if self.client.is_deleted:  # while this was made; nobody would take it away again
            return
        self.scene = shown.scene
        self.studio.packets[self.name] = shown.packets
        self._count += 1
        self.live.ask(shown.scene.state)
        self.studio.worker.begin()  # it needs some seconds, and somebody may export soon
        place = f"/studio/{self.name}/{self._count}"
        self.stage.run_method("show", f"{place}/now", f"{place}/baseline" if refit else "")
        if shown.scene.state.beside != self._beside:
            self._beside = shown.scene.state.beside
            self.stage.run_method("beside", f"{place}/beside" if shown.packets[2] else "")
        if not refit:  # the browser asks for the surface while it is told the rest
            await asyncio.sleep(0)
        self.charts(shown)
        self.follow()
        address = f"?{to_query(shown.scene.state)}"
        self.client.run_javascript(f"history.replaceState(null, '', {address!r})")

    def recipe(self) -> tuple[str, str, str]:
        """Return the state as a link, as a command and as a script."""
        state, library = self.state, self.studio.library
        entry = library.entry(state.blade)
        stem = library.baseline(state.blade, state.loft).stem(state)
        return (
            f"{self.client.request.base_url}?{to_query(state)}",
            recipes.shell(state, entry, stem),
            recipes.python(state, entry, stem),
        )

    def say(self, words: str, *, bad: bool = False) -> None:
        """Show one line for a while."""
        from nicegui import ui

        with self.client:
            ui.notify(
                " ".join(words.split()),
                type="negative" if bad else "positive",
                position="bottom",
                timeout=8000 if bad else 3000,
                close_button="Close" if bad else False,
            )
