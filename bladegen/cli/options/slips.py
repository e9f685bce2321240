"""What the command line answers to numbers and words that it cannot take: what to type instead.

`Answering` is the class of every command: a usage error about a number names what was typed and
how it is written here, with decimal points, without units; words left over say what they may
belong to.
"""

import math
import re
from collections.abc import Sequence
from typing import Any

import typer.core
from typer import BadParameter

__all__ = ["Answering", "instead_of", "left_over"]

UsageError: Any = BadParameter.__bases__[0]  # of the click that typer uses, its own or not
_NUMBER = re.compile(r"([-+]?[0-9]*[.,]?[0-9]+(?:[eE][-+]?[0-9]+)?)\s*(%|deg|°|rad)?")
_THOUSANDS = re.compile(r"[-+]?[0-9]{1,3}(?:[,.' _][0-9]{3})+")
_UNITS = ("um", "mm", "cm", "m", "deg", "rad", "%")
FACTORS = (
    "--thickness",
    "--camber",
    "--chord",
    "--chord-scale",
    "--twist-scale",
    "--prebend-scale",
)
CHANGE = 50.0  # per cent; from there on a factor is meant: 105 %
_MOST = 1e9  # of whole numbers that are offered


class Answering(typer.core.TyperCommand):
    """A command whose usage errors say what to type."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Read the words of a command."""
        typed = list(args)
        try:
            return list(super().parse_args(ctx, args))
        except BadParameter as error:
            said = error.message
            if error.param is not None and re.search(r"valid (int|integer|number|float)\b", said):
                value = _typed(error.param.opts, typed)
                factor = any(flag in FACTORS for flag in error.param.opts)
                error.message = instead_of(value, whole="valid int" in said, factor=factor)
            raise
        except UsageError as error:
            if error.message.startswith("Got unexpected extra argument"):
                extra = error.message.rpartition("(")[2].rstrip(")").split()
                error.message += left_over(extra)
            raise


def _typed(flags: Sequence[str], words: Sequence[str]) -> str:
    """Return what was typed for an option, the last time."""
    found = ""
    for place, word in enumerate(words):
        flag, equals, value = word.partition("=")
        if flag in flags:
            found = value if equals else "".join(words[place + 1 : place + 2])
    return found


def instead_of(typed: str, *, whole: bool, factor: bool = False) -> str:
    """Return what is wrong with a text for a number, and the number that may be meant.

    Per cents are shares, and changes where the number is a `factor` that 1 leaves as it is.

    >>> instead_of("1e3", whole=True)
    "got '1e3', must be a whole number, in digits alone; such as 1000"
    >>> instead_of("1,05", whole=False)
    "got '1,05', must be a number with a decimal point, without a unit; such as 1.05"
    >>> instead_of("-5%", whole=False, factor=True)
    "got '-5%', must be a factor with a decimal point, 1 for no change; such as 0.95"
    """
    must = "a whole number, in digits alone"
    if factor:
        must = "a factor with a decimal point, 1 for no change"
    elif not whole:
        must = "a number with a decimal point, without a unit"
    return f"got {typed!r}, must be {must}{_such(typed.strip(), whole, factor)}"


def _such(typed: str, whole: bool, factor: bool) -> str:
    """Return the number that a text may mean, as it is typed, "" if none is near."""
    match = _NUMBER.fullmatch(typed)
    if whole and _THOUSANDS.fullmatch(typed):
        return f"; such as {re.sub('[^-0-9]', '', typed)}"
    if match is None:
        return ""
    value = float(match[1].replace(",", "."))
    if match[2] == "%":
        change = factor and abs(value) < CHANGE
        value = (100 + value if change else value) / 100
    elif match[2] == "rad":
        value = math.degrees(value)
    if not whole:
        return f"; such as {value:.6g}"
    return f"; such as {value:.0f}" if value == round(value) and abs(value) <= _MOST else ""


def left_over(words: Sequence[str]) -> str:
    """Say what words may belong to that no argument takes.

    >>> left_over(["mm"])
    ': a length or angle has no blank before its unit, such as 2mm'
    """
    if words and words[0] in _UNITS:
        return ": a length or angle has no blank before its unit, such as 2mm"
    if words and all(map(_NUMBER.fullmatch, words)):
        return ": numbers of one option have commas between, without blanks, such as 0.1,0,0,0"
    if words and all(word.startswith(".") for word in words):
        return ": formats have commas between, without blanks, such as step,stl"
    if any("=" in word or ":" in word for word in words):
        return ": a name and its bounds are one word, such as thickness=0.9:1.1"
    return ""
