"""Shapes to a STEP file that says what they are: named parts, faces and curves, in colours.

A `Part` is one product; one that stands in several places is an assembly's part once, under the
names of its places.  In OCCT's terms this is an XCAF document.  Millimetres.  OCP comes late.
"""

import io
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bladegen.cad.occt import in_millimetres, quietly, save, time_of
from bladegen.errors import CadError
from bladegen.version import __version__

__all__ = ["NOBODY", "STEP_SCHEMAS", "Author", "Part", "Place", "write", "write_parts"]

STEP_SCHEMAS = {"ap242": "AP242DIS", "ap214": "AP214IS"}  # and what OCCT calls them


_STYLED = b"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION"
_STYLES = re.compile(rb"^#\d+ *= *" + _STYLED, re.MULTILINE)
_NUMBER = re.compile(rb"#(\d+)")


@dataclass(frozen=True)
class Author:
    """Who a file says made it; nobody unless given.

    Parameters
    ----------
    name, organisation : str
        Of the author.
    """

    name: str = ""
    organisation: str = ""


NOBODY = Author()


@dataclass(frozen=True, eq=False)
class Part:
    """A shape with a name, and what is named and coloured in it.

    Parameters
    ----------
    name : str
        Of the product.
    shape : TopoDS_Shape
        The shape [mm].
    pieces : sequence of (str, TopoDS_Shape, colour)
        Its faces by name, or curves, which go by their part's ("" here); colours are sRGB, 0 to
        255, or None.
    """

    name: str
    shape: Any
    pieces: Sequence[tuple[str, Any, tuple[int, int, int] | None]] = ()


@dataclass(frozen=True, eq=False)
class Place:
    """A part in its place in an assembly.

    Parameters
    ----------
    name : str
        Of this one of the part's copies.
    part : Part
        What stands there.
    location : TopLoc_Location
        Where.
    """

    name: str
    part: Part
    location: Any


def write(
    what: Part | tuple[str, Sequence[Place]],
    path: Path,
    *,
    schema: str = "ap242",
    timestamp: str | None = None,
    author: Author = NOBODY,
) -> None:
    """Write a part, or an assembly by its name and places, in a schema of `STEP_SCHEMAS`.

    The same shapes with the same time make the same bytes.

    Raises
    ------
    CadError
        If OCCT cannot write the file.
    """
    from OCP.Interface import Interface_Static
    from OCP.STEPCAFControl import STEPCAFControl_Controller, STEPCAFControl_Writer
    from OCP.STEPControl import STEPControl_AsIs

    when = time_of(timestamp)
    with quietly(), in_millimetres():
        STEPCAFControl_Controller.Init_s()  # before it, the settings below have no effect
        for setting, value in (
            ("write.step.schema", STEP_SCHEMAS[schema]),
            ("write.step.unit", "MM"),
        ):
            if not Interface_Static.SetCVal_s(setting, value):
                raise CadError(f"{path}: OCCT does not take {setting} = {value}")
        parts = [what] if isinstance(what, Part) else [place.part for place in what[1]]
        writer = STEPCAFControl_Writer()
        writer.SetNameMode(True)
        writer.SetColorMode(True)
        if not writer.Transfer(_document(what), STEPControl_AsIs):
            raise CadError(f"{path}: OCCT could not turn the shapes into STEP")
        plain = writer.ChangeWriter()
        _name_pieces(plain, parts)
        name = what.name if isinstance(what, Part) else what[0]
        _number_places(plain.Model())
        _fill_header(plain.Model(), name, when, author)
        content = io.BytesIO()
        status = plain.WriteStream(content)
    if status.name != "IFSelect_RetDone":
        raise CadError(f"{path}: OCCT could not write the STEP file ({status.name})")
    save(path, io.BytesIO(_styles_in_order(content.getvalue())))


def write_parts(name: str, parts: Sequence[Part], path: Path, **options: Any) -> None:
    """Write parts where they are as an assembly of that name; options as of `write`.

    Raises
    ------
    CadError
        If OCCT cannot write the file.
    """
    from OCP.TopLoc import TopLoc_Location

    write((name, [Place(part.name, part, TopLoc_Location()) for part in parts]), path, **options)


def _document(what: Part | tuple[str, Sequence[Place]]) -> Any:
    """Return an XCAF document of a part or an assembly."""
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDocStd import TDocStd_Document
    from OCP.XCAFApp import XCAFApp_Application
    from OCP.XCAFDoc import XCAFDoc_DocumentTool

    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    main = document.Main()
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(main)
    colours = XCAFDoc_DocumentTool.ColorTool_s(main)
    if isinstance(what, Part):
        _add(what, shapes, colours)
        return document
    name, places = what
    assembly = shapes.NewShape()
    _name(assembly, name)
    known: dict[int, Any] = {}
    for place in places:
        if id(place.part) not in known:
            known[id(place.part)] = _add(place.part, shapes, colours)
        _name(shapes.AddComponent(assembly, known[id(place.part)], place.location), place.name)
    shapes.UpdateAssemblies()
    return document


