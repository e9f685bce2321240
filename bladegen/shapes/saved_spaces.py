"""What the arrays of a saved shape space must be, whatever a file claims (`pga`)."""

from collections.abc import Callable

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["FARTHEST", "NO_SPREAD", "ORTHONORMAL", "problem_of"]

ORTHONORMAL = 1e-8  # saved bases are orthonormal to rounding
NO_SPREAD = 1e-9  # rad; shapes that vary less along a mode do not vary along it
FARTHEST = np.pi / np.sqrt(2.0)  # rad, the distance at which both principal angles are 90 degrees


def problem_of(arrays: dict[str, Array]) -> str | None:
    """Say what keeps a file's arrays from being a space, or None."""
    for name, array in arrays.items():
        if array.dtype != np.float64 or not np.isfinite(array).all():
            return f"{name} must be finite numbers in double precision"
    sizes = {name: len(array) if array.ndim else 0 for name, array in arrays.items()}
    n, r, m = sizes["u"], sizes["modes"], sizes["coordinates"]
    wanted = {"u": (n,), "mean": (n, 2), "modes": (r, n, 2), "coordinates": (m, r)}
    for name, shape in (wanted | {"variances": (sizes["variances"],)}).items():
        if arrays[name].shape != shape:
            return f"{name} has the shape {arrays[name].shape}, must be {shape}"
    if n < 3 or not 1 <= r <= sizes["variances"] or m < 1:
        return f"{n} landmarks, {r} modes of {sizes['variances']} variances, {m} shapes: too few"
    return next((said for said, holds in _RULES if not holds(arrays)), None)


def _orthonormal(basis: Array) -> bool:
    """Tell whether columns (n, k) are orthonormal to rounding, none too large to be multiplied."""
    small = np.abs(basis).max() < 2.0
    return bool(small and np.abs(basis.T @ basis - np.eye(basis.shape[1])).max() < ORTHONORMAL)


_RULES: tuple[tuple[str, Callable[[dict[str, Array]], bool]], ...] = (
    (
        "u must increase within 0 to 1",
        lambda a: bool(a["u"][0] >= 0 and a["u"][-1] <= 1 and np.all(np.diff(a["u"]) > 0)),
    ),
    ("mean must be an orthonormal basis", lambda a: _orthonormal(a["mean"])),
    (
        "modes must be orthonormal",
        lambda a: _orthonormal(a["modes"].reshape(len(a["modes"]), -1).T),
    ),
    (
        "modes must be tangent at the mean",
        lambda a: bool(np.abs(a["mean"].T @ a["modes"]).max() < ORTHONORMAL),
    ),
    (
        f"variances of its modes must be {NO_SPREAD**2:g} to {FARTHEST**2:.3g} rad^2",
        lambda a: bool(
            a["variances"][len(a["modes"]) - 1] >= NO_SPREAD**2 and a["variances"][0] <= FARTHEST**2
        ),
    ),
    (
        "variances must fall and not be negative",
        lambda a: bool(np.all(np.diff(a["variances"]) <= 0) and a["variances"][-1] >= 0),
    ),
    (
        f"coordinates must lie within {FARTHEST:.3g} rad",
        lambda a: bool(np.abs(a["coordinates"]).max() <= FARTHEST),
    ),
)
