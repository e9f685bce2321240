"""Wide trailing edges as panels: strips from corner to corner that close at their ends.

Where the edge is wider than `WIDE` of the chord it is a panel; elsewhere it is closed to its
middle.  A strip has 2 n columns.  At an end that closes, its last row is bent and n by n elements
lie between that row and the corners, which run together over n rows: all are quadrilaterals, and
meet the skin side by side.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.support.arrays import Array, Indices

__all__ = ["WIDE", "Panel", "Sheet", "openness", "panels", "sheets"]

WIDE = 0.03  # of the chord: a flatback; edges of 36 % thick airfoils are glued, and narrower
FEW = 0.9  # quantile of the width that columns are made for
BEND = 0.4  # of a row, by which each of the last rows is bent more than the one before
SHORTEST = 2  # rows of a strip


@dataclass(frozen=True)
class Panel:
    """Rows `first` to `last` of a strip of 2 n columns, and whether its ends close over n rows."""

    first: int
    last: int
    n: int
    closes: tuple[bool, bool]

    @property
    def reach(self) -> tuple[int, int]:
        """The rows at which it begins and ends, closing parts among them."""
        before, behind = self.closes
        return self.first - self.n * before, self.last + self.n * behind


@dataclass(frozen=True, eq=False)
class Sheet:
    """Nodes of a panel or of an end of it.

    Parameters
    ----------
    numbers : (2 a + 1, 2 b + 1) array
        Of nodes.
    across : (2 a + 1, 2 b + 1) array
        Where they are: 1 at the pressure side's corner, -1 at the suction side's.
    rows : (2 a + 1, 2 b + 1) array
        Rows of nodes along the span, that of their corners.
    straight : bool
        Whether the sides of its elements are.
    """

    numbers: Indices
    across: Array
    rows: Array
    straight: bool = False

    def placed(self, corners: Array) -> Array:
        """Return the nodes (2 a + 1, 2 b + 1, 3) between corners (rows, 2, 3) [m]."""
        suction, pressure = (self._between(corners[:, side]) for side in (0, 1))
        share = 0.5 * (1.0 + self.across[..., None])
        found: Array = suction * (1.0 - share) + pressure * share
        if self.straight:
            found[1::2] = 0.5 * (found[:-1:2] + found[2::2])
            found[:, 1::2] = 0.5 * (found[:, :-1:2] + found[:, 2::2])
        return found

    def _between(self, line: Array) -> Array:
        """Return points (..., 3) of a line (rows, 3) at the nodes' rows."""
        at = np.arange(len(line))
        return np.stack([np.interp(self.rows, at, line[:, i]) for i in range(3)], axis=-1)


def panels(width: Array, chord: Array, size: float) -> list[Panel]:
    """Return the panels of a trailing edge of some widths (k,) at rows of elements."""
    wide = np.pad(width > WIDE * chord, 1).astype(np.intp)
    starts, ends = np.flatnonzero(np.diff(wide) > 0), np.flatnonzero(np.diff(wide) < 0) - 1
    found: list[Panel] = []
    for low, high in zip(starts.tolist(), ends.tolist(), strict=True):
        closes = low > 0, high < len(width) - 1
        columns = np.quantile(width[low : high + 1], FEW) / size
        for n in range(max(1, int(np.ceil(0.5 * columns))), 0, -1):
            first, last = low + (n - 1) * closes[0], high - (n - 1) * closes[1]
            if last - first >= SHORTEST:
                found.append(Panel(first, last, n, closes))
                break
    return found


def openness(made: list[Panel], width: Array) -> Array:
    """Return how far a trailing edge of widths (2 k - 1,) is open at k rows and between.

    It is 1 on a strip.  Where it closes the corners go straight from row to row.
    """
    found, at = np.zeros(len(width)), 0.5 * np.arange(len(width))
    for panel in made:
        low, high = panel.reach
        own = np.ones(len(at))
        if panel.closes[0]:
            own = np.minimum(own, (at - low) / panel.n)
        if panel.closes[1]:
            own = np.minimum(own, (high - at) / panel.n)
        found = np.maximum(found, np.where((at >= low) & (at <= high), own, 0.0))
    between = 0.5 * (width[:-1:2] * found[:-1:2] + width[2::2] * found[2::2])
    closing = (found[1::2] > 0.0) & (found[1::2] < 1.0)
    found[1::2][closing] = between[closing] / width[1::2][closing]
    return found


def sheets(panel: Panel, suction: Indices, pressure: Indices, count: int) -> list[Sheet]:
    """Return a panel's strip and its closing ends.

    Parameters
    ----------
    panel : Panel
    suction, pressure : (2 k - 1,) array
        Numbers of the nodes of both corners, at rows and between.
    count : int
        The first number for a new node.
    """
    n = panel.n
    rows = np.arange(2 * panel.first, 2 * panel.last + 1)
    across = 1.0 - np.arange(4 * n + 1) / (2 * n)
    bent = min(n, (panel.last - panel.first) // 2)
    ends = (2 * panel.first, 1.0), (2 * panel.last, -1.0)
    off = np.zeros(len(rows))
    for (end, inward), closes in zip(ends, panel.closes, strict=True):
        off += closes * inward * BEND * np.maximum(0.0, 2 * bent - np.abs(rows - end))
    away = rows[:, None] + off[:, None] * (1.0 - np.abs(across))
    inner = count + np.arange(len(rows) * (4 * n - 1)).reshape(len(rows), -1)
    strip = np.concatenate([pressure[rows, None], inner, suction[rows, None]], axis=1)
    made = [Sheet(strip, np.broadcast_to(across, strip.shape), away)]
    count += inner.size
    at = np.arange(2 * n + 1)
    share = at / (2 * n)
    for behind in (False, True):
        if not panel.closes[behind]:
            continue
        numbers = count + np.arange((2 * n + 1) ** 2).reshape(2 * n + 1, -1)
        count += numbers.size
        end, row = 2 * panel.reach[behind], -1 if behind else 0
        middle, corner = float(away[row, 2 * n]), float(rows[row])
        if behind:  # from the pressure side's corner to the end, and on to the suction side's
            numbers[:, 0], numbers[-1] = pressure[rows[-1] + at], suction[end - at]
            numbers[0], numbers[:, -1] = strip[-1, : 2 * n + 1], strip[-1, 2 * n :]
            four = (1.0, corner), (0.0, float(end)), (0.0, middle), (-1.0, corner)
        else:  # from the end to the pressure side's corner, and beside it to the suction side's
            numbers[:, 0], numbers[0] = pressure[end + at], suction[end + at]
            numbers[-1], numbers[:, -1] = strip[0, : 2 * n + 1], strip[0, 4 * n - at]
            four = (0.0, float(end)), (1.0, corner), (-1.0, corner), (0.0, middle)
        places = [
            np.outer(1.0 - share, 1.0 - share) * a
            + np.outer(share, 1.0 - share) * b
            + np.outer(1.0 - share, share) * c
            + np.outer(share, share) * d
            for a, b, c, d in zip(*four, strict=True)
        ]
        made.append(Sheet(numbers, places[0], places[1], straight=True))
    return made
