"""The sections of a loft at some spans, on their splines, and what is made of them once.

All variants of a blade begin with these: a loft remembers those of the spans that it was asked for
last (`Loft.sections`), with all that was measured of them.
"""

from dataclasses import dataclass
from functools import cached_property

from bladegen.airfoils.chord_lines import ChordLines
from bladegen.airfoils.section_curves import SectionCurves
from bladegen.blade.lofting.before import Before
from bladegen.blade.lofting.carried import Carried
from bladegen.blade.lofting.edge_widths import Wedges
from bladegen.shapes import affine
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arrays import Array

__all__ = ["JoinedSections"]


@dataclass(frozen=True, eq=False)
class JoinedSections:
    """Sections of a path at k spans, their trailing edges brought to width.

    Parameters
    ----------
    curves : SectionCurves
        Not brought to size.
    ruling : (k,) array, optional
        The relative thickness that rules there, if one does.
    wedges : Wedges, optional
        What has brought their edges to width.
    """

    curves: SectionCurves
    ruling: Array | None
    wedges: Wedges | None

    @classmethod
    def of(
        cls, path: SectionCurves, ruling: Array | None, wedges: Wedges | None
    ) -> "JoinedSections":
        """Return those of a path's sections, before their edges are brought to width."""
        if wedges is None:
            return cls(path, ruling, None)
        return cls(path.reshaped(*wedges.opened(path.points)), ruling, wedges)

    @cached_property
    def thickness(self) -> Array:
        """The relative thickness that they have or shall have, (k,)."""
        return self.curves.relative_thickness if self.ruling is None else self.ruling

    @cached_property
    def before(self) -> Before:
        """These, as perturbed sections are held against them."""
        return Before(self.curves, self.thickness)

    @cached_property
    def _sized(self) -> tuple[Array, Array, ChordLines]:
        return ChordLines.sized(self.curves, self.ruling)

    def sized(self, thickness: Array | None) -> tuple[Array, Array, ChordLines]:
        """Return the maps that bring them to relative thickness (k,), and their chord lines."""
        if thickness is self.ruling:
            return self._sized
        return ChordLines.sized(self.curves, thickness)

    @cached_property
    def standardised(self) -> tuple[Array, Array, Array]:
        """Their shapes (k, n, 2), and the maps M and b."""
        return affine.standardise(self.curves.points)

    def carried(self, space: ShapeSpace) -> Carried:
        """Return the modes of a space carried to the shapes; the last space's are remembered."""
        known = vars(self).get("_carried")
        if known is None or known.space is not space:
            known = Carried.to(space, self.standardised[0])
            vars(self)["_carried"] = known
        return known
