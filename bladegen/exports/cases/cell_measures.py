"""How good a plane O-grid is, measured as flow solvers do: angles, aspect, heights, growth."""

from typing import Any

import numpy as np

from bladegen.exports.cases.marching import crossed
from bladegen.support.arrays import Array

__all__ = ["figures", "non_orthogonality"]


def figures(layers: Array) -> dict[str, Any]:
    """Return measures of layers (m, n, 2), the wall first; lengths in their unit.

    Cells; first heights; the largest growth between neighbours outward and around; aspect of the
    cells on the wall; the smallest scaled Jacobian and the largest angle of `non_orthogonality`.
    """
    around = np.linalg.norm(np.roll(layers, -1, axis=1) - layers, axis=2)
    outward = np.linalg.norm(np.diff(layers, axis=0), axis=2)
    corners = crossed(layers[:-1], layers[1:])
    after = np.roll(outward, -1, axis=1)
    lengths = np.stack(
        [
            around[:-1] * outward,
            around[:-1] * after,
            around[1:] * after,
            around[1:] * outward,
        ]
    )
    beside, stacked = np.roll(around[0], -1) / around[0], outward[1:] / outward[:-1]
    return {
        "cells": int(outward.size),
        "around": int(layers.shape[1]),
        "layers": len(layers) - 1,
        "first_height": [float(outward[0].min()), float(outward[0].max())],
        "growth_outward": float(np.maximum(stacked, 1.0 / stacked).max()),
        "growth_around": float(np.maximum(beside, 1.0 / beside).max()),
        "aspect": float((around[0] / outward[0]).max()),
        "scaled_jacobian": float((corners / lengths).min()),
        "non_orthogonality_deg": float(np.degrees(non_orthogonality(layers).max())),
    }


def non_orthogonality(layers: Array) -> Array:
    """Return the angles [rad] between faces' normals and the lines that join cells' centres.

    As OpenFOAM's checkMesh has them: those of faces between neighbours around, then outward.
    """
    corners = layers + np.roll(layers, -1, axis=1)
    centres = 0.25 * (corners[:-1] + corners[1:])
    beside = centres - np.roll(centres, 1, axis=1)
    above = np.diff(centres, axis=0)
    rising = np.diff(layers, axis=0)
    along = (np.roll(layers, -1, axis=1) - layers)[1:-1]
    return np.concatenate([_off_normal(beside, rising), _off_normal(above, along)])


def _off_normal(joining: Array, face: Array) -> Array:
    """Return the angles between vectors and the normals of faces, (..., 2) each."""
    along = np.abs(np.sum(joining * face, axis=-1))
    across = np.abs(joining[..., 0] * face[..., 1] - joining[..., 1] * face[..., 0])
    angle: Array = np.arctan2(along, across)
    return angle
