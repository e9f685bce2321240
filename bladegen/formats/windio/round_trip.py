"""YAML files that are written again as they stand: order, comments, anchors, figures as typed.

The parser is ruamel.yaml's; a file has been through `yaml_file` before, which bounds it.
"""

import re
import warnings
from pathlib import Path
from typing import Any

from bladegen.errors import FileError

__all__ = ["flow", "round_trip"]

FLOAT = "tag:yaml.org,2002:float"
WIDE = 1_000_000  # characters of a line, so that lists stay on theirs


def round_trip(path: Path) -> tuple[Any, Any]:
    """Return a parser that makes plain data and keeps what it reads, and what it read."""
    from ruamel.yaml import YAML
    from ruamel.yaml.constructor import RoundTripConstructor
    from ruamel.yaml.error import ReusedAnchorWarning, YAMLError
    from ruamel.yaml.representer import RoundTripRepresenter

    class Constructor(RoundTripConstructor):
        pass

    class Representer(RoundTripRepresenter):
        pass

    Constructor.add_constructor(FLOAT, lambda _, node: _Written(node.value, node.anchor))
    Representer.add_representer(_Written, _Written.represented)
    yaml = YAML(typ="rt")
    yaml.Constructor, yaml.Representer = Constructor, Representer
    yaml.preserve_quotes = True
    yaml.width = WIDE
    text = path.read_text(encoding="utf-8")
    yaml.allow_unicode = not text.isascii()  # characters that the file escapes stay escaped
    yaml.indent(**_indents(text))
    try:
        with warnings.catch_warnings():  # an anchor may stand twice
            warnings.simplefilter("ignore", ReusedAnchorWarning)
            return yaml, yaml.load(text)
    except (YAMLError, ValueError) as error:
        said = " ".join(str(error).split())
        raise FileError(str(path), [f"cannot be kept as it is: {said}"]) from None


class _Written(float):
    """A number with the text it was written as: ruamel.yaml's own may lose its last digit."""

    text: str
    anchor: str | None

    def __new__(cls, text: str, anchor: str | None) -> "_Written":
        made = super().__new__(cls, _value(text))
        made.text, made.anchor = text, anchor
        return made

    @staticmethod
    def represented(representer: Any, number: "_Written") -> Any:
        return representer.represent_scalar(FLOAT, number.text, anchor=number.anchor)


def _value(text: str) -> float:
    """Return the value of a float of YAML 1.2; infinities and not-a-number have a dot there."""
    return float(re.sub(r"\.(?=inf|nan)", "", text.lower()))


def _indents(text: str) -> dict[str, int]:
    """Return how far a text indents mappings, and lists and their dashes."""
    found = {"mapping": 2, "sequence": 2, "offset": 0}
    key = re.search(r"^\w[^\n]*:[ ]*\n( +)\w", text, re.MULTILINE)
    if key:
        found["mapping"] = len(key[1])
    dash = re.search(r"^( *)\w[^\n:]*:[ ]*\n( *)-( +)\w", text, re.MULTILINE)
    if dash:
        found["offset"] = len(dash[2]) - len(dash[1])
        found["sequence"] = found["offset"] + 1 + len(dash[3])
    return found


def flow(value: Any) -> Any:
    """Return a value for ruamel.yaml, lists of numbers on one line."""
    from ruamel.yaml.comments import CommentedMap, CommentedSeq

    if isinstance(value, dict):
        return CommentedMap((key, flow(part)) for key, part in value.items())
    if isinstance(value, list):
        made = CommentedSeq(flow(part) for part in value)
        if not any(isinstance(part, dict | list) for part in value):
            made.fa.set_flow_style()
        return made
    return value
