"""What CAD files say of themselves: names, colours and headers, as other readers find them."""

import getpass
import re
from dataclasses import replace

import meshing
import numpy as np
import pytest
from OCP.IGESControl import IGESControl_Reader
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE
from OCP.TopExp import TopExp_Explorer
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

import bladegen as bg
from bladegen.cad import exchange, occt, solids
from bladegen.cad.rotor import rotor_of, write_step
from bladegen.errors import ExportError
from bladegen.surface import regions
from bladegen.surface.tips import round_tip

WHO = exchange.Author("Ada O'Hara, Ö", "Wind \\ Co")
TIME = "2026-01-02T03:04:05"


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=101)


@pytest.fixture(scope="module", params=["flat", "round"])
def solid(blade, request):
    options = {"tip": round_tip} if request.param == "round" else {}
    return solids.solid(blade, sections=30, **options)


@pytest.fixture(scope="module")
def step(solid, tmp_path_factory):
    path = tmp_path_factory.mktemp("step") / "blade.step"
    exchange.write_step(solid, path, timestamp=TIME, author=WHO)
    return path


def document_of(path):
    """A STEP file as OCCT's document of names and colours."""
    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    with occt.quietly(), occt.in_millimetres():
        reader = STEPCAFControl_Reader()
        reader.SetNameMode(True)
        reader.SetColorMode(True)
        assert reader.ReadFile(str(path)).name == "IFSelect_RetDone"
        assert reader.Transfer(document)
    return document


def name_of(label):
    found = TDataStd_Name()
    assert label.FindAttribute(TDataStd_Name.GetID_s(), found)
    return found.Get().ToExtString()


def components(document):
    """Names of an assembly's components, and of the parts that they are copies of."""
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    free, found = TDF_LabelSequence(), TDF_LabelSequence()
    tool.GetFreeShapes(free)
    XCAFDoc_ShapeTool.GetComponents_s(free.Value(1), found, False)
    names, parts = [], []
    for i in range(1, found.Length() + 1):
        part = TDF_Label()
        assert XCAFDoc_ShapeTool.GetReferredShape_s(found.Value(i), part)
        names.append(name_of(found.Value(i)))
        parts.append(name_of(part))
    return names, parts


def colours_of(document):
    """The colours of a document's faces, sRGB from 0 to 255."""
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colours = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    free = TDF_LabelSequence()
    tool.GetFreeShapes(free)
    explorer = TopExp_Explorer(XCAFDoc_ShapeTool.GetShape_s(free.Value(1)), TopAbs_FACE)
    found = []
    while explorer.More():
        colour = Quantity_Color()
        assert colours.GetColor(explorer.Current(), XCAFDoc_ColorSurf, colour)
        found.append(tuple(round(255 * c) for c in colour.Values(Quantity_TOC_sRGB)))
        explorer.Next()
    return found


def test_each_face_has_the_colour_of_its_region(solid, step):
    wanted = [regions.COLOURS[name] for name, _ in solid.faces]
    assert colours_of(document_of(step)) == wanted
    assert set(wanted) <= set(regions.COLOURS.values())


def test_gmsh_shows_the_blade_s_name_and_the_colours(solid, step):
    found = meshing.found(step)
    assert found.names == ("Shapes/dtu10mw",)
    wanted = [regions.COLOURS[name] for name, _ in solid.faces]
    assert np.abs(found.colours - wanted).max() <= 1


def test_the_header_says_what_made_it_and_who_if_that_is_given(solid, step, tmp_path):
    header = step.read_text(encoding="ascii").partition("ENDSEC;")[0]
    words = re.findall(r"'((?:[^']|'')*)'", header.partition("FILE_NAME")[2])
    assert words[:4] == ["dtu10mw", TIME, "Ada O''Hara, \\X2\\00D6\\X0\\", "Wind \\\\ Co"]
    assert words[5:7] == [f"bladegen {bg.__version__}", ""]
    exchange.write_step(solid, tmp_path / "a.step", timestamp=TIME)
    plain = (tmp_path / "a.step").read_text().partition("ENDSEC;")[0]
    assert re.findall(r"'((?:[^']|'')*)'", plain.partition("FILE_NAME")[2])[2:4] == ["", ""]


