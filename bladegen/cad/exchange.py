"""CAD files of solids: STEP, IGES and OCCT's own BREP, and any of them back to a shape.

All in millimetres: STEP and IGES say so in their headers, BREP states no unit.  OCCT writes into
memory and Python to the disk, since OCCT does not notice when a disk is full.  OCP is imported
when first needed.
"""

import io
import os
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from bladegen.cad.solids import Solid
from bladegen.errors import CadError

__all__ = [
    "READERS",
    "STEP_SCHEMAS",
    "read",
    "read_brep",
    "read_iges",
    "read_step",
    "write_brep",
    "write_iges",
    "write_step",
]

STEP_SCHEMAS = {"ap242": "AP242DIS", "ap214": "AP214IS"}  # and what OCCT calls them
MEMORY_UNIT = "xstep.cascade.unit"  # what OCCT calls the unit of shapes in memory
SOLIDS_MODE = 1  # of OCCT's IGES writer: manifold solids (entity 186), not loose trimmed faces


def write_step(
    solid: Solid, path: Path, *, schema: str = "ap242", timestamp: str | None = None
) -> None:
    """Write a solid as STEP in millimetres, its faces named, in a schema of `STEP_SCHEMAS`.

    The time in its header is `timestamp` (ISO 8601), else SOURCE_DATE_EPOCH's, else now: the
    same solid with the same time makes the same bytes.

    Raises
    ------
    CadError
        If OCCT cannot write the file.
    """
    from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
    from OCP.Interface import Interface_Static
    from OCP.STEPConstruct import STEPConstruct
    from OCP.STEPControl import STEPControl_AsIs, STEPControl_Controller, STEPControl_Writer
    from OCP.TCollection import TCollection_HAsciiString

    with _quietly(), _in_millimetres():
        STEPControl_Controller.Init_s()  # before it, the settings below have no effect
        for setting, value in (
            ("write.step.schema", STEP_SCHEMAS[schema]),
            ("write.step.unit", "MM"),
        ):
            if not Interface_Static.SetCVal_s(setting, value):
                raise CadError(f"{path}: OCCT does not take {setting} = {value}")
        writer = STEPControl_Writer()
        writer.Transfer(solid.shape, STEPControl_AsIs)
        process = writer.WS().TransferWriter().FinderProcess()
        for name, face in solid.faces:
            STEPConstruct.FindEntity_s(process, face).SetName(TCollection_HAsciiString(name))
        _name_product(writer.Model(), _ascii(solid.name))
        timestamp = timestamp or _source_date()
        if timestamp is not None:
            header = APIHeaderSection_MakeHeader(writer.Model())
            header.SetTimeStamp(TCollection_HAsciiString(timestamp))
        content = io.BytesIO()
        status = writer.WriteStream(content)
    if status.name != "IFSelect_RetDone":
        raise CadError(f"{path}: OCCT could not write the STEP file ({status.name})")
    _write(path, content)


def read_step(path: Path) -> Any:
    """Read a STEP file's shape [mm].

    Raises
    ------
    CadError
        If the file holds no shape that OCCT understands.
    """
    from OCP.STEPControl import STEPControl_Reader

    return _transferred(STEPControl_Reader, path, "a STEP file")


def write_iges(solid: Solid, path: Path, *, timestamp: str | None = None) -> None:
    """Write a solid as IGES 5.3 in millimetres, one manifold solid B-rep (entity 186).

    The times in its header are those of `write_step`.

    Raises
    ------
    CadError
        If OCCT cannot write the file.
    """
    from OCP.IGESControl import IGESControl_Controller, IGESControl_Writer
    from OCP.TCollection import TCollection_HAsciiString

    timestamp = timestamp or _source_date()
    with _quietly(), _in_millimetres():
        IGESControl_Controller.Init_s()
        writer = IGESControl_Writer("MM", SOLIDS_MODE)
        if not writer.AddShape(solid.shape):
            raise CadError(f"{path}: OCCT could not turn the solid into IGES")
        writer.ComputeModel()
        if timestamp is not None:
            header = writer.Model().ChangeGlobalSection()
            when = TCollection_HAsciiString(re.sub("[-:]", "", timestamp).replace("T", "."))
            header.SetDate(when)
            header.SetLastChangeDate(when)
        content = io.BytesIO()
        if not writer.Write(content):
            raise CadError(f"{path}: OCCT could not write the IGES file")
    _write(path, content)


