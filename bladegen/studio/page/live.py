"""What follows the picture: answers of another process, asked for once the sliders rest.

A picture is never waited for: while a slider moves nothing is asked, and an answer to what is no
longer shown is thrown away.
"""

import asyncio
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from bladegen.studio.results.answers import (
    BladeAnswer,
    SectionAnswer,
    about_blade,
    about_section,
)
from bladegen.studio.results.question import Question
from bladegen.studio.shared import Studio
from bladegen.studio.state import State

__all__ = ["Live"]

REST = 0.25  # s without a move, after which answers are asked for
ENDED = "the process that knows has ended; move a slider to ask again"


class Live:
    """The latest answers for a tab.

    Parameters
    ----------
    studio : Studio
        Whose process is asked.
    gone : callable
        Tells whether nobody looks any more.
    """

    def __init__(self, studio: Studio, gone: Callable[[], bool]) -> None:
        self._studio, self._gone = studio, gone
        self._wanted: State | None = None
        self._working = False
        self.section: SectionAnswer | None = None
        self.blade: BladeAnswer | None = None
        self.trouble = ""
        self.stale = True
        self.followers: list[Callable[[], None]] = []

    def ask(self, state: State) -> None:
        """Ask about a state once no other comes; called on the server's event loop."""
        from nicegui import background_tasks

        plain = State(state.blade)
        state = replace(
            state, off=plain.off, files=plain.files, beside=plain.beside
        )  # which change no answer
        if state == self._wanted and not self.stale:
            return
        self._wanted = state
        self._told(stale=True)
        if not self._working:
            self._working = True
            background_tasks.create(self._work())

    async def _work(self) -> None:
        try:
            while not self._gone():
                state = self._wanted
                assert state is not None
                await asyncio.sleep(REST)
                if state is self._wanted and await self._answered(state):
                    return
        finally:
            self._working = False

    async def _answered(self, state: State) -> bool:
        """Show the answers to a state; tell whether they are still those that are wanted."""
        entry = self._studio.library.entry(state.blade)
        question = Question(entry.source, entry.airfoils, state)
        try:
            section = await self._asked(about_section, question)
            if state is not self._wanted:
                return False
            self.section, self.trouble = section, ""
            self._told(stale=True)
            blade = await self._asked(about_blade, question)
        except RuntimeError:  # of pools whose process has died
            self.trouble = ENDED
        else:
            self.blade = blade
        if state is not self._wanted:
            return False
        self._told(stale=False)
        return True

    async def _asked(self, make: Callable[[Question], Any], question: Question) -> Any:
        return await asyncio.wrap_future(self._studio.knower.submit(make, question))

    def _told(self, *, stale: bool) -> None:
        self.stale = stale
        for follow in self.followers:
            follow()
