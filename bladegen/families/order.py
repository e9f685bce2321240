"""What a run of a family writes, and where."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from bladegen.errors import ExportError, FamilyError
from bladegen.exports.options import Kind, Options
from bladegen.exports.products import require
from bladegen.exports.registry import format_of
from bladegen.families.family import BLOCK, Family
from bladegen.families.folder import FLOAT_TYPES, GRAPH, FamilyFolder
from bladegen.families.identity import fingerprint, identity
from bladegen.families.labels.labelling import Labelling, checked
from bladegen.families.storage.layout import block_of, home_of
from bladegen.families.storage.places import located
from bladegen.formats.writing import MIRRORED
from bladegen.support.arrays import Array
from bladegen.surface.fitting import fitted

__all__ = ["Order"]

FEW = 2  # variants in a block that writes files for each: shared out evenly among processes


@dataclass(frozen=True, eq=False)
class Order:
    """What is to be written where.

    Parameters
    ----------
    family : Family
        The variants.
    target : Path or str
        The folder, or a place in an object store ("s3://bucket/family"); workers elsewhere must
        see it under the same name.
    formats : tuple of str
        Suffixes of files for each sound variant; none by default.
    dtype : str
        Of the stored sections: "float32" or "float64".
    options : Options
        How files are made.
    graph : bool
        Store normals and areas of the points, and the graph that they make, beside the sections.
    labels : tuple of str
        What else is computed of each sound variant: of `labels.figures.LABELS`.
    """

    family: Family
    target: Path
    formats: tuple[str, ...] = ()
    dtype: str = "float32"
    options: Options = field(default_factory=Options)
    graph: bool = False
    labels: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "target", located(self.target))
        if self.dtype not in FLOAT_TYPES:
            raise FamilyError(f"dtype: got {self.dtype!r}, allowed are {', '.join(FLOAT_TYPES)}")
        for suffix in self.suffixes:
            kind = format_of(Path(f"x{suffix}")).kind
            if kind is Kind.definition and self.family.blade.mirrored:
                raise ExportError(MIRRORED)
            require(self.family.blade, kind)
        # Sums depend in their last digit on how many threads add them up: what the family has
        # computed so far is left behind, and `making.make_block` computes it again in one thread.
        fresh = replace(self.family, blade=replace(self.family.blade))
        object.__setattr__(self, "family", fresh)
        object.__setattr__(self, "labels", checked(self.labels, fresh))

    @property
    def suffixes(self) -> list[str]:
        """The formats' suffixes, with their dots."""
        return [f".{suffix.lower().lstrip('.')}" for suffix in self.formats]

    @property
    def place(self) -> FamilyFolder:
        """The folder."""
        return FamilyFolder(self.target, self.block)

    @property
    def identity(self) -> dict[str, Any]:
        """What the folder will hold."""
        made: dict[str, Any] = {"dtype": self.dtype, "formats": self.suffixes}
        if self.suffixes:
            made["options_fingerprint"] = fingerprint(self.options)
        if self.graph:
            made["graph"] = True
        if self.labels:
            made["labels"] = self.labelling.settings
        return identity(self.family) | made

    @cached_property
    def labelling(self) -> Labelling:
        """What computes the labels."""
        return Labelling(self.family, self.labels)

    def beside(self) -> dict[str, tuple[tuple[str, ...], tuple[int, ...]]]:
        """Return dimensions and lengths, after the variant, of float32 arrays beside sections."""
        graph: dict[str, tuple[tuple[str, ...], tuple[int, ...]]] = {}
        if self.graph:
            lengths = len(self.family.eta), len(self.family.blade.u), 3
            named = "span", "landmark", "xyz"
            graph = {name: (named[: n - 1], lengths[: n - 1]) for name, n in GRAPH.items()}
        return graph | self.labelling.arrays()

    @cached_property
    def block(self) -> int:
        """How many variants are whole at once: those of the folder's store, if it is there.

        Fewer where each takes a second, more in long families (`storage.layout`).
        """
        there = FamilyFolder(self.target).stored_block()
        return there or block_of(len(self.family), FEW if self.suffixes else BLOCK)

    def home(self, place: int) -> Path:
        """Return the folder of a variant's files."""
        return self.place.blades / home_of(place, len(self.suffixes))

    @cached_property
    def spans(self) -> Array:
        """The sections of the baseline's solid, for the variants' solids to begin with."""
        return fitted(self.family.blade, self.options.tolerance)[0].spans

    def blocks(self) -> list[int]:
        """Return the numbers of the blocks that are still to be made."""
        return self.place.open_blocks(len(self.family))
