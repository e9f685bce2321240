"""Where pictures, films and pages carry what they are made from, and where it is read again.

PNG: a text chunk.  GIF: a comment.  SVG: metadata.  HTML: a meta element.  PDF and MP4 get theirs
as they are written, since each place in them is counted from the start: the subject of a PDF, the
comment of a film.
"""

import re
import struct
import zlib

from bladegen.exports.provenance import NAME, Provenance

__all__ = ["ended", "gif", "gif_text", "page", "png", "svg"]

PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"
BLOCK = 255  # bytes of a GIF's comment behind each count


def png(content: bytes, made: Provenance) -> bytes:
    """A text chunk behind the header."""
    at = len(PNG_SIGNATURE) + 25
    chunk = b"tEXt" + f"{NAME}\0{made.text}".encode("latin-1")
    text = struct.pack(">I", len(chunk) - 4) + chunk + struct.pack(">I", zlib.crc32(chunk))
    return content[:at] + text + content[at:]


def gif(content: bytes, made: Provenance) -> bytes:
    """A comment behind the colours that all pictures share (GIF89a, section 24)."""
    at = _colours(content)
    text = made.text.encode("ascii")
    blocks = [text[k : k + BLOCK] for k in range(0, len(text), BLOCK)]
    said = b"".join(bytes([len(block)]) + block for block in blocks)
    return content[:at] + b"\x21\xfe" + said + b"\0" + content[at:]


def gif_text(head: bytes) -> str:
    """Return the comment behind the colours; an error of lookup where there is none."""
    at = _colours(head)
    if head[at : at + 2] != b"\x21\xfe":
        raise LookupError("no comment")
    at, text = at + 2, b""
    while head[at]:
        text += head[at + 1 : at + 1 + head[at]]
        at += 1 + head[at]
    return text.decode("latin-1")


def _colours(content: bytes) -> int:
    """Return where the colours of a GIF end, which follow its 13 bytes of header."""
    flags = content[10]
    return 13 + (3 << (1 + (flags & 7)) if flags & 0x80 else 0)


def svg(content: bytes, made: Provenance) -> bytes:
    """Metadata behind the start of the drawing."""
    said = f'\n <metadata id="{NAME}">{made.text}</metadata>'.encode()
    return re.sub(rb"<svg\b[^>]*>", lambda f: f[0] + said, content, count=1)


def page(content: bytes, made: Provenance) -> bytes:
    """A meta element behind the one that names the letters, which browsers look for first."""
    said = f'\n<meta name="{NAME}" content="{made.text}">'.encode()
    return re.sub(rb"<meta charset=[^>]*>", lambda f: f[0] + said, content, count=1)


def ended(tail: bytes) -> str:
    """Return a PDF's or a film's last bytes as text, brackets as they were."""
    return re.sub(r"\\([()\\])", r"\1", tail.decode("latin-1"))
