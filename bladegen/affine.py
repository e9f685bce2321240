"""Landmark-affine standardisation, by its public name: see `bladegen.shapes.affine`."""

from bladegen.shapes.affine import *  # noqa: F403