def test_names_of_any_language_come_through(solid, tmp_path):
    name = "swept blåde 翼 \U0001f300"
    exchange.write_step(replace(solid, name=name), tmp_path / "a.step")
    assert (tmp_path / "a.step").read_bytes().isascii()
    document = document_of(tmp_path / "a.step")
    free = TDF_LabelSequence()
    XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetFreeShapes(free)
    assert name_of(free.Value(1)) == name


def test_the_same_solid_with_the_same_time_makes_the_same_file(solid, step, tmp_path):
    exchange.write_step(solid, tmp_path / "a.step", timestamp=TIME, author=WHO)
    assert (tmp_path / "a.step").read_bytes() == step.read_bytes()


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_rotor_is_one_part_thrice_with_its_faces_named(blade, solid, tmp_path, mirrored):
    path = tmp_path / "rotor.step"
    rotor = rotor_of(blade, hub_radius=2.0, mirrored=mirrored)
    write_step(rotor, solid, path, timestamp=TIME, author=WHO)
    names, parts = components(document_of(path))
    assert names == ["blade 1", "blade 2", "blade 3", "spinner"]
    assert parts == ["dtu10mw", "dtu10mw", "dtu10mw", "spinner"]
    text = path.read_text()
    assert text.count("MANIFOLD_SOLID_BREP(") == 2, "the blade once, and the spinner"
    for name, _ in solid.faces:
        assert text.count(f"ADVANCED_FACE('{name}'") == 1
    assert "PRODUCT('dtu10mw rotor'" in text
    write_step(rotor, solid, tmp_path / "again.step", timestamp=TIME, author=WHO)
    assert (tmp_path / "again.step").read_bytes() == path.read_bytes()


def fields_of(path):
    """The strings of an IGES file's global section, by their places, and the other fields."""
    lines = path.read_text().splitlines()
    text = "".join(line[:72] for line in lines if line[72] == "G")
    found = []
    while len(found) < 25:
        text = text.lstrip()
        count = re.match(r"(\d+)H", text)
        start = len(count[0]) if count else 0
        end = start + int(count[1]) if count else re.search("[,;]", text).start()
        found.append(text[start:end].strip())
        text = text[end + 1 :]
    return found


def test_iges_names_the_blade_and_never_who_is_logged_in(solid, tmp_path, monkeypatch):
    monkeypatch.setenv("LOGNAME", "someone")
    exchange.write_iges(solid, tmp_path / "a.iges", timestamp=TIME)
    found = fields_of(tmp_path / "a.iges")
    assert found[2:5] == ["dtu10mw", "dtu10mw.iges", f"bladegen {bg.__version__}"]
    assert found[17] == found[24] == "20260102.030405"
    assert found[20:22] == ["", ""]
    header = "".join((tmp_path / "a.iges").read_text().splitlines()[:6])
    assert getpass.getuser() not in header
    exchange.write_iges(solid, tmp_path / "b.iges", timestamp=TIME, author=WHO)
    assert fields_of(tmp_path / "b.iges")[20:22] == ["Ada O'Hara, ?", "Wind \\ Co"]
    assert IGESControl_Reader().ReadFile(str(tmp_path / "b.iges")).name == "IFSelect_RetDone"


def test_export_takes_the_author(blade, tmp_path):
    path = bg.export(blade, tmp_path / "a.iges", sections=20, author="Ada", organisation="Co")
    assert fields_of(path)[20:22] == ["Ada", "Co"]
    with pytest.raises(ExportError, match="author: got 3, must be text"):
        bg.export(blade, tmp_path / "a.step", author=3)
