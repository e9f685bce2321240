"""What of webs and layers does not fit on a blade's sections: findings with place and span."""

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from bladegen.blade.layup.laid import Laid
from bladegen.blade.layup.outlines import within
from bladegen.definition.structure.positions import Limited, Position, Shifted, base_of
from bladegen.definition.structure.structure import Layer, Stated, Structure
from bladegen.errors import Finding
from bladegen.support.arrays import Array, Mask

__all__ = ["doubts", "run_ins"]

THIN = 1e-6  # m; published layers run out to as much, and are not there
NEAR = 1e-3  # of the arc, by which places may miss each other
FAR = 0.02  # of the arc; tools that take the nearest of 200 points are off by half a hundredth
LEANING = 1.1  # of the section's thickness, up to which a web may be high


def doubts(structure: Structure, laid: Laid, depth: Array) -> tuple[Finding, ...]:
    """Return what does not fit.

    Parameters
    ----------
    structure : Structure
    laid : Laid
        Its layers at span fractions (k,), increasing.
    depth : (k,) array
        Thickness of the sections [m].
    """
    return tuple(
        found
        for part in (_placeless, _behind, _beyond, _leaning, _overlapping, _stated)
        for found in part(structure, laid, depth)
    )


def run_ins(structure: Structure, laid: Laid) -> tuple[Finding, ...]:
    """Return where tables of thickness run out to 0 beyond the end of a part: one finding for all.

    A table whose points lie apart has a ramp from the last thickness to the first 0; what of it
    lies beyond the part is not counted, and nobody meant it.
    """
    names = [name for name, (lost, ramp) in _lost(structure, laid).items() if (lost & ramp).any()]
    if not names:
        return ()
    said = "their thickness runs out to 0 at the next point of its table, beyond their ends"
    return (Finding(f"structure: {', '.join(names)}", f"{said}; nothing is counted there"),)


def _placeless(structure: Structure, laid: Laid, _: Array) -> Iterator[Finding]:
    for name, (lost, ramp) in _lost(structure, laid).items():
        if (lost & ~ramp).any():
            said = "has a thickness where it has no place; not counted there"
            yield _finding(name, said, lost, laid)


def _lost(structure: Structure, laid: Laid) -> dict[str, tuple[Mask, Mask]]:
    """Return where parts have a thickness and no place (k,), and where tables only run out."""
    found: dict[str, tuple[Mask, Mask]] = {}
    for layer, arcs in zip(structure.layers, laid.arcs, strict=True):
        wanted = np.nan_to_num(within(layer.thickness, laid.eta)) > THIN
        inside = (laid.eta >= layer.extent[0]) & (laid.eta <= layer.extent[1])
        nowhere = np.isnan(arcs).any(axis=-1)
        lost, name = wanted & inside & nowhere, layer.web or layer.name
        grid, thick = layer.thickness.grid, layer.thickness.values > THIN
        behind = np.clip(np.searchsorted(grid, laid.eta), 1, len(grid) - 1)
        first, last = thick[behind - 1], thick[behind]
        end = np.where(first, grid[behind - 1], grid[behind])  # the thick one of the two points
        held = np.interp(end, laid.eta, nowhere.astype(float)) < 1.0
        before = found.get(name, (np.zeros(len(lost), bool), np.ones(len(lost), bool)))
        found[name] = before[0] | lost, before[1] & (~lost | ((first != last) & held))
    return found


def _behind(structure: Structure, laid: Laid, _: Array) -> Iterator[Finding]:
    for layer, i in _on_skin(structure):
        behind = (laid.arcs[i, :, 0] - laid.arcs[i, :, 1] > NEAR) & (laid.thickness[i] > THIN)
        if behind.any():
            by = float(np.max((laid.arcs[i, :, 0] - laid.arcs[i, :, 1])[behind]))
            said = f"starts behind its end, by up to {by:.3f} of the arc; it has no width"
            yield _finding(layer.name, said, behind, laid)


def _beyond(structure: Structure, laid: Laid, _: Array) -> Iterator[Finding]:
    for layer, i in _on_skin(structure):
        low = np.zeros(1) if layer.around else -laid.arcs[i, :, 0]
        over = np.maximum(low, laid.arcs[i, :, 1] - 1.0)
        beyond = (over > NEAR) & (laid.thickness[i] > THIN)
        if beyond.any():
            said = (
                f"reaches {over[beyond].max():.3f} of the arc beyond the trailing edge; cut there"
            )
            yield _finding(layer.name, said, beyond, laid)


