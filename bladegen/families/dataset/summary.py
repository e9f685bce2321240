"""What a family that was written holds, as figures: for the command line."""

from typing import Any

import numpy as np

from bladegen.families.dataset.loading import LoadedFamily
from bladegen.families.dataset.splits import SPLITS
from bladegen.families.storage.places import bytes_in

__all__ = ["figures"]


def figures(family: LoadedFamily) -> dict[str, Any]:
    """Return what a family holds: counts, how it was made, and ranges of what varies.

    ``ranges`` has for each number of a variant its unit, its least, mean and largest value and its
    standard deviation, over the sound variants.
    """
    about, identity, sound = family.attributes, family.identity, family.valid
    values = family.numbers
    ranges = {
        name: {
            "unit": str(family.store[name].attrs.get("units", "")) if name in family.store else "",
            "least": float(np.nanmin(own[sound])),
            "mean": float(np.nanmean(own[sound])),
            "largest": float(np.nanmax(own[sound])),
            "deviation": float(np.nanstd(own[sound])),
        }
        for name, own in values.items()
        if name not in ("variant", "valid", "attempts") and np.isfinite(own[sound]).any()
    }
    return {
        "family": str(family.path),
        "blade": identity["blade"],
        "variants": len(family),
        "sound": int(np.count_nonzero(sound)),
        "draws": int(values["attempts"].sum()) if "attempts" in values else None,
        "design": identity["design"],
        "seed": identity["seed"],
        "sections": f"{identity['spans']} of {identity['landmarks']} landmarks",
        "labels": ", ".join(identity.get("labels", {})) or "none",
        "files_of_variants": ", ".join(identity["formats"]) or "none",
        "splits": {name: len(family.split(name, sound=False)) for name in SPLITS},
        "megabytes": bytes_in(family.path) / 1e6,
        "made_by": f"bladegen {identity['bladegen']}",
        "command": about.get("command", ""),
        "ranges": ranges,
    }
