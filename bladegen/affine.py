"""Landmark-affine standardisation, by its public name: see `bladegen.shapes.affine`."""

from bladegen.shapes.affine import (
    camber,
    chord,
    cluster,
    from_polar,
    polar,
    restore,
    standardise,
    thickness,
    twist,
)

__all__ = [
    "camber",
    "chord",
    "cluster",
    "from_polar",
    "polar",
    "restore",
    "standardise",
    "thickness",
    "twist",
]
