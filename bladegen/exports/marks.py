"""Where files carry what they are made from: a place of its own in each format, written and read.

`put` writes a `Provenance` into a file that is whole, `read` finds it again.  Each format has a
function from a file's bytes to bytes that hold the line, where readers of that format expect such
words: STEP's header and product, IGES' start section, the headers of STL and BREP, comments, the
extras of glTF, metadata of 3MF, VTK, PNG and workbooks.  CGNS gets its descriptor as it is written
(`grid_files`).  OpenFOAM's packed mesh says it in its dictionaries.  PLOT3D has no place; the
report lists its files as all others.
"""

import json
import re
import struct
import zipfile
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from html import escape, unescape
from pathlib import Path

from bladegen.exports import picture_marks
from bladegen.exports.provenance import NAME, Provenance
from bladegen.exports.text_marks import Put, commented, named_columns, titled
from bladegen.support.archive import rewritten
from bladegen.support.files import beginning_of, end_of, replacing

__all__ = ["marked", "put", "read"]

STL_HEADER = 80  # bytes of free text at the start of a binary STL file
TEXT_STL = b"solid "
HEAD = 1 << 20  # bytes of a file that are looked through, and of what a member unpacks to
STEP_STRING = 200  # characters; ISO 10303-21 allows 256 in a header
IGES_WIDTH = 72  # characters of a line before its section's letter and number
BREP_WIDTH = 90  # characters; OCCT's reader takes lines of at most 99
INP_WIDTH = 250  # characters; Abaqus takes lines of at most 256


def put(path: Path, made: Provenance) -> None:
    """Write what a file is made from into it, if its format has a place for it."""
    place = _PUT.get(path.suffix.lower())
    if place is not None:
        path.write_bytes(place(path.read_bytes(), made))


@contextmanager
def marked(path: Path, made: Provenance) -> Iterator[Path]:
    """Give a temporary path to write a file to, which says what it is made from when it is whole.

    Raises
    ------
    ExportError
        If the file cannot be written.
    """
    with replacing(path) as temporary:
        yield temporary
        put(temporary, made)


def read(path: Path) -> Provenance | None:
    """Return what a file says that it is made from; None if it says nothing of the kind.

    Damaged and foreign files say nothing.
    """
    try:
        head = beginning_of(path, HEAD)
        text = _TEXTS.get(path.suffix.lower(), _plain)(head)
        if head and path.suffix.lower() in _PACKED:
            text = _packed(path)
        if path.suffix.lower() == ".stl" and head.startswith(TEXT_STL):
            text = end_of(path, HEAD).decode("latin-1").rstrip().rpartition("\n")[2]
        if path.suffix.lower() in _ENDED:
            text = picture_marks.ended(end_of(path, HEAD))
    except (OSError, ValueError, LookupError, EOFError, zlib.error, zipfile.BadZipFile):
        return None
    except (struct.error, NotImplementedError, RuntimeError):  # of zip files that are none
        return None
    return None if text is None else Provenance.read(text)


def _pieces(text: str, width: int) -> list[str]:
    return [text[i : i + width] for i in range(0, len(text), width)]


def _step(content: bytes, made: Provenance) -> bytes:
    strings = ",\n".join(f"'{piece}'" for piece in _pieces(made.text, STEP_STRING))
    head, mark, rest = content.partition(b"ENDSEC;")
    head = re.sub(
        rb"FILE_DESCRIPTION\s*\(\s*\((?:'[^']*'[\s,]*)+\)",
        f"FILE_DESCRIPTION((\n{strings})".encode(),
        head,
        count=1,
    )
    product = f"bladegen {made.version}; source={made.source}; id={made.id}"
    rest = re.sub(
        rb"(=\s*PRODUCT\s*\('(?:[^']|'')*',\s*'(?:[^']|'')*',\s*)''",
        lambda found: (
            found[1] + f"'{product.replace(chr(39), chr(39) * 2)}'".encode("ascii", "replace")
        ),
        rest,
    )
    return head + mark + rest


