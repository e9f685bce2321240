"""Families: many perturbed variants of one blade, planned by a design and tested.

`family` plans variants and gives them one after the other as blades; `Family.block` makes the
sections of many at once (`batch`), for files and for learning.  A variant whose sections cross
themselves, lose their thickness, leave the data or are odd (`sanity`) is drawn again up to a
limit, or kept and marked.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from bladegen.airfoils.chord_lines import KEPT, known_convention
from bladegen.blade.blade import Blade
from bladegen.blade.changes.deformation import RANGES, Window
from bladegen.blade.variants.batch import SectionBatch
from bladegen.blade.variants.designs import Design
from bladegen.blade.variants.draws import Seed
from bladegen.blade.variants.factors import factors
from bladegen.blade.variants.verdicts import THINNEST
from bladegen.errors import FamilyError, PlaceError
from bladegen.families import members
from bladegen.families.block import Block
from bladegen.families.rules import Rules
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arguments import instance, one_of, whole
from bladegen.support.arrays import Array, Indices
from bladegen.support.files import safe_stem
from bladegen.support.values import state_of

__all__ = ["BLOCK", "POLICIES", "Family", "family"]

BLOCK = 64  # variants made at once; what a run may lose
TRIES = 1000  # draws of one variant before it is kept and marked
SPANS = 100
POLICIES = ("redraw", "keep")


@dataclass(frozen=True, eq=False)
class Family:
    """A planned family of variants.  `family` makes one.

    Parameters
    ----------
    blade : Blade
        The baseline.
    space : ShapeSpace, optional
        Modes of deformation.
    design : Design
        Which variants.
    window : Window
        Where along the span they act.
    eta : (k,) array
        Span fractions of the sections that are made and tested.
    invalid : str
        "redraw" or "keep" variants that are not sound.
    tries : int
        Draws of one variant before it is kept and marked.
    thinnest : float
        Least relative thickness of a sound section.
    chord_line : str
        What a change of shape does with the chord line, as for `Blade.perturbed`.
    allow_extrapolation, allow_odd : bool
        Whether sections may leave the space's data, and be odd.
    where : str
        Conditions that variants fulfil: see `family`.
    """

    blade: Blade
    space: ShapeSpace | None
    design: Design
    window: Window
    eta: Array
    invalid: str = "redraw"
    tries: int = TRIES
    thinnest: float = THINNEST
    chord_line: str = KEPT
    allow_extrapolation: bool = False
    allow_odd: bool = False
    where: str = ""

    def __post_init__(self) -> None:
        must = "a Blade; bladegen.Blade.from_definition(bladegen.read('iea15mw')) makes one"
        instance(self.blade, Blade, "blade", must, FamilyError)
        instance(self.window, Window, "window", "a bladegen.Window(start, end)", FamilyError)
        one_of(self.invalid, POLICIES, "invalid", FamilyError)
        if whole(self.tries, "tries", FamilyError) < 1:
            raise FamilyError(f"tries: got {self.tries}, must be at least 1")
        known_convention(self.chord_line)
        if self.space is not None:
            must = "a ShapeSpace, such as bladegen.ShapeSpace.bundled()"
            instance(self.space, ShapeSpace, "space", must, FamilyError)
            object.__setattr__(self, "space", self.space.at(self.blade.u))
        _ = self._rules  # refuses conditions that cannot be

    def __repr__(self) -> str:
        return (
            f"<Family of {self.blade.name}: {len(self)} variants, {self.design.kind}, seed "
            f"{self.design.seed}, of {', '.join(self.design.what.names)}>"
        )

    __getstate__ = state_of

    def __len__(self) -> int:
        return len(self.design)

    __getitem__, table, _repr_html_ = members.member, members.table, members.html

    def __iter__(self) -> Iterator[Blade]:
        for first in range(0, len(self), BLOCK):
            index = np.arange(first, min(first + BLOCK, len(self)))
            for place, values in zip(index, self._drawn(index), strict=True):
                yield self._blade(int(place), values)

    @cached_property
    def _sections(self) -> SectionBatch:
        return SectionBatch(self.blade, self.space, self.window, self.eta, self.chord_line)

    @cached_property
    def _rules(self) -> Rules:
        what, extrapolation = self.design.what, self.allow_extrapolation
        return Rules(self._sections, what, self.thinnest, extrapolation, self.allow_odd, self.where)

    def block(self, index: Indices, *, dtype: type = np.float64, measured: bool = False) -> Block:
        """Make the sections of some variants, drawn again where they are not sound.

        Parameters
        ----------
        index : (b,) array of int
            Which variants.
        dtype : type
            Of the sections.
        measured : bool
            Measure areas, centroids and so on (`Batch.measures`).
        """
        made: dict[str, Any] = {"dtype": dtype, "measured": measured or self._rules.measuring}
        values = self.design.at(index)
        many = np.count_nonzero(self._rules.left(values)) > len(index) // 2
        if (many or self._rules.measuring) and self._redraws:
            refused = self._rules.tested(values)  # sections of so many would be made in vain
            values, attempts, reasons = self._redrawn(index, values, refused)
            batch = self._sections.evaluate(*self._rules.split(values), **made)
            return Block(index, values, attempts, tuple(reasons), tuple(refused), batch).of(
                self.blade
            )
        batch = self._sections.evaluate(*self._rules.split(values), **made)
        rules = self._rules
        refused = rules.reasons(values, batch.faults, batch.relative_thickness, batch.looks)
        unwanted = rules.unwanted(values, batch)
        refused = [one or other for one, other in zip(refused, unwanted, strict=True)]
        values, attempts, reasons = self._redrawn(index, values, refused)
        again = np.flatnonzero(attempts > 1)
        if again.size:
            batch.take(again, self._sections.evaluate(*self._rules.split(values[again]), **made))
        return Block(index, values, attempts, tuple(reasons), tuple(refused), batch).of(self.blade)

    @property
    def _redraws(self) -> bool:
        return self.invalid == "redraw" and self.design.redraws and self.tries > 1

    def named(self, block: Block, place: int) -> Blade:
        """Return one variant of a block as a blade."""
        row = int(np.flatnonzero(block.index == place)[0])
        return self._blade(place, block.values[row])

    def variant(self, place: int) -> Blade:
        """Return one variant as a blade, whether it is sound or not."""
        place = whole(place, "variant", FamilyError)
        if not 0 <= place < len(self):
            raise PlaceError(f"variant: got {place}, allowed is 0 to {len(self) - 1}")
        return self._blade(place, self._drawn(np.array([place]))[0])

    def name(self, place: int) -> str:
        """Return the name of a variant; names sort as their places do."""
        ending = self.blade.name.removeprefix(self.blade.definition.name)  # of a mirror image
        return f"{self._plain_name(place)}{ending}"

    def _plain_name(self, place: int) -> str:
        digits = max(5, len(str(len(self) - 1)))
        return f"{safe_stem(self.blade.definition.name)}-{place:0{digits}d}"

    def _blade(self, place: int, values: Array) -> Blade:
        t, change = self._rules.split(values[None])
        single: Any = {name: float(np.ravel(getattr(change, name))[0]) for name in RANGES}
        return self.blade.untested(
            self.space,
            t[0],
            replace(change, **single),
            window=self.window,
            chord_line=self.chord_line,
            allow_extrapolation=True,
            name=self._plain_name(place),
        )

    def _drawn(self, index: Indices) -> Array:
        """Return the values (b, d) of variants, after all redrawing."""
        return self.settled(index)[0] if self._redraws else self.design.at(index)

    def settled(self, index: Indices) -> tuple[Array, Indices, list[str]]:
        """Return values (b, d) of variants after all redrawing, numbers of draws, what is wrong."""
        values = self.design.at(index)
        return self._redrawn(index, values, self._rules.tested(values))

    def _redrawn(
        self, index: Indices, values: Array, reasons: list[str]
    ) -> tuple[Array, Indices, list[str]]:
        """Draw again what is not sound; return values, numbers of draws and what is left."""
        if self._redraws:
            return self._rules.redrawn(self.design, self.tries, index, values, reasons)
        return values.copy(), np.ones(len(index), dtype=np.int64), list(reasons)


def family(
    blade: Blade,
    space: ShapeSpace | None = None,
    *,
    count: int = 100,
    seed: Seed = 0,
    design: str | Design = "ellipsoid",
    bounds: Mapping[str, tuple[float, float]] | None = None,
    reach: float = 1.0,
    window: Window | None = None,
    spans: int = SPANS,
    invalid: str = "redraw",
    tries: int = TRIES,
    chord_line: str = KEPT,
    allow_extrapolation: bool = False,
    allow_odd: bool = False,
    where: str = "",
) -> Family:
    """Plan a family of perturbed blades; iterate over it for the blades.

    Parameters
    ----------
    blade : Blade
        The baseline; of a mirror image all variants are mirrored.
    space : ShapeSpace, optional
        Modes of deformation, such as `ShapeSpace.bundled()`; all its coordinates vary.
    count : int
        How many variants.
    seed : int, None or anything that `numpy.random.default_rng` takes
        Of the draws: variant i is the same for the same number.  A generator gives such a number
        and moves on, None takes a fresh one; `Family.design.seed` and the manifest hold it.
    design : str or Design
        One of `designs.DESIGNS`, or a design of one's own (`designs.tabulated`).
    bounds : mapping of str to (low, high), optional
        What else varies and between which bounds: see `factors.factors`; twist in radians.
    reach : float
        Share of the space's bounds that is used.
    window : Window, optional
        Where along the span they act; by default as for `Blade.perturbed`.
    spans : int
        At how many spans sections are made and tested.
    invalid : str
        "redraw" variants that are not sound, up to `tries` draws, or "keep" them, marked.
    chord_line : str
        "kept" where the baseline has it, or as in the "paper": see `Blade.perturbed`.
    allow_extrapolation, allow_odd : bool
        Take variants whose sections leave the space's data, or are odd: see `Blade.perturbed`.
    where : str
        Take variants that fulfil conditions only: "volume > 610 and twist_change < 1".  They may
        name what varies (degrees; changes as datasets have them), volume [m3], surface [m2], and
        what is over span at a place ("thickness@0.7 < 0.24").

    Raises
    ------
    DesignError, FamilyError, PerturbationError
        If something asked for is not there or out of range.

    >>> import bladegen as bg
    >>> blade = bg.Blade.from_definition(bg.read("dtu10mw"))
    >>> [variant.name for variant in bg.family(blade, bg.ShapeSpace.bundled(), count=2, seed=7)]
    ['dtu10mw-00000', 'dtu10mw-00001']
    """
    must = "a Blade; bladegen.Blade.from_definition(bladegen.read('iea15mw')) makes one"
    instance(blade, Blade, "blade", must, FamilyError)
    if space is not None:
        must = "a ShapeSpace, such as bladegen.ShapeSpace.bundled(), or None"
        instance(space, ShapeSpace, "space", must, FamilyError)
    if not isinstance(design, Design):
        design = Design.of(factors(space, bounds, reach=reach), design, count, seed, space)
    return Family(
        blade,
        space,
        design,
        Window.beyond_circles(blade.definition.stations) if window is None else window,
        blade.stations(spans),
        invalid,
        tries,
        chord_line=chord_line,
        allow_extrapolation=allow_extrapolation,
        allow_odd=allow_odd,
        where=where,
    )
