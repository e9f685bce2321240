"""Saved shape spaces, ours and G2Aero's, and what their arrays must be, whatever a file claims.

G2Aero (NREL, github.com/NREL/G2Aero, `PGA.Grassmann_PGAspace.save_to_file`) keeps a mean on the
Grassmannian, principal directions as rows of 2n numbers, the data's coordinates along them, and a
mean affine part, in NumPy's npz.  Its landmarks begin at the pressure side's trailing edge.
"""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from bladegen.curves.arc_lengths import divided
from bladegen.errors import SpaceError
from bladegen.support.archive import load_arrays, members
from bladegen.support.arrays import Array

__all__ = ["FARTHEST", "NO_SPREAD", "ORTHONORMAL", "problem_of", "read_space"]

G2AERO = ("Vh", "karcher_mean", "M_mean", "b_mean", "coords")
MODES = 4  # of G2Aero's, as many as the paper keeps and as bladegen learns by default

ORTHONORMAL = 1e-8  # saved bases are orthonormal to rounding
NO_SPREAD = 1e-9  # rad; shapes that vary less along a mode do not vary along it
FARTHEST = np.pi / np.sqrt(2.0)  # rad, the distance at which both principal angles are 90 degrees


def read_space(path: Path, names: Sequence[str]) -> tuple[dict[str, Array], str]:
    """Return the arrays of a saved space by our names, and where its shapes are from.

    Raises
    ------
    SpaceError
        If the file cannot be read, is damaged, or is none of ours and none of G2Aero's.
    """
    held = members(path, (*G2AERO, "mean", "shape_mean"))
    if "karcher_mean" not in held or "mean" in held:
        return load_arrays(path, names)
    if "shape_mean" in held or held["karcher_mean"].shape == (2, 2):
        raise SpaceError(
            f"{path}: is G2Aero's space of affine parts (SPD); its space of shapes is read, which "
            "Grassmann_PGAspace.save_to_file writes"
        )
    missing = [name for name in G2AERO if name not in held]
    if missing:
        raise SpaceError(f"{path}: is a space of G2Aero's without {' and '.join(missing)}")
    return _of_g2aero(path, held)


def _of_g2aero(path: Path, held: dict[str, Array]) -> tuple[dict[str, Array], str]:
    mean, rows, data = (np.asarray(held[k], dtype=float) for k in ("karcher_mean", "Vh", "coords"))
    n, many = len(mean), len(rows)
    shapes = (mean.shape, rows.shape, held["M_mean"].shape, held["b_mean"].shape, data.ndim)
    if shapes != ((n, 2), (many, 2 * n), (2, 2), (2,), 2) or n < 5 or not data.size:
        raise SpaceError(
            f"{path}: its Vh, karcher_mean and coords have the shapes {rows.shape}, {mean.shape} "
            f"and {data.shape}, must be (r, 2 n), (n, 2) and (m, r), n at least 5"
        )
    order = slice(None)
    plain = mean @ held["M_mean"] + held["b_mean"]
    x, y = plain.T
    if np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) < 0.0:  # the pressure side first
        order, plain = slice(None, None, -1), plain[::-1]
    variances = np.mean(data**2, axis=0)
    kept = min(MODES, many, data.shape[1])
    about = f"G2Aero, {path.name}: the first {kept} of {many} modes"
    return {
        "u": _places(plain),
        "mean": mean[order],
        "modes": rows[:kept].reshape(kept, n, 2)[:, order],
        "variances": variances,
        "coordinates": data[:, :kept].copy(),
    }, about


def _places(points: Array) -> Array:
    """Return the landmark parameters (n,) of a shape's points: `arc_lengths.divided` undone.

    G2Aero divides the whole contour evenly, so that the leading edge lies between two landmarks:
    where the parabola through the farthest three from the trailing edge is highest.
    """
    steps = np.linalg.norm(np.diff(points, axis=0), axis=-1)
    share = np.concatenate([[0.0], np.cumsum(steps)])
    share /= share[-1]
    far = np.sum((points - 0.5 * (points[0] + points[-1])) ** 2, axis=-1)
    middle = int(np.clip(np.argmax(far), 1, len(far) - 2))
    near = slice(middle - 1, middle + 2)
    bend, slope, _ = np.polyfit(share[near] - share[middle], far[near] - far[middle], 2)
    edge = share[middle] - 0.5 * slope / bend if bend < 0.0 else share[middle]
    return divided(share, np.asarray(1.0 - edge))  # cot(pi (1 - x)) = -cot(pi x)


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
