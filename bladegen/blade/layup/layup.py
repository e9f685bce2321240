"""Webs and layers on the sections of a blade, and what they weigh.

A layer weighs its length along the outline times its thickness times its density: that it is
shorter inside of a thick skin is not taken off (2 % where 0.1 m of laminate goes round 5.2 m).  A
layer that reaches the trailing edge covers its half of it, too, from the corner to the middle.  A
web's layers lie on the plane between its two places on the skin.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.layup.fit import doubts, run_ins
from bladegen.blade.layup.laid import Laid
from bladegen.blade.layup.outlines import Outlines, within
from bladegen.blade.spans import MIRROR, span_fractions
from bladegen.definition.distribution import united
from bladegen.definition.structure.positions import knots
from bladegen.definition.structure.structure import Layer, Structure, Web
from bladegen.errors import Finding
from bladegen.support.arrays import Array, ArrayLike, Mask
from bladegen.support.values import state_of

__all__ = ["Layup", "covers_edge", "layup"]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(2)
APART = 1e-4  # of the span, between the knots of an integral over it
REACHED = 1e-6  # of the arc, by which a layer may miss the trailing edge that it reaches
ONE = np.ones(1)
LOOKED_AT = 201  # spans at which layers are looked at for what does not fit


@dataclass(frozen=True, eq=False, repr=False)
class Layup:
    """What lies inside the skin of a blade, as a function of span.

    Parameters
    ----------
    blade : Blade
        The blade; a variant has a layup of its own, on its own sections.
    structure : Structure
        Its materials, webs and layers.
    """

    blade: Blade
    structure: Structure

    __getstate__ = state_of

    def __repr__(self) -> str:
        return f"<Layup of {self.blade.name}: {self.structure!r}>"

    def at(self, eta: ArrayLike) -> Laid:
        """Return layers and webs at span fractions (...)."""
        spans = span_fractions(eta)
        if self.blade.mirrored:
            own = Layup(self.blade.mirror_image(), self.structure).at(spans)
            return Laid(**vars(own) | {"layer_centre": own.layer_centre * MIRROR})
        flat = self._laid(spans.reshape(-1))
        return Laid(
            **{
                name: part.reshape((*part.shape[:lead], *spans.shape, *part.shape[lead + 1 :]))
                for name, part in vars(flat).items()
                for lead in [0 if name in ("eta", "half_edge") else 1]
            }
        )

    def _laid(self, eta: Array) -> Laid:
        outlines, known = Outlines.of(self.blade, eta), dict[int, Array]()
        layers, webs = self.structure.layers, self.structure.webs

        def stacked(parts: list[Array], *last: int) -> Array:
            return np.array(parts).reshape(-1, len(eta), *last)

        def ends(one: Web | Layer) -> Array:
            inside = (eta >= one.extent[0]) & (eta <= one.extent[1])
            places = [outlines.places(end, known) for end in (one.start, one.end)]
            return np.where(inside[:, None], np.stack(places, axis=-1), np.nan)

        web_arcs, own = (stacked([ends(one) for one in kind], 2) for kind in (webs, layers))
        order = {web.name: i for i, web in enumerate(webs)}
        wall = np.array([order.get(layer.web, -1) for layer in layers], dtype=np.intp)
        up = wall >= 0
        wrapped = np.array([layer.around for layer in layers], dtype=bool)
        own[wrapped, :, 0] -= 1.0
        arcs = own.copy()
        arcs[up] = web_arcs[wall[up]]
        there = ~(np.isnan(own) | np.isnan(arcs)).any(axis=-1)
        safe = np.clip(np.nan_to_num(own), 0.0, 1.0)
        width, moment = outlines.moments(safe[..., 0], safe[..., 1])
        for i in np.flatnonzero(wrapped):
            behind = outlines.moments(1.0 + np.clip(np.nan_to_num(own[i, :, 0]), -1.0, 0.0), ONE)
            width[i], moment[i] = width[i] + behind[0], moment[i] + behind[1]
        edge = covers_edge(own, wrapped[:, None]) & (there & ~up[:, None])[..., None]
        width += edge.sum(axis=-1) * outlines.half_edge
        moment += np.einsum("lkh,k,hki->lki", edge, outlines.half_edge, outlines.edge_middles)
        feet = [outlines.at(np.clip(np.nan_to_num(web_arcs[..., i]), 0.0, 1.0)) for i in (0, 1)]
        height = np.linalg.norm(feet[1] - feet[0], axis=-1)
        height = np.where(np.isnan(web_arcs).any(axis=-1), 0.0, height)
        share = np.maximum(safe[up, :, 1] - safe[up, :, 0], 0.0)
        width[up] = height[wall[up]] * share
        middle = 0.5 * (safe[up, :, 0] + safe[up, :, 1])[..., None]
        between = feet[0][wall[up]] * (1.0 - middle) + feet[1][wall[up]] * middle
        moment[up] = between * width[up][..., None]
        thickness = np.nan_to_num(stacked([within(layer.thickness, eta) for layer in layers]))
        thickness = np.where(there, thickness, 0.0)
        width = np.where(there, width, 0.0)
        density = np.array([self.structure.by_name[layer.material].density for layer in layers])
        with np.errstate(invalid="ignore", divide="ignore"):
            centre = np.where(width[..., None] > 0.0, moment / width[..., None], np.nan)
        angle = [np.zeros(len(eta)) if one.angle is None else one.angle(eta) for one in layers]
        return Laid(
            eta,
            arcs,
            edge,
            outlines.half_edge / outlines.length,
            thickness,
            width,
            stacked(angle),
            web_arcs,
            height,
            density.reshape(-1, 1) * thickness * width,
            centre,
        )

    @cached_property
    def _weighed(self) -> tuple[Array, Array]:
        """Return masses (layers,) [kg] and their first moments (layers, 3) [kg m]."""
        structure, definition = self.structure, self.blade.definition
        grids: list[ArrayLike] = [layer.thickness.grid for layer in structure.layers]
        placed: tuple[Web | Layer, ...] = (*structure.webs, *structure.layers)
        for one in placed:
            grids += [one.extent, knots(one.start), knots(one.end)]
        grids += [definition.chord.grid, definition.twist.grid, self.blade.eta, [0.0, 1.0]]
        knotted = united(*grids, apart=APART)
        half = 0.5 * np.diff(knotted)
        eta = ((knotted[:-1] + half)[:, None] + half[:, None] * _NODES).reshape(-1)
        step = (half[:, None] * _WEIGHTS).reshape(-1)
        laid = self.at(eta)
        weight = laid.layer_mass * step * np.linalg.norm(definition.axis(eta, 1), axis=-1)
        moments = (np.nan_to_num(laid.layer_centre) * weight[..., None]).sum(axis=1)
        return weight.sum(axis=1), moments

    @property
    def layer_masses(self) -> dict[str, float]:
        """Mass [kg] of each layer by its name."""
        names = [layer.name for layer in self.structure.layers]
        return dict(zip(names, self._weighed[0].tolist(), strict=True))

    @property
    def material_masses(self) -> dict[str, float]:
        """Mass [kg] of each material that is in a layer, by its name."""
        used = {layer.material for layer in self.structure.layers}
        found = {name: 0.0 for name in self.structure.by_name if name in used}
        for layer, mass in zip(self.structure.layers, self._weighed[0].tolist(), strict=True):
            found[layer.material] += mass
        return found

    @property
    def mass(self) -> float:
        """Mass [kg] of all layers."""
        return float(self._weighed[0].sum())

    @property
    def centre(self) -> Array:
        """Centre of mass (3,) of all layers [m], blade frame."""
        found: Array = self._weighed[1].sum(axis=0) / self.mass
        return found

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What does not fit on this blade's sections, and where."""
        return self._looked_at[0]

    @property
    def remarks(self) -> tuple[Finding, ...]:
        """What is worth a word where a file is shown, and nothing that is lost: see `run_ins`."""
        return self._looked_at[1]

    @cached_property
    def _looked_at(self) -> tuple[tuple[Finding, ...], tuple[Finding, ...]]:
        blade = self.blade.mirror_image() if self.blade.mirrored else self.blade
        placed: tuple[Web | Layer, ...] = (*self.structure.webs, *self.structure.layers)
        stated = [given.grid for one in placed for given in one.stated if given is not None]
        eta = united(np.linspace(0.0, 1.0, LOOKED_AT), *stated, apart=0.0)
        depth = blade.relative_thickness(eta) * blade.chord(eta)
        laid = self.at(eta)
        return doubts(self.structure, laid, depth), run_ins(self.structure, laid)


def covers_edge(arcs: Array, wrapped: Mask) -> Mask:
    """Return which halves of the trailing edge (..., 2) layers cover.

    Parameters
    ----------
    arcs : (..., 2) array
        Fractions of the arc where they start and end, of those around the edge from below 0.
    wrapped : (...) array of bool
        Whether they lie around it.
    """
    with np.errstate(invalid="ignore"):
        wide = arcs[..., 1] - arcs[..., 0] > REACHED
        reached = np.stack([arcs[..., 0] <= REACHED, arcs[..., 1] >= 1.0 - REACHED], axis=-1)
    found: Mask = wide[..., None] & (reached | wrapped[..., None])
    return found


def layup(blade: Blade) -> Layup | None:
    """Return what lies inside the skin of a blade, None if its definition has none of it."""
    structure = blade.definition.structure
    return None if structure is None else Layup(blade, structure)
