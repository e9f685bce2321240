"""Measured sections to a definition: airfoils at as few stations as hold a tolerance.

Chord, twist, offset, prebend and relative thickness keep all that was measured; airfoils are kept
at the ends, at the end of a round root, and wherever a blade of those kept misses a measured
section by more than allowed.
"""

from collections.abc import Callable

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.edges import AsGiven
from bladegen.definition.blade_definition import Airfoil, BladeDefinition, Distribution, Station
from bladegen.errors import GeometryError
from bladegen.fitting.measuring import Sections, axis_of
from bladegen.support.arrays import Array, Indices

__all__ = ["definition_of", "fewest", "missed"]

ROUNDS = 12
FIRST = (0.15, 0.3, 0.5, 0.7, 0.9)  # of the span between the round root and the tip
DIGITS = 7  # of airfoil coordinates: a hundredth of a millimetre of a chord of 100 m
OPEN = 2e-5  # of the chord: sides that cross by less at the edge are closed there


def definition_of(
    sections: Sections, rows: Indices, length: float, *, name: str, source: str = ""
) -> BladeDefinition:
    """Return the definition with airfoils at some of the sections."""
    eta = sections.eta
    airfoils = [
        Airfoil(
            f"{name} {100.0 * eta[k]:.2f} %",
            np.round(sections.airfoils[k], DIGITS),
            float(sections.thickness[k]),
        )
        for k in rows.tolist()
    ]
    return BladeDefinition(
        name=name,
        stations=tuple(
            Station(float(eta[k]), one) for k, one in zip(rows.tolist(), airfoils, strict=True)
        ),
        chord=Distribution(eta, sections.chord),
        twist=Distribution(eta, sections.twist),
        axis=axis_of(eta, sections.prebend, length),
        section_offset_y=Distribution(eta, sections.offset),
        section_offset_x=None if sections.rise is None else Distribution(eta, sections.rise),
        relative_thickness=Distribution(eta, sections.thickness),
        description="fitted to a surface by bladegen fit",
        source=source,
        format="fit",
    )


def missed(definition: BladeDefinition, sections: Sections) -> Array:
    """Return by how much the sections of a definition's blade miss measured ones, (k,) [m].

    Normal to the measured ones, at landmarks.
    """
    blade = Blade.from_definition(
        definition, landmarks=sections.airfoils.shape[1], trailing_edge=AsGiven()
    )
    away = blade.profiles(sections.eta) - sections.airfoils
    along = np.gradient(sections.airfoils, axis=1)
    normal = along[..., ::-1] * [1.0, -1.0]
    normal /= np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-300)
    off = np.abs(np.sum(away * normal, axis=-1)).max(axis=1)
    result: Array = off * sections.chord
    return result


def fewest(
    sections: Sections,
    length: float,
    tolerance: float,
    *,
    name: str,
    progress: Callable[[str], None] = lambda _: None,
) -> Indices:
    """Return at which sections airfoils are kept, so that all are met within a tolerance [m]."""
    count = len(sections.eta)
    last_round = int(np.count_nonzero(sections.rounded)) - 1
    start = max(last_round, 0)
    wanted = sections.eta[start] + np.array(FIRST) * (1.0 - sections.eta[start])
    rows = {0, start, count - 1, *(int(np.argmin(np.abs(sections.eta - w))) for w in wanted)}
    for _ in range(ROUNDS):
        kept = np.array(sorted(rows))
        progress(f"choosing stations, {len(kept)} of {count} sections so far")
        try:
            off = missed(definition_of(sections, kept, length, name=name), sections)
        except GeometryError:
            off = np.where(np.isin(np.arange(count), kept), 0.0, np.inf)
        parts = np.split(np.arange(count), kept[1:-1])
        new = {int(part[np.argmax(off[part])]) for part in parts if off[part].max() > tolerance}
        new -= rows
        if not new:
            break
        rows |= new
    return np.array(sorted(rows))
