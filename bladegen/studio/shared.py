"""What the tabs of one running studio share."""

from dataclasses import dataclass, field
from pathlib import Path

from bladegen.studio import worker
from bladegen.studio.library import Library
from bladegen.studio.process import Worker
from bladegen.studio.results import answers
from bladegen.studio.visits import Visits

__all__ = ["Studio"]


@dataclass(eq=False)
class Studio:
    """What the tabs of one running studio share.

    Parameters
    ----------
    folder : Path
        Its temporary folder: uploads and files to download.
    library : Library
        The blades.
    first : str
        The blade that is shown at first.
    worker, knower : Worker
        Makes files; answers what takes longer than a frame.
    packets : dict
        The latest surface of each tab, its baseline's, and that of the blade beside it, by a name
        that nobody can guess.
    visits : Visits
        Page loads that no tab has connected to yet.
    """

    folder: Path
    library: Library
    first: str
    worker: Worker = field(default_factory=lambda: Worker(worker.load))
    knower: Worker = field(default_factory=lambda: Worker(answers.load))
    packets: dict[str, tuple[bytes, bytes, bytes]] = field(default_factory=dict)
    visits: Visits = field(default_factory=Visits)

    def end(self) -> None:
        """Stop its processes."""
        self.worker.end()
        self.knower.end()