def _leaning(structure: Structure, laid: Laid, depth: Array) -> Iterator[Finding]:
    for web, height in zip(structure.webs, laid.web_height, strict=True):
        over = height / depth
        if (over > LEANING).any():
            most = int(np.argmax(over))
            said = (
                f"is higher than the section is thick, {height[most]:.3g} m of {depth[most]:.3g} m "
                f"at eta = {laid.eta[most]:.3f}: it leans"
            )
            yield _finding(web.name, said, over > LEANING, laid)


def _overlapping(structure: Structure, laid: Laid, _: Array) -> Iterator[Finding]:
    """Compare strips that stand about places of their own: caps and edges' reinforcements."""
    strips = [(one, i) for one, i in _on_skin(structure) if _strip(one)]
    told: list[tuple[Position, Position]] = []
    for (one, i), (other, j) in combinations(strips, 2):
        bases = base_of(one.start), base_of(other.start)
        if bases[0] == bases[1] or bases in told:
            continue
        first, second = laid.arcs[i], laid.arcs[j]
        common = _common(first, second)
        if one.around or other.around:  # their arcs begin below 0, or go on to 1
            turn = 1.0 if one.around else -1.0
            common = np.fmax(common, _common(first + turn, second))
        thick = (laid.thickness[i] > THIN) & (laid.thickness[j] > THIN)
        over = thick & (common > NEAR)
        if over.any():
            told.append(bases)
            said = f"overlaps {other.name}, by up to {common[over].max():.3f} of the arc"
            yield _finding(one.name, said, over, laid)


def _common(first: Array, second: Array) -> Array:
    """Return what two strips (k, 2) have in common (k,), below 0 where they are apart."""
    with np.errstate(invalid="ignore"):
        found: Array = np.minimum(first[:, 1], second[:, 1]) - np.maximum(first[:, 0], second[:, 0])
    return found


def _stated(structure: Structure, laid: Laid, _: Array) -> Iterator[Finding]:
    """Compare the rules with the fractions that the file states besides: one finding for all.

    Some tools count them from corner to corner, some from the middle of the trailing edge on, as
    windIO 2 defines them; a file is taken by what fits it.
    """
    parts = [
        (one.name, one.stated, laid.arcs[i] + (float(one.around), 0.0), laid.thickness[i] > THIN)
        for one, i in _on_skin(structure)
    ]
    for i, web in enumerate(structure.webs):
        used = [k for k, layer in enumerate(structure.layers) if layer.web == web.name]
        thick = (laid.thickness[used] > THIN).any(axis=0)
        parts.append((web.name, web.stated, laid.web_arcs[i], thick))
    ways = [
        [
            (
                _off(one, (np.clip(arcs, 0.0, 1.0) + half) / (1.0 + 2.0 * half), laid.eta, there),
                name,
            )
            for name, one, arcs, there in parts
        ]
        for half in (np.zeros(1), laid.half_edge[:, None])
    ]
    off = min(ways, key=lambda way: sum(float(far.max()) for far, _ in way))
    wide = [(float(far.max()), float(laid.eta[int(np.argmax(far))]), name) for far, name in off]
    apart = sorted(one for one in wide if one[0] > FAR)
    if apart:
        most, eta, name = apart[-1]
        yield Finding(
            "structure",
            f"{len(apart)} of {len(wide)} webs and layers lie up to {most:.3f} of the arc from the "
            f"fractions that the file states besides their rules ({name} at eta = {eta:.3f}); "
            "the rules hold",
        )


def _off(stated: Stated, arcs: Array, eta: Array, there: Mask) -> Array:
    """Return how far stated fractions are from those of the rules (k,), 0 where none are.

    They are held against each other at the points of their own grid, not between.
    """
    far = np.zeros(len(eta))
    for end, given in enumerate(stated):
        if given is not None:
            apart = np.abs(within(given, eta) - arcs[:, end])
            held = there & np.isin(eta, given.grid)
            far = np.maximum(far, np.where(held, np.nan_to_num(apart), 0.0))
    return far


def _on_skin(structure: Structure) -> Iterator[tuple[Layer, int]]:
    yield from ((layer, i) for i, layer in enumerate(structure.layers) if not layer.web)


def _strip(layer: Layer) -> bool:
    """Tell whether both ends of a layer rest on one place, by a width."""
    wide = any(isinstance(end, Shifted | Limited) for end in (layer.start, layer.end))
    return wide and (layer.around or base_of(layer.start) == base_of(layer.end))


def _finding(name: str, said: str, where: Mask, laid: Laid) -> Finding:
    runs = np.split(laid.eta[where], np.flatnonzero(np.diff(np.flatnonzero(where)) > 1) + 1)
    spans = ", ".join(
        f"{run[0]:.3f}" + (f" to {run[-1]:.3f}" if len(run) > 1 else "") for run in runs
    )
    return Finding(f"structure: {name}", f"{said} (eta = {spans})")
