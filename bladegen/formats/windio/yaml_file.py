"""YAML files to plain dicts, lists, texts and numbers, safely and fast.

The parser is libyaml where PyYAML has it, read as a stream of events: no tag is followed,
nesting and size are bounded (libyaml's own composer recurses, and a file of 100,000 brackets
overflows the stack of the machine), and an alias is one more name for the same object, so
that it cannot blow up.  Scalars follow YAML 1.2, in which `5e-05` is a number, `no` a text.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NoReturn

import yaml

from bladegen.errors import FileError, Finding
from bladegen.support.files import content_of

__all__ = ["YamlError", "load_yaml", "parse_yaml"]

MAX_BYTES = 64 * 2**20  # the largest windIO example has 0.7 MB
MAX_VALUES = 4_000_000  # bounds memory: 64 MB may hold 30 million brackets
MAX_DEPTH = 64  # windIO nests 9 deep
MAX_DIGITS = 400  # the largest double has 309 before its point

_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_NUMBER = re.compile(r"[-+]?(?:\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_WORDS: dict[str, Any] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), float("nan")),
    **dict.fromkeys((".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"), float("inf")),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), float("-inf")),
}
_TAG = "tag:yaml.org,2002:"
_TEXT_TAGS = ("!", _TAG + "str")
_SCALAR_TAGS = (None, *_TEXT_TAGS, *(_TAG + kind for kind in ("int", "float", "bool", "null")))
_COLLECTION_TAGS = (None, "!", _TAG + "map", _TAG + "seq")
_MERGE = "<<"


class YamlError(Exception):
    """A file that cannot be read, or that holds something else than plain data."""


def load_yaml(path: Path) -> tuple[Any, list[Finding]]:
    """Parse a YAML file of at most 64 MB; see `parse_yaml`."""
    try:
        return parse_yaml(content_of(path, MAX_BYTES))
    except FileError as error:
        raise YamlError(error.problems[0]) from None


def parse_yaml(content: bytes | str) -> tuple[Any, list[Finding]]:
    """Parse one YAML document.

    Returns
    -------
    value, findings
        The document as dicts with text keys, lists, texts, numbers, booleans and None;
        a finding for each key that a mapping gives twice (the last one holds).

    Raises
    ------
    YamlError
        With line and column, if this is no YAML or no plain data.
    """
    builder = _Builder()
    try:
        for event in yaml.parse(content, Loader=_LOADER):
            builder.take(event)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        said = f"is no YAML: {error.problem or error.context}{_place(mark)}"
        raise YamlError(f"{said}{_tab(content, mark)}") from None
    except yaml.YAMLError as error:  # bytes that are no text
        raise YamlError("is no YAML: " + " ".join(str(error).split())) from None
    return builder.value, builder.findings


@dataclass
class _Open:
    """A list or mapping whose end has not been met, and the key that waits for its value."""

    value: Any
    anchor: str | None = None
    key: str | None = None


@dataclass
class _Builder:
    """Plain values from parser events; open collections stand in a list, not on the stack."""

    value: Any = None
    findings: list[Finding] = field(default_factory=list)
    open: list[_Open] = field(default_factory=list)
    anchors: dict[str, Any] = field(default_factory=dict)
    values: int = 0
    documents: int = 0

    def take(self, event: Any) -> None:
        kind = type(event)
        if kind is yaml.ScalarEvent:
            self.scalar(event)
        elif kind is yaml.SequenceStartEvent:
            self.start(event, [])
        elif kind is yaml.MappingStartEvent:
            self.start(event, {})
        elif kind is yaml.SequenceEndEvent or kind is yaml.MappingEndEvent:
            closed = self.open.pop()
            if closed.anchor is not None:  # only now, so that nothing can hold itself
                self.anchors[closed.anchor] = closed.value
        elif kind is yaml.AliasEvent:
            if event.anchor not in self.anchors:
                self.refuse(event, f"alias *{event.anchor} names nothing that ends above it")
            self.put(event, self.anchors[event.anchor])
        elif kind is yaml.DocumentStartEvent:
            self.documents += 1
            if self.documents > 1:
                self.refuse(event, "a second document starts, one a file is allowed")

    def scalar(self, event: Any) -> None:
        if event.tag not in _SCALAR_TAGS:
            self.refuse(event, f"tag {event.tag!r} is not allowed")
        if self.open and self.open[-1].key is None and type(self.open[-1].value) is dict:
            self.key(event)
            return
        is_text = event.tag in _TEXT_TAGS or not (event.implicit[0] or event.tag)
        value = event.value if is_text else _plain(event.value)
        if event.anchor is not None:
            self.anchors[event.anchor] = value
        self.put(event, value)

    def start(self, event: Any, value: Any) -> None:
        if event.tag not in _COLLECTION_TAGS:
            self.refuse(event, f"tag {event.tag!r} is not allowed")
        if len(self.open) == MAX_DEPTH:
            self.refuse(event, f"nested more than {MAX_DEPTH} deep")
        self.put(event, value)
        self.open.append(_Open(value, event.anchor))

    def key(self, event: Any) -> None:
        holder = self.open[-1]
        if event.value == _MERGE and event.implicit[0]:
            self.refuse(event, "merge keys (<<) are not supported")
        if event.value in holder.value:
            where = _place(event.start_mark).strip(" ()")
            self.findings.append(Finding(where, f"key {event.value!r} again; the last one holds"))
        holder.key = event.value

    def put(self, event: Any, value: Any) -> None:
        self.values += 1
        if self.values > MAX_VALUES:
            self.refuse(event, f"more than {MAX_VALUES} values")
        if not self.open:
            self.value = value
            return
        holder = self.open[-1]
        if type(holder.value) is list:
            holder.value.append(value)
        elif holder.key is None:
            self.refuse(event, "a key must be a text")
        else:
            holder.value[holder.key] = value
            holder.key = None

    def refuse(self, event: Any, message: str) -> NoReturn:
        raise YamlError(f"is no plain YAML: {message}{_place(event.start_mark)}")


def _place(mark: Any) -> str:
    return "" if mark is None else f" (line {mark.line + 1}, column {mark.column + 1})"


def _tab(content: Any, mark: Any) -> str:
    """Say that a line is indented by a tab, if it is the one that could not be read."""
    lines = (content if isinstance(content, bytes) else content.encode()).splitlines()
    line = lines[mark.line] if mark is not None and mark.line < len(lines) else b""
    indent = line[: len(line) - len(line.lstrip())]
    return ": a tab indents it, YAML takes blanks" if b"\t" in indent else ""


def _plain(text: str) -> Any:
    """Return the value of a plain scalar after the core schema of YAML 1.2, decimals only."""
    match = _NUMBER.fullmatch(text)
    if match is None:
        return _WORDS.get(text, text)
    if match[1] is match[2] is None and text.lstrip("+-").isdigit() and len(text) <= MAX_DIGITS:
        return int(text)
    return float(text)
