"""Labels of a family's variants, block by block: what `bladegen family --label` adds."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import version
from typing import Any

import numpy as np

from bladegen.definition.estimates import MODEL, available
from bladegen.errors import FamilyError
from bladegen.families.block import Block
from bladegen.families.family import Family
from bladegen.families.labels.figures import FIGURES, LABELS, STORED, Figure, axes
from bladegen.families.labels.mass import MassLabel
from bladegen.families.labels.polars import PolarLabel
from bladegen.families.labels.rotor import RotorLabel
from bladegen.support.arguments import one_of
from bladegen.support.arrays import Array
from bladegen.support.values import state_of

__all__ = ["Labelling", "checked"]

KINDS: dict[str, Any] = {"polars": PolarLabel, "rotor": RotorLabel, "mass": MassLabel}
BY_NETWORK = ("polars", "rotor")
AT_ONCE = 8  # variants; what lies between sections and figures then takes some 50 MB


def checked(labels: Sequence[str], family: Family) -> tuple[str, ...]:
    """Return labels once each, in the order of `LABELS`.

    Raises
    ------
    FamilyError
        If one is not known, or cannot be computed of this family.
    """
    for label in labels:
        one_of(label, LABELS, "label", FamilyError)
    definition = family.blade.definition
    if set(BY_NETWORK) & set(labels) and not available():
        raise FamilyError(
            "label: polars and rotor need NeuralFoil, which the extra aero installs: "
            "pip install 'bladegen[aero]'"
        )
    if "rotor" in labels and not definition.rotor.hub_radius:
        raise FamilyError(
            f"label: rotor needs a hub radius, and the definition of {definition.name} names none; "
            "write it into the file (windIO: components.hub.diameter)"
        )
    if "mass" in labels and definition.structure is None:
        raise FamilyError(
            f"label: mass needs layers, and the definition of {definition.name} has none; take a "
            "windIO file with the blade's structure, or leave mass out"
        )
    return tuple(label for label in LABELS if label in labels)


@dataclass(frozen=True, eq=False)
class Labelling:
    """Labels of a family.

    Parameters
    ----------
    family : Family
        The variants.
    labels : tuple of str
        Which, as `checked` returns them.
    """

    family: Family
    labels: tuple[str, ...]

    __getstate__ = state_of

    @cached_property
    def _kinds(self) -> dict[str, Any]:
        return {label: KINDS[label](self.family) for label in self.labels}

    @cached_property
    def settings(self) -> dict[str, Any]:
        """How each label is computed, as JSON values: a part of a family's identity."""
        found = {label: dict(kind.settings) for label, kind in self._kinds.items()}
        for label in set(BY_NETWORK) & set(found):
            found[label]["network"] = f"NeuralFoil {version('neuralfoil')} {MODEL}"
        return found

    @property
    def figures(self) -> tuple[Figure, ...]:
        """All figures of the labels."""
        return tuple(one for label in self.labels for one in FIGURES[label])

    def shape(self, figure: Figure) -> tuple[int, ...]:
        """Return the lengths of a figure's dimensions after the variant."""
        eta = self.family.eta
        lengths = {"span": len(eta)}
        for name, (_, values, _, _) in axes(self.labels, eta).items():
            lengths[name] = len(values)
        return tuple(lengths[name] for name in figure.dims)

    def arrays(self) -> dict[str, tuple[tuple[str, ...], tuple[int, ...]]]:
        """Return dimensions and lengths, after the variant, of arrays beside the sections."""
        stored = (one for one in self.figures if one.name in STORED)
        return {one.name: (one.dims, self.shape(one)) for one in stored}

    def computed(self, block: Block) -> dict[str, Array]:
        """Return the figures of a block's variants (b, ...), NaN where one is not sound."""
        rows, count = np.flatnonzero(block.valid), len(block.index)
        found = {one.name: np.full((count, *self.shape(one)), np.nan) for one in self.figures}
        for start in range(0, len(rows), AT_ONCE):
            some = rows[start : start + AT_ONCE]
            for kind in self._kinds.values():
                for name, values in kind.computed(block, some).items():
                    found[name][some] = values
        return found
