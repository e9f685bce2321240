"""What a file is made from: bladegen's version, the blade's source, the settings, the command.

A `Provenance` is one line of text, which files carry in their formats' own places (`marks`) and
from which it is read again.  It holds no time and no folder, so that the same command makes the
same bytes anywhere.  `identity` says the same of a whole family, to tell whether a run goes on.
"""

import hashlib
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from pathlib import Path
from typing import Any
from urllib.parse import quote, unquote

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.edges import AsGiven, MinimumThickness, Sharp
from bladegen.blade.lofting.paths import PATHS
from bladegen.blade.planform import PLANES
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.support.files import digest_of
from bladegen.surface.tips import TIPS
from bladegen.version import __version__

__all__ = [
    "NAME",
    "Provenance",
    "blade_settings",
    "compared_of",
    "content_of",
    "drawn_of",
    "fingerprint",
    "made_from",
    "word",
]

PLAIN = " ,.:+-_/()[]{}=*~!#@|?"  # beside letters and digits: what no format gives a meaning to
NAME = "bladegen"  # of entries that have one
ID_DIGITS = 8  # of a SHA-256
LONE = (
    "change",
    "fair_planform",
    "mirrored",
)  # settings there only if something is changed
FACTS = ("blade", "source", "sha256", "definition", "command")
WORDS = {  # of functions, as the command line calls them
    function.__name__: word for table in (PATHS, PLANES, TIPS) for word, function in table.items()
}
_TEXT = re.compile(r"bladegen ([^;\s]+); (blade=.*?); id=([0-9a-f]{8})")
_SHORT = re.compile(r"bladegen (\S+) (.*?), unit: \w+, source ([0-9a-f]*), id ([0-9a-f]{8})")


@dataclass(frozen=True)
class Provenance:
    """What a file is made from.

    Parameters
    ----------
    version : str
        Of bladegen.
    blade : str
        The blade's name.
    source : str
        The name of the definition's file, without its folder; "" if there is none.
    sha256 : str
        Of that file, hex digits.
    definition : str
        Fingerprint of all that the definition holds, airfoils of other files included.
    command : str
        What was typed, without folders; "" in Python.
    settings : tuple of (str, str)
        What matters to a file of this kind, by name.
    id : str
        Eight hex digits that stand for all of this but the command; computed if not given.
    """

    version: str
    blade: str
    source: str = ""
    sha256: str = ""
    definition: str = ""
    command: str = ""
    settings: tuple[tuple[str, str], ...] = ()
    id: str = ""

    def __post_init__(self) -> None:
        if not self.id:
            plain = self._line(replace(self, command="", id="-"))
            digest = hashlib.sha256(plain.encode()).hexdigest()
            object.__setattr__(self, "id", digest[:ID_DIGITS])

    @staticmethod
    def _line(one: "Provenance") -> str:
        facts = [(name, getattr(one, name)) for name in FACTS]
        pairs = [*facts, *one.settings, ("id", one.id)]
        said = "; ".join(f"{key}={quote(value, PLAIN)}" for key, value in pairs if value)
        return f"bladegen {one.version}; {said}"

    @property
    def text(self) -> str:
        """All of it in one line of ASCII that no format needs to escape."""
        return self._line(self)

    @property
    def is_partial(self) -> bool:
        """Whether only `short` is known, from a place that holds no more."""
        return not self.definition

    def short(self, unit: str, room: int) -> str:
        """Return what matters most in at most `room` characters; `read` knows this too."""
        tail = f", unit: {unit}, source {self.sha256[:ID_DIGITS]}, id {self.id}"
        name = " ".join(quote(self.blade, PLAIN).split())
        return f"{f'bladegen {self.version} {name}'[: room - len(tail)]}{tail}"

    @classmethod
    def read(cls, text: str) -> "Provenance | None":
        """Return what a text that holds such a line says, None if it holds none."""
        found = _TEXT.search(text)
        if found is None:
            brief = _SHORT.search(text)
            if brief is None:
                return None
            return cls(brief[1], unquote(brief[2]), sha256=brief[3], id=brief[4])
        pairs = [part.partition("=")[::2] for part in found[2].split("; ")]
        values = {key: unquote(value) for key, value in pairs}
        facts = {name: values.pop(name, "") for name in FACTS}
        return cls(found[1], **facts, settings=tuple(values.items()), id=found[3])

    def differences(self, other: "Provenance") -> list[tuple[str, str, str]]:
        """Return in what another file's making differs: what it is, that of this, of the other.

        Settings count that both have; of a partial one the source's content is all there is.
        """
        if self.id == other.id:
            return []
        whole = not (self.is_partial or other.is_partial)
        facts = ("version", "source", "definition") if whole else ("sha256",)
        pairs = [(name, getattr(self, name), getattr(other, name)) for name in facts]
        pairs = [(name, a, b) for name, a, b in pairs if a[: len(b)] != b[: len(a)]]
        one, two = dict(self.settings), dict(other.settings)
        for key in {**one, **two}:
            both = key in one and key in two
            if (both or key.startswith(LONE)) and one.get(key) != two.get(key):
                words = key.replace("_", " ")
                pairs.append((words, one.get(key, "none"), two.get(key, "none")))
        return pairs