def read_iges(path: Path) -> Any:
    """Read an IGES file's shape [mm].

    Raises
    ------
    CadError
        If the file holds no shape that OCCT understands.
    """
    from OCP.IGESControl import IGESControl_Reader

    return _transferred(IGESControl_Reader, path, "an IGES file")


def _transferred(control: Callable[[], Any], path: Path, what: str) -> Any:
    """Return the shape that a reader of OCCT's makes of a file."""
    with _quietly(), _in_millimetres():
        reader = control()
        if reader.ReadFile(str(path)).name != "IFSelect_RetDone" or not reader.TransferRoots():
            raise CadError(f"{path}: not {what} that OCCT can read")
        return reader.OneShape()


def write_brep(solid: Solid, path: Path) -> None:
    """Write a solid in OCCT's own BREP format, exactly as it is, without its triangles.

    Raises
    ------
    CadError
        If OCCT cannot write the file.
    """
    from OCP.BRepTools import BRepTools
    from OCP.TopTools import TopTools_FormatVersion

    version = TopTools_FormatVersion.TopTools_FormatVersion_CURRENT
    content = io.BytesIO()
    BRepTools.Write_s(solid.shape, content, False, False, version)
    _write(path, content)


def read_brep(path: Path) -> Any:
    """Read a BREP file's shape, taken as millimetres.

    Raises
    ------
    CadError
        If the file holds no shape that OCCT understands.
    """
    from OCP.BRep import BRep_Builder
    from OCP.BRepTools import BRepTools
    from OCP.TopoDS import TopoDS_Shape

    shape = TopoDS_Shape()
    if not BRepTools.Read_s(shape, str(path), BRep_Builder()) or shape.IsNull():
        raise CadError(f"{path}: not a BREP file that OCCT can read")
    return shape


READERS = {
    ".step": read_step,
    ".stp": read_step,
    ".iges": read_iges,
    ".igs": read_iges,
    ".brep": read_brep,
}


def read(path: Path) -> Any:
    """Read a CAD file's shape [mm] by its suffix, one of `READERS`."""
    return READERS[path.suffix.lower()](path)


def _name_product(model: Any, name: str) -> None:
    """Name a STEP model's product; OCCT would add how many it has written before."""
    from OCP.StepBasic import StepBasic_Product
    from OCP.TCollection import TCollection_HAsciiString

    for i in range(1, model.NbEntities() + 1):
        entity = model.Value(i)
        if isinstance(entity, StepBasic_Product):
            entity.SetId(TCollection_HAsciiString(name))
            entity.SetName(TCollection_HAsciiString(name))


def _write(path: Path, content: io.BytesIO) -> None:
    """Write what OCCT made in memory: it does not notice a full disk, Python does."""
    if not path.parent.is_dir():
        raise CadError(f"{path}: could not write: there is no folder {path.parent}")
    path.write_bytes(content.getbuffer())


def _source_date() -> str | None:
    """Return the time that reproducible-builds.org's SOURCE_DATE_EPOCH asks for, or None."""
    seconds = os.environ.get("SOURCE_DATE_EPOCH")
    if seconds is None or not seconds.isdigit():
        return None
    try:
        when = datetime.fromtimestamp(int(seconds), UTC)
    except (ValueError, OverflowError, OSError):
        raise CadError(f"SOURCE_DATE_EPOCH: got {seconds}, which is no time of this era") from None
    return when.strftime("%Y-%m-%dT%H:%M:%S")


def _ascii(text: str) -> str:
    """Return text as STEP files hold it."""
    return text.encode("ascii", "replace").decode("ascii")


@contextmanager
def _in_millimetres() -> Iterator[None]:
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
def _quietly() -> Iterator[None]:
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
