"""Cells at trailing edge and tip, as large as those on the other side of the blocks' edges.

Everything follows from how thick the blade's trailing edge is.  Where it is blunt, the sides'
first cells are as high as those across it, at all spans: as landmark parameters do not change
over span, the place with the thinnest edge for its chord decides.  A flat tip's cells, on the
sides and on the tip, are then as high as those of the sides at the trailing edge; a round tip's
and those of a blade with a sharp edge are as high as its cells from side to side can be at the
trailing edge, where they are smallest.
"""

from dataclasses import replace

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.support.arrays import Array
from bladegen.surface.grids.blocks import is_blunt
from bladegen.surface.grids.caps import divisions
from bladegen.surface.grids.edges import first_cells
from bladegen.surface.grids.measuring import away
from bladegen.surface.grids.spacing import Spacing
from bladegen.surface.grids.stretching import LARGEST, partial_sums
from bladegen.surface.tips import Tip, flat_tip

__all__ = ["coupled"]

SPANS = 51
NEAR = 0.02  # of the span: around the place found, spans are closer in the next round
SHARP = 3e-3  # a sharp edge's first cell, of its section's side
STEP = 1e-4  # of the span: the sides' direction at the tip
RING = 0.35  # of half the edge: how deep the ring under a round tip's arc is, about
ROUNDS = 4  # the first cell's length is not quite in proportion to its landmark parameter
ARC = 0.5 * np.pi  # times as long as the edge is thick
FEW = 1.6  # growth to the middle beyond which cells are larger than those beside them are
ROUND = 0.55  # times the mean: cells on the arc over a blunt edge, under which lie shorter ones
EVEN = 1.2  # times the mean: cells at a sharp edge that shrink a little inward


def coupled(spacing: Spacing, blade: Blade, tip: Tip) -> Spacing:
    """Return a spacing whose sizes at trailing edge and tip are chosen, where they are None."""
    if spacing.trailing_edge is None:
        eta, share = np.linspace(0.0, 1.0, SPANS), SHARP
        for _ in range(ROUNDS):
            share = min(max(share, spacing.least[0]), LARGEST / (spacing.around // 2))
            sections = blade.sections(eta, replace(spacing, trailing_edge=share).parameters())
            if not is_blunt(blade.name, sections):
                break
            gap = np.linalg.norm(sections[:, 0] - sections[:, -1], axis=-1)
            fits = LARGEST * gap / spacing.edge / np.maximum(*first_cells(sections))
            fit = float(fits.min())
            grown = float(partial_sums(spacing.edge // 2, np.array(FEW))[-1])
            fit = max(fit, float(np.max(0.5 * gap / grown / np.minimum(*first_cells(sections)))))
            if tip is not flat_tip:
                ring = RING * float(gap[-1]) / (2 * divisions(spacing.edge, flat=False)[0])
                fit = min(fit, LARGEST * ring / _chordwise(sections[-1]))
            share *= fit
            thin = eta[np.argmin(fits)]
            eta = np.union1d(eta, np.clip(np.linspace(thin - NEAR, thin + NEAR, SPANS), 0.0, 1.0))
        share = max(share, spacing.least[0])
        spacing = replace(spacing, trailing_edge=min(share, LARGEST / (spacing.around // 2)))
    if spacing.tip is None:
        length = np.linalg.norm(np.diff(blade.axis(np.linspace(0.0, 1.0, 2001)), axis=0), axis=-1)
        share = _tip_cell(spacing, blade, tip) / float(length.sum())
        share = min(max(share, spacing.least[1]), LARGEST / (spacing.along - 1))
        spacing = replace(spacing, tip=share)
    return spacing


def _chordwise(outline: Array) -> float:
    """Return the length of the larger of the cells beside the trailing edge."""
    return float(max(np.linalg.norm(outline[a] - outline[b]) for a, b in ((0, 1), (-1, -2))))


def _tip_cell(spacing: Spacing, blade: Blade, tip: Tip) -> float:
    """Return the length along the axis of the last cells."""
    u, eta = spacing.parameters(), np.array([1.0 - STEP, 1.0])
    sections = blade.sections(eta, u)
    span = float(np.linalg.norm(np.diff(blade.axis(eta), axis=0)))
    outline, step = sections[1], sections[1] - sections[0]
    heights = away(step, outline) / span  # of cells, for their length along the axis
    long = np.linalg.norm(step, axis=-1) / span  # arcs leave that way
    if not is_blunt(blade.name, sections):
        at = [1, -2]  # the first points beside the edge
        gap = float(np.linalg.norm(outline[1] - outline[-2]))
        wanted = EVEN * gap / spacing.edge
    else:
        at = [0, -1]
        gap = float(np.linalg.norm(outline[0] - outline[-1]))
        flat = float(np.mean([cells[1] for cells in first_cells(sections)]))
        wanted = flat if tip is flat_tip else ROUND * gap / spacing.edge
    thick = float(np.linalg.norm(outline - outline[::-1], axis=-1).max())
    least = 0.5 * thick / float(partial_sums(spacing.edge // 2, np.array(FEW))[-1])
    if tip is flat_tip:
        return max(least, wanted) / float(heights[at].mean())
    return ARC * max(least, wanted) / float(long[at].mean())
