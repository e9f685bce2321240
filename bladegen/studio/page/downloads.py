"""Files of a state: made by another process, handed to the browser."""

import asyncio
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

from bladegen.errors import BladegenError
from bladegen.studio.page.tab import Page
from bladegen.studio.worker import Job, Made, make

__all__ = ["export"]

POLL = 0.1  # s, between two looks at what a job is doing


async def export(page: Page, suffix: str) -> None:
    """Make a file and hand it to the browser, saying meanwhile what is being done."""
    from nicegui import ui

    state = page.state
    folder = Path(mkdtemp(prefix="file-", dir=page.studio.folder))
    entry = page.studio.library.entry(state.blade)
    job = Job(entry.source, state, suffix, str(folder), entry.airfoils)
    kind = suffix.lstrip(".").upper()
    with page.client:
        note = ui.notification(f"{kind}: starting", spinner=True, timeout=None)
    try:
        made = await _awaited(page, job, note, kind)
    except (BladegenError, RuntimeError) as error:
        page.say(str(error), bad=True)
    else:
        path = Path(made.path)
        with page.client:
            ui.download.file(path, path.name)
        page.say(
            made.remark or f"{path.name}, {path.stat().st_size / 1e6:.1f} MB",
            bad=bool(made.remark),
        )
    finally:
        note.dismiss()


async def _awaited(page: Page, job: Job, note: Any, kind: str) -> Made:
    future = page.studio.worker.submit(make, job)
    while not future.done():
        await asyncio.sleep(POLL)
        if job.told.is_file():
            note.message = f"{kind}: {job.told.read_text(encoding='utf-8')}"
    return future.result()