def _add(part: Part, shapes: Any, colours: Any) -> Any:
    """Add a part to a document's tools; return its label."""
    from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
    from OCP.TopAbs import TopAbs_FACE
    from OCP.XCAFDoc import XCAFDoc_ColorCurv, XCAFDoc_ColorSurf

    label = shapes.AddShape(part.shape, False)
    _name(label, part.name)
    for _, piece, colour in part.pieces:
        if colour is not None:
            kind = XCAFDoc_ColorSurf if piece.ShapeType() == TopAbs_FACE else XCAFDoc_ColorCurv
            shade = Quantity_Color(*(c / 255.0 for c in colour), Quantity_TOC_sRGB)
            colours.SetColor(shapes.AddSubShape(label, piece), shade, kind)
    return label


def _name(label: Any, name: str) -> None:
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDataStd import TDataStd_Name

    TDataStd_Name.Set_s(label, TCollection_ExtendedString(_spelt(name)))


def _name_pieces(writer: Any, parts: Sequence[Part]) -> None:
    """Name the entities of a model that stand for pieces of parts."""
    from OCP.STEPConstruct import STEPConstruct
    from OCP.TCollection import TCollection_HAsciiString

    process = writer.WS().TransferWriter().FinderProcess()
    for part in parts:
        for name, piece, _ in part.pieces:
            if not name:
                continue
            entity = STEPConstruct.FindEntity_s(process, piece)
            entity.SetName(TCollection_HAsciiString(_spelt(name)))


def _number_places(model: Any) -> None:
    """Number an assembly's places from 1; OCCT goes on from those that it has written before."""
    from OCP.StepRepr import StepRepr_NextAssemblyUsageOccurrence
    from OCP.TCollection import TCollection_HAsciiString

    entities = (model.Value(i) for i in range(1, model.NbEntities() + 1))
    places = [e for e in entities if isinstance(e, StepRepr_NextAssemblyUsageOccurrence)]
    for number, place in enumerate(places, start=1):
        place.SetId(TCollection_HAsciiString(str(number)))


def _styles_in_order(content: bytes) -> bytes:
    """Return a STEP file whose colours stand last in the order of its parts, as from any process.

    OCCT writes those of an assembly part by part, in the order of addresses in memory, and each
    shade where it is first used.
    """
    heads = [found.start() for found in _STYLES.finditer(content)]
    if len(heads) < 2:
        return content
    start, end = heads[0], content.rindex(b"ENDSEC;")
    lines = b" ".join(content[start:end].split()).split(b"; #")
    told = {
        int(number): body for number, body in (line.lstrip(b"#").split(b" = ", 1) for line in lines)
    }
    first, order = min(told), list[int]()
    waiting = sorted(
        (number for number, body in told.items() if body.startswith(_STYLED)),
        key=lambda number: -_named(told[number])[-1],  # the context of a part
    )
    known = set[int]()
    while waiting:
        number = waiting.pop()
        if number not in known:
            known.add(number)
            order.append(number)
            waiting += [one for one in reversed(_named(told[number])) if one >= first]
    anew = {number: first + i for i, number in enumerate(order)}

    def again(found: re.Match[bytes]) -> bytes:
        return b"#%d" % anew.get(int(found[1]), int(found[1]))

    entities = [b"#%d = %s;" % (anew[n], _NUMBER.sub(again, told[n].rstrip(b"; "))) for n in order]
    broken = [re.sub(rb"(.{60}[^,]*,)(?=.)", rb"\1\n    ", entity) for entity in entities]
    return content[:start] + b"\n".join(broken) + b"\n" + content[end:]


def _named(body: bytes) -> list[int]:
    """Return the entities that one names, in its order."""
    return [int(number) for number in _NUMBER.findall(body)]


def _fill_header(model: Any, name: str, when: str, author: Author) -> None:
    from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
    from OCP.TCollection import TCollection_HAsciiString

    def text(words: str) -> Any:
        return TCollection_HAsciiString(_spelt(words))

    header = APIHeaderSection_MakeHeader(model)
    header.SetName(text(name))
    header.SetTimeStamp(text(when))
    header.SetAuthorValue(1, text(author.name))
    header.SetOrganizationValue(1, text(author.organisation))
    header.SetOriginatingSystem(text(f"bladegen {__version__}"))
    header.SetAuthorisation(text(""))


def _spelt(text: str) -> str:
    """Return text as ISO 10303-21 spells it: what is beyond ASCII by its code points."""

    def spelt(letter: str) -> str:
        if letter.isascii():
            return letter if letter.isprintable() else " "
        kind, digits = ("X2", 4) if ord(letter) < 0x10000 else ("X4", 8)
        return f"\\{kind}\\{ord(letter):0{digits}X}\\X0\\"

    return "".join(map(spelt, text))
