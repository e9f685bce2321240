"""What a build has written, and what time each stage took."""

import logging
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from bladegen.exports import marks
from bladegen.exports.inventory import entry_of
from bladegen.exports.provenance import Provenance

__all__ = ["Ledger"]

logger = logging.getLogger(__name__)


@dataclass(frozen=True)
class Ledger:
    """What was written, and what time each stage took [s]."""

    progress: Callable[[str], None]
    files: list[dict[str, Any]] = field(default_factory=list)
    seconds: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def timed(self, stage: str) -> Iterator[None]:
        """Add the time spent within to a stage's."""
        start = time.perf_counter()
        try:
            yield
        finally:
            spent = time.perf_counter() - start
            self.seconds[stage] = self.seconds.get(stage, 0.0) + spent
            logger.debug("%s: %.2f s", stage, spent)

    @contextmanager
    def writing(self, path: Path, stage: str, made: Provenance) -> Iterator[Path]:
        """Write a file under a temporary name within, mark it, and note it once it is whole."""
        self.progress(f"writing {path.name}")
        with self.timed(stage), marks.marked(path, made) as temporary:
            yield temporary
        self.note(path, made)

    def note(self, path: Path, made: Provenance) -> None:
        """Add a file that lies on the disk; a report that does not fit the file beside it shows."""
        self.files.append(entry_of(path, made))
