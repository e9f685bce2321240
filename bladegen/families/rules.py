"""What is wrong with variants of a family: bounds, data, faults of sections, oddities."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from bladegen.blade.changes.deformation import AffineChange
from bladegen.blade.variants.batch import Batch, SectionBatch
from bladegen.blade.variants.designs import Design
from bladegen.blade.variants.factors import Factors
from bladegen.blade.variants.verdicts import leaving, strayed, unsound
from bladegen.errors import FamilyError
from bladegen.families.block import OF_SKIN, OVER_SPAN, of_skin, over_span
from bladegen.families.conditions import (
    at_spans,
    called,
    factor_numbers,
    matching,
    named,
    placed,
)
from bladegen.support.arguments import suggestion
from bladegen.support.arrays import Array, Indices, Mask

__all__ = ["Rules"]

AHEAD = 16  # draws of a variant looked at together, for the first that keeps to the data
STORED = (np.float64, np.float32)  # sections: conditions hold in both, whichever are written


@dataclass(frozen=True, eq=False)
class Rules:
    """What a sound variant keeps to.

    Parameters
    ----------
    sections : SectionBatch
        Makes and tests the sections.
    what : Factors
        What varies, and between which bounds.
    thinnest : float
        Least relative thickness of a sound section.
    allow_extrapolation, allow_odd : bool
        Whether sections may leave the space's data, and be odd.
    where : str
        Conditions on factors, volume, surface and what is over span; none if empty.
    """

    sections: SectionBatch
    what: Factors
    thinnest: float
    allow_extrapolation: bool
    allow_odd: bool
    where: str = ""

    def __post_init__(self) -> None:
        if self.where:
            known = [*map(called, self.what.names), *OF_SKIN]
            spanwise = placed(self.sections.eta, named(self.where), OVER_SPAN)
            every = [*known, *(f"{name}@0.7" for name in OVER_SPAN)]
            for name in named(self.where):
                if name not in known and name not in spanwise:
                    raise FamilyError(
                        f"where: {name!r} is not known while variants are drawn, but "
                        f"{', '.join(every)}{suggestion(name, every)}; `bladegen info FOLDER "
                        "--where` finds labels in what was made"
                    )

    @cached_property
    def measuring(self) -> bool:
        """Whether conditions name what is measured on sections."""
        measured = {*OF_SKIN, *OVER_SPAN}
        names = named(self.where) if self.where else ()
        return any(name.partition("@")[0] in measured for name in names)

    def split(self, values: Array) -> tuple[Array, AffineChange]:
        """Return coordinates and affine parameters of variants (b, d)."""
        return self.what.split(values, self.sections.modes)

    def tested(self, values: Array) -> list[str]:
        """Say what is wrong with variants (b, d), without making their sections."""
        reasons = self._strayed(values)
        near = np.flatnonzero([not reason for reason in reasons])
        if near.size:
            tested = self.sections.tested(*self.split(values[near]))
            for row, reason in zip(near, self.reasons(values[near], *tested), strict=True):
                reasons[row] = reason
        for kind in STORED if self.where else ():
            sound = np.flatnonzero([not reason for reason in reasons])
            if not sound.size:
                break
            made = None
            if self.measuring:
                how: dict[str, Any] = {"tested": False, "measured": True, "dtype": kind}
                made = self.sections.evaluate(*self.split(values[sound]), **how)
            for row, reason in zip(sound, self.unwanted(values[sound], made), strict=True):
                reasons[row] = reason
        return reasons

    def unwanted(self, values: Array, batch: Batch | None) -> list[str]:
        """Say which variants (b, d), with their measured sections, do not fulfil the conditions."""
        if not self.where:
            return [""] * len(values)
        known = factor_numbers(self.what.names, values)
        if batch is not None and self.measuring:
            names, eta = named(self.where), self.sections.eta
            known |= of_skin(batch) if not set(OF_SKIN).isdisjoint(names) else {}
            spanwise, arrays = placed(eta, names, OVER_SPAN), over_span(batch)
            known |= at_spans(eta, spanwise, lambda name, part: arrays[name][:, part])
        held = matching(known, self.where).tolist()
        return ["" if fulfilled else f"does not fulfil {self.where}" for fulfilled in held]

    def redrawn(
        self, design: Design, tries: int, index: Indices, values: Array, reasons: list[str]
    ) -> tuple[Array, Indices, list[str]]:
        """Draw again what is not sound; return values, numbers of draws and what is left."""
        values, reasons = values.copy(), list(reasons)
        attempts = np.ones(len(index), dtype=np.int64)
        again = np.flatnonzero([bool(reason) for reason in reasons])
        while again.size:
            ahead = np.minimum(attempts[again, None] + np.arange(AHEAD), tries - 1)
            drawn = design.redrawn(np.repeat(index[again], AHEAD), ahead.ravel())
            near = ~self.strayed(drawn).reshape(ahead.shape)
            at = np.where(near.any(axis=1), np.argmax(near, axis=1), AHEAD - 1)
            rows = np.arange(len(again))
            values[again] = drawn.reshape(*ahead.shape, -1)[rows, at]
            attempts[again] = ahead[rows, at] + 1
            some = near[rows, at] | (attempts[again] >= tries)
            tested = self.tested(values[again[some]])
            for row, reason in zip(again[some], tested, strict=True):
                reasons[row] = reason
            again = again[[bool(reasons[row]) and attempts[row] < tries for row in again]]
        return values, attempts, reasons

    def left(self, values: Array) -> Mask:
        """Tell which variants (b, d) have a section that leaves the space's data, (b,)."""
        if self.allow_extrapolation:
            return np.zeros(len(values), dtype=bool)
        return leaving(self.sections, self.split(values)[0])

    def strayed(self, values: Array) -> Mask:
        """Tell which variants (b, d) leave their bounds or the space's data, (b,)."""
        outside: Mask = np.array([bool(said) for said in self.what.outside(values)])
        return outside | self.left(values)

    def _strayed(self, values: Array) -> list[str]:
        """Say which variants (b, d) leave their bounds or the space's data; "" if none does."""
        reasons = self.what.outside(values)
        if self.allow_extrapolation:
            return reasons
        return _first(reasons, strayed(self.sections, self.split(values)[0]))

    def reasons(self, values: Array, faults: Indices, thickness: Array, looks: Array) -> list[str]:
        """Say what is wrong with variants (b, d), first thing first; "" if nothing is."""
        how: dict[str, Any] = {"thinnest": self.thinnest, "allow_odd": self.allow_odd}
        found = unsound(self.sections, faults, thickness, looks, **how)
        return _first(self._strayed(values), found)


def _first(reasons: list[str], others: list[str]) -> list[str]:
    """Return the reason of each variant, or where there is none the other."""
    return [one or other for one, other in zip(reasons, others, strict=True)]
