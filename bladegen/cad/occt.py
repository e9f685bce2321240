"""OCCT's ways of this process: its unit, its remarks, its streams, and the times in its files."""

import io
import os
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

from bladegen.errors import CadError

__all__ = ["in_millimetres", "quietly", "save", "time_of"]

MEMORY_UNIT = "xstep.cascade.unit"  # what OCCT calls the unit of shapes in memory


@contextmanager
def in_millimetres() -> Iterator[None]:
    """Have OCCT take shapes in memory as millimetres, whatever else set it to in this process."""
    from OCP.Interface import Interface_Static
    from OCP.STEPControl import STEPControl_Controller

    STEPControl_Controller.Init_s()  # before it, there is no such setting
    before = Interface_Static.CVal_s(MEMORY_UNIT)
    Interface_Static.SetCVal_s(MEMORY_UNIT, "MM")
    try:
        yield
    finally:
        Interface_Static.SetCVal_s(MEMORY_UNIT, before)


@contextmanager
def quietly() -> Iterator[None]:
    """Keep OCCT's remarks off the terminal; its failures are checked for."""
    from OCP.Message import Message, Message_Gravity

    printers = Message.DefaultMessenger_s().Printers()
    levels = [printer.GetTraceLevel() for printer in printers]
    for printer in printers:
        printer.SetTraceLevel(Message_Gravity.Message_Fail)
    try:
        yield
    finally:
        for printer, level in zip(printers, levels, strict=True):
            printer.SetTraceLevel(level)


def save(path: Path, content: io.BytesIO) -> None:
    """Write what OCCT made in memory: it does not notice a full disk, Python does."""
    if not path.parent.is_dir():
        raise CadError(
            f"{path}: could not write: there is no folder {path.parent}; mkdir -p {path.parent}"
        )
    path.write_bytes(content.getbuffer())


def time_of(timestamp: str | None) -> str:
    """Return the time that a file is to hold, ISO 8601.

    The one given, else SOURCE_DATE_EPOCH's of reproducible-builds.org, else now.

    Raises
    ------
    CadError
        If SOURCE_DATE_EPOCH is no time.
    """
    if timestamp:
        return timestamp
    seconds = os.environ.get("SOURCE_DATE_EPOCH")
    if seconds is None or not seconds.isdigit():
        return datetime.now().astimezone().strftime("%Y-%m-%dT%H:%M:%S")
    try:
        when = datetime.fromtimestamp(int(seconds), UTC)
    except (ValueError, OverflowError, OSError):
        raise CadError(f"SOURCE_DATE_EPOCH: got {seconds}, which is no time of this era") from None
    return when.strftime("%Y-%m-%dT%H:%M:%S")