def made_from(
    what: Blade | BladeDefinition, settings: Mapping[str, str], command: str = ""
) -> Provenance:
    """Return what a file is made from: a blade, and settings that matter to its kind."""
    definition = what if isinstance(what, BladeDefinition) else what.definition
    how = {} if isinstance(what, BladeDefinition) else blade_settings(what)
    path = Path(definition.source)
    known = bool(definition.source) and path.is_file()
    return Provenance(
        __version__,
        what.name,
        path.name if definition.source else "",
        digest_of(path) if known else "",
        content_of(definition),
        command,
        tuple({**how, **settings}.items()),
    )


def drawn_of(thing: Blade | Path, *, command: str = "") -> Provenance:
    """Return what a picture is made from: a blade and its settings, or a file as it is."""
    if isinstance(thing, Path):
        return Provenance(__version__, thing.name, thing.name, digest_of(thing), command=command)
    return made_from(thing, {}, command)


def compared_of(one: Blade | Path, other: Blade | Path, *, command: str) -> Provenance:
    """Return what a picture of two things is made from: the one, its settings, and the other."""
    first, second = drawn_of(one), drawn_of(other)
    told = {"against": second.source or second.blade, "against_sha256": second.sha256}
    settings = first.settings + tuple((key, value) for key, value in told.items() if value)
    return replace(first, command=command, settings=settings, id="")


def content_of(definition: BladeDefinition) -> str:
    """Return a fingerprint of what a definition holds.

    Without its relative thickness, which a blade fills in where there is none.
    """
    return fingerprint(replace(definition, relative_thickness=None))


def blade_settings(blade: Blade) -> dict[str, str]:
    """Return how a definition became a blade, in words."""
    found = {
        "landmarks": str(len(blade.u)),
        "path": word(blade.path),
        "planes": word(blade.planes),
        "trailing_edge": word(blade.trailing_edge),
        "fairing": "off" if blade.fairing is None else word(blade.fairing),
    }
    if blade.fair_planform is not None:
        found["fair_planform"] = str(blade.fair_planform)
    if blade.mirrored:
        found["mirrored"] = "yes"
    for number, change in enumerate(blade.changes, start=1):
        for key, value in change.items():
            found[f"change{number}.{key}"] = json.dumps(value)
    return found


def word(value: Any) -> str:
    """Return a setting as one writes it: functions by their names, without addresses."""
    if isinstance(value, AsGiven | MinimumThickness | Sharp | str):
        return str(value)
    if isinstance(value, float):
        return f"{value:.12g}"
    if callable(value):
        name = str(getattr(value, "__qualname__", type(value).__qualname__))
        return WORDS.get(name, name)
    return str(value)


def fingerprint(value: Any) -> str:
    """Return the first 16 hex digits of a SHA-256 over a value's numbers and names.

    Dataclasses count by their fields, arrays by their bytes, functions by their names.
    """
    digest = hashlib.sha256()
    _feed(digest, value)
    return digest.hexdigest()[:16]


def _feed(digest: Any, value: Any) -> None:
    if is_dataclass(value) and not isinstance(value, type):
        digest.update(type(value).__name__.encode())
        for entry in fields(value):
            part = getattr(value, entry.name)
            if entry.name not in UNCOUNTED and not (entry.name in LATER and part in (None, ())):
                digest.update(entry.name.encode())
                _feed(digest, part)
    elif isinstance(value, np.ndarray):
        digest.update(f"{value.dtype.str}{value.shape}".encode())
        digest.update(np.ascontiguousarray(value).tobytes())
    elif isinstance(value, dict):
        for key in sorted(value):
            digest.update(str(key).encode())
            _feed(digest, value[key])
    elif isinstance(value, list | tuple):
        digest.update(f"[{len(value)}]".encode())
        for item in value:
            _feed(digest, item)
    elif callable(value):
        digest.update(getattr(value, "__qualname__", type(value).__name__).encode())
    else:
        digest.update(repr(value).encode())


LATER = ("structure", "facts")  # without them a definition counts as before there were any
UNCOUNTED = ("source", "format", "findings", "description", "about", "command")
