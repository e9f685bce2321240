"""CAD files of solids: STEP, IGES and OCCT's own BREP, and any of them back to a shape.

All in millimetres: STEP and IGES say so in their headers, BREP states no unit.  OCCT writes into
memory and Python to the disk, since OCCT does not notice when a disk is full.  OCP is imported
when first needed.
"""

import io
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from bladegen.cad import step_documents
from bladegen.cad.occt import in_millimetres, quietly, save, time_of
from bladegen.cad.solids import Solid
from bladegen.cad.step_documents import NOBODY, STEP_SCHEMAS, Author
from bladegen.errors import CadError
from bladegen.version import __version__

__all__ = [
    "READERS",
    "STEP_SCHEMAS",
    "Author",
    "read",
    "read_brep",
    "read_iges",
    "read_step",
    "write_brep",
    "write_iges",
    "write_step",
]

DIGITS = 12  # behind the first, in IGES; by OCCT's 9 planes miss their edges by 5e-6 mm
SOLIDS_MODE = 1  # of OCCT's IGES writer: manifold solids (entity 186), not loose trimmed faces


def write_step(
    solid: Solid,
    path: Path,
    *,
    schema: str = "ap242",
    timestamp: str | None = None,
    author: Author = NOBODY,
) -> None:
    """Write a solid as STEP in millimetres, its faces named, in a schema of `STEP_SCHEMAS`.

    The time in its header is `timestamp` (ISO 8601), else SOURCE_DATE_EPOCH's, else now: the
    same solid with the same time makes the same bytes.

    Raises
    ------
    CadError
        If OCCT cannot write the file.
    """
    step_documents.write(solid.part, path, schema=schema, timestamp=timestamp, author=author)


def read_step(path: Path) -> Any:
    """Read a STEP file's shape [mm].

    Raises
    ------
    CadError
        If the file holds no shape that OCCT understands.
    """
    from OCP.STEPControl import STEPControl_Reader

    return _transferred(STEPControl_Reader, path, "a STEP file")


def write_iges(
    solid: Solid, path: Path, *, timestamp: str | None = None, author: Author = NOBODY
) -> None:
    """Write a solid as IGES 5.3 in millimetres, one manifold solid B-rep (entity 186).

    The times in its header are those of `write_step`.

    Raises
    ------
    CadError
        If OCCT cannot write the file.
    """
    from OCP.IGESControl import IGESControl_Controller, IGESControl_Writer
    from OCP.IGESData import IGESData_IGESWriter
    from OCP.IGESSelect import IGESSelect_WorkLibrary

    when = re.sub("[-:]", "", time_of(timestamp)).replace("T", ".")
    with quietly(), in_millimetres():
        IGESControl_Controller.Init_s()
        writer = IGESControl_Writer("MM", SOLIDS_MODE)
        if not writer.AddShape(solid.shape):
            raise CadError(f"{path}: OCCT could not turn the solid into IGES")
        writer.ComputeModel()
        _fill_global(writer.Model().ChangeGlobalSection(), solid.name, when, author)
        content = io.BytesIO()
        lines = IGESData_IGESWriter(writer.Model())
        lines.FloatWriter().SetDefaults(DIGITS)
        lines.SendModel(IGESSelect_WorkLibrary.DefineProtocol_s())
        if not lines.Print(content):
            raise CadError(f"{path}: OCCT could not write the IGES file")
    save(path, content)


def _fill_global(section: Any, name: str, when: str, author: Author) -> None:
    """Say in an IGES file's global section what and whose it is, not who was logged in."""
    from OCP.TCollection import TCollection_HAsciiString

    for put, words in (
        (section.SetSendName, name),
        (section.SetReceiveName, name),
        (section.SetFileName, f"{name}.iges"),
        (section.SetSystemId, f"bladegen {__version__}"),
        (section.SetDate, when),
        (section.SetLastChangeDate, when),
        (section.SetAuthorName, author.name),
        (section.SetCompanyName, author.organisation),
    ):
        put(TCollection_HAsciiString(_ascii(words)))


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
    with quietly(), in_millimetres():
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
    save(path, content)


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


def _ascii(text: str) -> str:
    """Return text as IGES files hold it."""
    return text.encode("ascii", "replace").decode("ascii")
