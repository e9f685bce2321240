"""What a family will take of the disk and of time, judged before and by one block of it.

The sections' size is known exactly beforehand; that of the manifest and of each variant's files,
and the time, are those of the first block that is whole, times the blocks that are left.
"""

import shutil
from dataclasses import dataclass
from pathlib import Path

from bladegen.errors import FamilyError
from bladegen.families.storage.places import in_store

__all__ = ["Forecast", "NoRoomError", "duration", "free_bytes", "require_room", "size"]

UNITS = ("bytes", "kB", "MB", "GB", "TB", "PB")


class NoRoomError(FamilyError):
    """The disk cannot hold what was asked for."""


@dataclass(frozen=True)
class Forecast:
    """What is left of a family to be made.

    Parameters
    ----------
    variants : int
        How many.
    needed : int
        Bytes that they take.
    free : int, optional
        Bytes that the disk has; none of an object store.
    seconds : float
        How long they take.
    """

    variants: int
    needed: int
    free: int | None
    seconds: float

    def __str__(self) -> str:
        where = "" if self.free is None else f" on the disk, which has {size(self.free)} free,"
        return (
            f"{self.variants} variants: about {size(self.needed)}{where} and about "
            f"{duration(self.seconds)}"
        )


def require_room(target: Path, variants: int, needed: int, *, at_least: bool = False) -> None:
    """Raise if the disk of a folder has not as many bytes free as some variants take.

    Raises
    ------
    NoRoomError
        If it has not.
    """
    free = free_bytes(target)
    if free is not None and needed > free:
        roughly = "at least" if at_least else "about"
        raise NoRoomError(
            f"{target}: {variants} variants take {roughly} {size(needed)}, the disk has "
            f"{size(free)} free; ask for fewer (--count), for fewer sections each (--spans), or "
            "for another disk (--output)"
        )


def free_bytes(target: Path) -> int | None:
    """Return how many bytes are free where a folder is, or would be made; None in a store."""
    if in_store(target):
        return None
    there = target.absolute()
    while not there.exists() and there != there.parent:
        there = there.parent
    return shutil.disk_usage(there).free


def size(count: float) -> str:
    """Return a number of bytes as people read it.

    >>> size(2_406_000_000_000)
    '2.41 TB'
    """
    for unit in UNITS[:-1]:
        if count < 999.5:
            return f"{count:.3g} {unit}"
        count /= 1000.0
    return f"{count:.3g} {UNITS[-1]}"


def duration(seconds: float) -> str:
    """Return a time as people read it.

    >>> duration(45), duration(3000), duration(9000), duration(4e6)
    ('45 s', '50 min', '2 h 30 min', '46 days')
    """
    if seconds < 90:
        return f"{max(seconds, 1):.0f} s"
    minutes = round(seconds / 60)
    if minutes < 90:
        return f"{minutes} min"
    if minutes < 48 * 60:
        return f"{minutes // 60} h {minutes % 60} min"
    return f"{minutes / (24 * 60):.0f} days"
