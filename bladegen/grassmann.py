"""The Grassmannian Gr(n, p), by its public name: see `bladegen.shapes.grassmann`."""

from bladegen.shapes.grassmann import (
    align,
    distance,
    exp,
    exp_factors,
    karcher_mean,
    log,
    log_factors,
    norm,
    transport,
)

__all__ = [
    "align",
    "distance",
    "exp",
    "exp_factors",
    "karcher_mean",
    "log",
    "log_factors",
    "norm",
    "transport",
]
