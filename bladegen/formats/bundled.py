"""The blades that come with bladegen: their names, their files, and what a list shows of them.

Facts stand in ``contents.json`` beside the files, so that a list reads no blade, and what the
layers of a blade weigh in ``layups.json``, so that no sections are made to show it; tests hold
them against the blades.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from bladegen.definition.blade_definition import BladeDefinition

__all__ = ["Facts", "bundled", "facts", "home", "layups"]


@dataclass(frozen=True)
class Facts:
    """What a list shows of a blade: its description, its length in metres, how many airfoils."""

    description: str
    length: float
    airfoils: int

    @classmethod
    def of(cls, definition: "BladeDefinition") -> "Facts":
        """Return what a list shows of a definition."""
        airfoils = {station.airfoil.name for station in definition.stations}
        return cls(definition.description, round(definition.length, 6), len(airfoils))


def bundled() -> tuple[str, ...]:
    """Return the names of the blades that come with bladegen."""
    return tuple(sorted(path.stem for path in home().glob("*.yaml")))


def facts() -> dict[str, Facts]:
    """Return what a list shows of bundled blades, by their names."""
    known = json.loads((home() / "contents.json").read_text(encoding="utf-8"))
    return {name: Facts(**values) for name, values in known.items()}


def layups() -> dict[str, dict[str, Any]]:
    """Return what lies inside the skin of bundled blades that have a structure, by their names.

    Each is as `views.tables.layup_figures` gives it, to six digits, with its findings.
    """
    known: dict[str, dict[str, Any]] = json.loads(
        (home() / "layups.json").read_text(encoding="utf-8")
    )
    return known


def home() -> Path:
    """Return the folder of the bundled blades, in a wheel or in a checkout."""
    package = Path(__file__).resolve().parent.parent
    installed = package / "blades"
    return installed if installed.is_dir() else package.parent / "blades"
