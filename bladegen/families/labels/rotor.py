"""What rotors do with a family's variants: the figures of `bladegen evaluate`, for each."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from bladegen.blade.aero.elements import Elements, elements_of
from bladegen.blade.aero.energy import Conditions
from bladegen.blade.aero.evaluation import SPANS, conditions_of, evaluate, gigawatt_hours, sure
from bladegen.blade.variants.batch import SectionBatch
from bladegen.families.block import Block
from bladegen.families.family import Family
from bladegen.support.arrays import Array, Indices
from bladegen.support.values import state_of

__all__ = ["RotorLabel"]


@dataclass(frozen=True, eq=False)
class RotorLabel:
    """Evaluates the rotors of a family, at spans of its own.

    Parameters
    ----------
    family : Family
        The variants; its baseline says what the rotor is and how it works.
    """

    family: Family

    __getstate__ = state_of

    @property
    def settings(self) -> dict[str, Any]:
        """Under which conditions the rotors work."""
        return dict(self._conditions.named)

    @cached_property
    def _sections(self) -> SectionBatch:
        family = self.family
        return SectionBatch(family.blade, family.space, family.window, SPANS, family.chord_line)

    @cached_property
    def _conditions(self) -> Conditions:
        blade = self.family.blade
        plain = blade.mirror_image() if blade.mirrored else blade
        baseline = self._cut(plain.sections(SPANS)[None])
        return conditions_of(baseline, blade.definition.rotor)

    def _cut(self, sections: Array) -> Elements:
        rotor = self.family.blade.definition.rotor
        assert rotor.hub_radius is not None  # `labelling.checked` saw to it
        return elements_of(sections, rotor.hub_radius, rotor.cone or 0.0)

    def computed(self, block: Block, rows: Indices) -> dict[str, Array]:
        """Return the figures of some variants of a block, by name."""
        what, blades = self.family.design.what, self.family.blade.definition.rotor.blades
        values = what.split(block.values[rows], self._sections.modes)
        elements = self._cut(self._sections.evaluate(*values, tested=False).sections)
        found = evaluate(elements, blades, self._conditions)
        best = found.performance
        power, thrust, moment = best.best.T
        return {
            "rotor_power_coefficient": power,
            "rotor_optimum_ratio": best.ratio,
            "rotor_optimum_pitch": np.degrees(best.pitch),
            "rotor_thrust_coefficient": thrust,
            "rotor_moment_coefficient": moment,
            "rotor_rated_wind": found.rated_wind,
            "rotor_root_moment": found.root_moment,
            "rotor_annual_energy": gigawatt_hours(found.energy),
            "rotor_least_confidence": sure(found),
            "rotor_power_curve": best.power,
            "rotor_thrust_curve": best.thrust,
            "rotor_moment_curve": best.moment,
        }