def _iges(content: bytes, made: Provenance) -> bytes:
    lines = content.splitlines(keepends=True)
    end = lines[0][80:]
    start = [line for line in lines if line[72:73] == b"S"]
    words = [line[:IGES_WIDTH].rstrip() for line in start if line[:IGES_WIDTH].strip()]
    words += [piece.encode() for piece in _pieces(made.text, IGES_WIDTH)]
    said = [b"%-72sS%7d%s" % (word, i, end) for i, word in enumerate(words, start=1)]
    rest = [line for line in lines if line[72:73] not in (b"S", b"T")]
    last = [b"S%7d%s" % (len(said), line[8:]) for line in lines if line[72:73] == b"T"]
    return b"".join([*said, *rest, *last])


def _brep(content: bytes, made: Provenance) -> bytes:
    return "".join(f"{piece}\n" for piece in _pieces(made.text, BREP_WIDTH)).encode() + content


def _inp(content: bytes, made: Provenance) -> bytes:
    return "".join(f"** {piece}\n" for piece in _pieces(made.text, INP_WIDTH)).encode() + content


def _stl(content: bytes, made: Provenance) -> bytes:
    if content.startswith(TEXT_STL):  # behind the last solid's name, which readers pass over
        return content.rstrip() + f"; {made.text}\n".encode()
    unit = dict(made.settings).get("unit", "m")
    header = made.short(unit, STL_HEADER).encode("ascii")
    return header.ljust(STL_HEADER) + content[STL_HEADER:]


def _ply(content: bytes, made: Provenance) -> bytes:
    return re.sub(
        rb"(format [^\n]*\n)", lambda f: f[1] + f"comment {made.text}\n".encode(), content, count=1
    )


