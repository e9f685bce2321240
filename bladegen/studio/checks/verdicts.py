"""Checks of a variant's sections, each held against its limit before it is crossed.

"near" is said from `NEAR` of the way to a limit on, from `HOLLOW` more concavity than the
baseline's, and for noses beyond `NOSES` of its radius.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.blade.sanity import FIGURES, KINDS, NOTCH, RADIUS, ROUND, Oddities
from bladegen.blade.variants.batch import FAULTS, Batch
from bladegen.blade.variants.verdicts import THINNEST
from bladegen.shapes.domain import Domain
from bladegen.studio.checks.concavity import hollows
from bladegen.studio.scene import Check
from bladegen.support.arrays import Array, Mask

__all__ = ["Measured", "checks"]

NEAR = 0.8  # of the way to a limit
NOSES = 0.65, 1.6  # times the radius before; RADIUS are the limits
# deg more than the baseline's, on the suction and the pressure side: sound random variants (shape
# in the inner third of the data, three blades) have up to 3.0 and 7.8
HOLLOW = 3.0, 8.0
LEAST = 0.05  # deg, which is no concavity
JUDGED = 0.45  # of the chord: thicker sections are on the way to a circle
SIDES = "suction", "pressure"
GROWING = {"notch": "hollow nose", "camber": "camber", "tail": "tail"}  # `FIGURES` a change adds to


@dataclass(frozen=True, eq=False)
class Measured:
    """What is known of a variant's sections.

    Parameters
    ----------
    eta : (k,) array
        Span fractions.
    batch : Batch
        One variant.
    deviation : (k, n) array
        Off the baseline, along its normal [m].
    odd : Oddities
        Of the batch, (1, k).
    domain : Domain
        Where the space's data allow the sections to go.
    step : (k, r) array
        By how much their coordinates change.
    spread : (r,) array
        Standard deviations of the data.
    rest : (k, n, 3) array
        The baseline's sections [m].
    """

    eta: Array
    batch: Batch
    deviation: Array
    odd: Oddities
    domain: Domain
    step: Array
    spread: Array
    rest: Array

    def at(self, k: int | np.intp) -> str:
        """Say where a section stands."""
        return f"at {100 * self.eta[k]:.0f} % span"


def checks(found: Measured) -> tuple[Check, ...]:
    """Return all checks of a variant."""
    return (
        _valid(found),
        _thinnest(found),
        _in_data(found),
        _nose(found),
        _concavity(found),
        _airfoils(found),
        _off(found),
    )


def _valid(found: Measured) -> Check:
    faults, thickness = found.batch.faults[0], found.batch.relative_thickness[0]
    broken = np.flatnonzero(faults)
    if broken.size:
        word = f"{FAULTS[faults[broken[0]]]} {found.at(broken[0])}, {broken.size} in all"
        return Check("bad", "Valid", word)
    if thickness.min() < THINNEST:
        return Check("bad", "Valid", "too thin")
    return Check("good", "Valid", "sound all along")


def _thinnest(found: Measured) -> Check:
    thickness = found.batch.relative_thickness[0]
    thin = int(np.argmin(thickness))
    status = "good" if thickness[thin] >= THINNEST else "bad"
    figure = f"{100 * thickness[thin]:.1f} % of the chord {found.at(thin)}"
    return Check(status, "Thinnest", figure)


def _in_data(found: Measured) -> Check:
    """How far shapes lie from the data's mean, and how much of the way to its range is gone."""
    domain, step = found.domain, found.step
    judged: Mask = np.isfinite(domain.high[:, 0])
    arrived = np.where(judged[:, None], (domain.own + step) / found.spread, 0.0)
    far = np.linalg.norm(arrived, axis=1)
    room = np.where(step > 0.0, domain.high - domain.own, domain.own - domain.low)
    share = np.divide(np.abs(step), room, out=np.zeros_like(step), where=room > 0.0).max(axis=1)
    left = np.flatnonzero(domain.left(step))
    if left.size:
        return Check("odd", "Shape in data", f"beyond the data {found.at(left[0])}")
    worst = int(np.argmax(share)) if share.max() > NEAR else int(np.argmax(far))
    if share.max() > NEAR:
        word = f"{far[worst]:.1f} \u03c3, near its range's end {found.at(worst)}"
        return Check("near", "Shape in data", word)
    return Check("good", "Shape in data", f"{far[worst]:.1f} \u03c3 {found.at(worst)}")


def _nose(found: Measured) -> Check:
    share = found.odd.figures[0, :, FIGURES.index("radius")]
    thickness = found.batch.relative_thickness[0]
    share = np.where((thickness <= ROUND) & (share > 0.0), share, 1.0)
    worst = int(np.argmax(np.abs(np.log(share))))
    radius = share[worst]
    status = "good" if NOSES[0] <= radius <= NOSES[1] else "near"
    if not RADIUS[0] <= radius <= RADIUS[1]:
        status = "odd"
    return Check(status, "Nose radius", f"{radius:.2f} \u00d7 baseline's {found.at(worst)}")


def _concavity(found: Measured) -> Check:
    """What sides turn back more than the baseline's."""
    sections = found.batch.sections[0]
    more = np.degrees(hollows(sections) - hollows(found.rest))
    more[found.batch.relative_thickness[0] > JUDGED] = 0.0
    worst, side = np.unravel_index(np.argmax(more / HOLLOW), more.shape)
    figure = more[worst, side]
    if figure < LEAST:
        return Check("good", "Concavity", "none more than before")
    status = "near" if figure > HOLLOW[side] else "good"
    word = f"+{figure:.1f}\u00b0 {SIDES[side]} side {found.at(worst)}"
    return Check(status, "Concavity", word)


def _airfoils(found: Measured) -> Check:
    odd = found.odd
    strange = np.flatnonzero(odd.kinds[0])
    if strange.size:
        return Check("odd", "Airfoils", f"{KINDS[odd.kinds[0, strange[0]]]} {found.at(strange[0])}")
    judged = found.batch.relative_thickness[0] <= ROUND
    # a nose may turn back by `NOTCH` more than before; the others' limits are such changes
    allowed = np.where(np.array(FIGURES) == "notch", np.degrees(NOTCH), odd.limits[0])
    way = 1.0 - (odd.limits[0] - odd.figures[0]) / allowed
    share = way[:, [FIGURES.index(name) for name in GROWING]] * judged[:, None]
    worst, which = np.unravel_index(np.argmax(share), share.shape)
    if share[worst, which] > NEAR:
        name = list(GROWING.values())[which]
        return Check("near", "Airfoils", f"{name} near limit {found.at(worst)}")
    return Check("good", "Airfoils", "no odd section")


def _off(found: Measured) -> Check:
    off = found.deviation
    k, j = np.unravel_index(np.argmax(np.abs(off)), off.shape)
    far = abs(off[k, j]) >= 5e-4
    return Check(
        "good", "Off baseline", f"{1e3 * off[k, j]:+.0f} mm {found.at(k)}" if far else "0 mm"
    )
