"""The dataset of a family whose sections and manifest are whole: arrays, card, space."""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from bladegen.exports.provenance import blade_settings, made_from
from bladegen.families.dataset.card import card
from bladegen.families.dataset.store import complete
from bladegen.families.dataset.variables import parameter
from bladegen.families.folder import FamilyFolder, read_manifest
from bladegen.families.order import Order
from bladegen.families.storage.places import replacing
from bladegen.shapes.shape_space import ShapeSpace

__all__ = ["CARD", "about", "write_card", "write_dataset"]

CARD, SPACE = "CARD.md", "space.npz"


def write_dataset(order: Order) -> None:
    """Add to a family's store what its manifest holds, and write the card beside it.

    Raises
    ------
    ExportError
        If something cannot be written.
    """
    place, identity = order.place, order.identity
    told = about(order)
    complete(place.store, place.manifest, identity, told)
    space = order.family.space
    if space is not None and space != ShapeSpace.bundled().at(space.u) and space.is_own:
        with replacing(place.path / SPACE) as temporary:
            space.save(temporary)
    write_card(place, identity, told)


def write_card(place: FamilyFolder, identity: dict[str, Any], told: Mapping[str, Any]) -> None:
    """Write the card of a family, by what its folder and its dataset say of it."""
    rows = read_manifest(place, ("valid", "attempts"))
    varied = [parameter(factor) for factor in identity["factors"]]
    values = read_manifest(place, tuple(one.column for one in varied))
    ranges = {
        one.name: (float(values[one.column].min()), float(values[one.column].max()), one.units)
        for one in varied
    }
    text = card(identity, told, ranges, int(rows["valid"].sum()), int(np.sum(rows["attempts"])))
    with replacing(place.path / CARD) as temporary:
        temporary.write_text(text, encoding="utf-8")


def about(order: Order) -> dict[str, Any]:
    """Return what a family's dataset says of itself: the same wherever it is made."""
    blade, design = order.family.blade, order.family.design
    made = made_from(blade, {}, order.options.command)
    return {
        "title": f"{len(design)} variants of {blade.name}",
        "source": f"bladegen {made.version}",
        "bladegen_version": made.version,
        "command": made.command,
        "design": design.kind,
        "seed": design.seed if design.seed < 2**63 else str(design.seed),
        "baseline": blade.definition.name,
        "baseline_file": made.source,
        "baseline_sha256": made.sha256,
        "baseline_settings": json.dumps(blade_settings(blade)),  # a text: netCDF takes no mapping
        "made_from": made.text,
    }
