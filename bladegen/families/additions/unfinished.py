"""Which labels are being added to a family's folder: noted there until all is whole."""

import json
from collections.abc import Mapping
from typing import Any

from bladegen.errors import FamilyError
from bladegen.families.folder import FamilyFolder
from bladegen.families.storage.places import folder, replacing

__all__ = ["note", "require_none", "unfinished"]

FILE = "labels.json"


def unfinished(place: FamilyFolder) -> dict[str, Any]:
    """Return the labels that are being added, by name how each is computed."""
    file = place.labels / FILE
    found = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
    return found if isinstance(found, dict) else {}


def note(place: FamilyFolder, settings: Mapping[str, Any]) -> None:
    """Note that labels are being added, and how each is computed."""
    folder(place.labels)
    with replacing(place.labels / FILE) as temporary:
        temporary.write_text(json.dumps(settings), encoding="utf-8")


def require_none(place: FamilyFolder) -> None:
    """Raise if labels are being added.

    Raises
    ------
    FamilyError
        That says how to go on with them.
    """
    if labels := " ".join(unfinished(place)):
        raise FamilyError(
            f"{place.path}: labels are being added to it; `bladegen label {place.path} {labels}` "
            "goes on"
        )