def _glb(content: bytes, made: Provenance) -> bytes:
    (size,) = struct.unpack_from("<I", content, 12)
    tree = json.loads(content[20 : 20 + size])
    tree["asset"] |= {"generator": f"bladegen {made.version}", "extras": {NAME: made.text}}
    words = json.dumps(tree, separators=(",", ":")).encode()
    words = words.ljust(-(-len(words) // 4) * 4)
    rest = content[20 + size :]
    head = struct.pack("<4sIIII", b"glTF", 2, 20 + len(words) + len(rest), len(words), 0x4E4F534A)
    return head + words + rest


def _in_zip(member: str, change: Callable[[bytes, Provenance], bytes]) -> Put:
    """Return what changes one member of a zip file and keeps all else, times included."""

    def changed(content: bytes, made: Provenance) -> bytes:
        return rewritten(content, lambda name, data: change(data, made) if name == member else data)

    return changed


def _model(content: bytes, made: Provenance) -> bytes:
    entries = (("Application", f"bladegen {made.version}"), ("Description", made.text))
    said = "".join(f'<metadata name="{n}">{escape(t)}</metadata>' for n, t in entries)
    return re.sub(rb"<model\b[^>]*>", lambda f: f[0] + said.encode(), content, count=1)


def _core(content: bytes, made: Provenance) -> bytes:
    space = 'xmlns:dc="http://purl.org/dc/elements/1.1/"'
    said = f"<dc:description {space}>{escape(made.text)}</dc:description>"
    return content.replace(b"</cp:coreProperties>", said.encode() + b"</cp:coreProperties>")


def _vtk(content: bytes, made: Provenance) -> bytes:
    codes = [*made.text.encode(), 0]
    told = f'<Array type="String" Name="{NAME}" NumberOfTuples="1" format="ascii">', "</Array>"
    if b"<UnstructuredGrid" in content:  # meshio, which reads these, knows no text
        told = (
            f'<DataArray type="UInt8" Name="{NAME}" NumberOfTuples="{len(codes)}" format="ascii">',
            "</DataArray>",
        )
    said = " ".join(map(str, codes)).join(told).encode()
    if b"<FieldData>" in content:  # a second one would hide the first
        return content.replace(b"<FieldData>", b"<FieldData>" + said, 1)
    said = b"<FieldData>" + said + b"</FieldData>"
    return re.sub(rb"<(PolyData|UnstructuredGrid)\b[^>]*>", lambda f: f[0] + said, content, count=1)


def _plain(head: bytes) -> str | None:
    return head.decode("latin-1")


def _step_text(head: bytes) -> str | None:
    header = head.partition(b"ENDSEC;")[0].decode("latin-1")
    return "".join(re.findall(r"'([^']*)'", header))


def _iges_text(head: bytes) -> str | None:
    lines = head.decode("latin-1").splitlines()
    return "".join(line[:IGES_WIDTH].ljust(IGES_WIDTH) for line in lines if line[72:73] == "S")


def _brep_text(head: bytes) -> str | None:
    return head[:HEAD].decode("latin-1").partition("CASCADE")[0].replace("\n", "")


def _inp_text(head: bytes) -> str | None:
    comments = re.match(rb"(\*\* ?[^\n]*\n)*", head)
    lines = comments[0].decode("latin-1").split("\n") if comments else []
    return "".join(line[3:].rstrip("\r") for line in lines)


def _glb_text(head: bytes) -> str | None:
    (size,) = struct.unpack_from("<I", head, 12)
    said = json.loads(head[20 : 20 + size])["asset"]["extras"][NAME]
    return said if isinstance(said, str) else None


def _vtk_text(head: bytes) -> str | None:
    found = re.search(rb'Array type="(?:String|UInt8)" Name="bladegen"[^>]*>([\d\s]*)<', head)
    return (
        None if found is None else bytes(int(code) for code in found[1].split()).decode("latin-1")
    )


def _packed(path: Path) -> str:
    """Return the beginning of the member of a zip file that holds the line."""
    with zipfile.ZipFile(path) as archive, archive.open(_PACKED[path.suffix.lower()]) as member:
        return unescape(member.read(HEAD).decode("utf-8", "replace"))


_PACKED = {".3mf": "3D/3dmodel.model", ".xlsx": "docProps/core.xml"}
_ENDED = (".pdf", ".mp4")
_PUT: dict[str, Put] = {
    **dict.fromkeys((".step", ".stp"), _step),
    **dict.fromkeys((".iges", ".igs"), _iges),
    ".brep": _brep,
    ".stl": _stl,
    **dict.fromkeys((".obj", ".yaml", ".yml"), commented("#")),
    ".inp": _inp,
    "": commented("//"),  # of OpenFOAM, whose files have no suffix
    ".csv": named_columns,
    ".htc": commented(";"),
    **dict.fromkeys((".dat", ".txt"), titled),
    ".ply": _ply,
    ".glb": _glb,
    ".3mf": _in_zip(_PACKED[".3mf"], _model),
    ".xlsx": _in_zip(_PACKED[".xlsx"], _core),
    **dict.fromkeys((".vtp", ".vtu"), _vtk),
    ".png": picture_marks.png,
    ".gif": picture_marks.gif,
    ".svg": picture_marks.svg,
    **dict.fromkeys((".html", ".htm"), picture_marks.page),
}
_TEXTS: dict[str, Callable[[bytes], str | None]] = {
    **dict.fromkeys((".step", ".stp"), _step_text),
    **dict.fromkeys((".iges", ".igs"), _iges_text),
    ".brep": _brep_text,
    ".inp": _inp_text,
    ".stl": lambda head: head[:STL_HEADER].decode("latin-1"),
    ".glb": _glb_text,
    ".gif": picture_marks.gif_text,
    **dict.fromkeys((".vtp", ".vtu"), _vtk_text),
    **dict.fromkeys(_PACKED, lambda _: None),
}
