"""Lift, drag and moment of sections by NeuralFoil, with exact derivatives.

In: points of sections as `ParametricBlade` makes them, in any plane axes and size.  Out: their
coefficients, and derivatives in points, angle of attack and Reynolds number.  The fit of Kulfan's
parameters is a linear least-squares problem and is differentiated by hand; NeuralFoil's own code
is differentiated by casadi, with which it comes.  P. Sharpe, https://github.com/peterdsharpe/NeuralFoil.
The extra `aero` installs both.  Sections thicker than 40 % are none of NeuralFoil's.
"""

import warnings
from dataclasses import dataclass
from functools import cache
from math import comb
from typing import Any

import numpy as np

from bladegen.errors import BladegenError, MissingLibraryError
from bladegen.support.arguments import numbers
from bladegen.support.arrays import Array
from bladegen.support.values import brief

__all__ = ["Coefficients", "coefficients"]

WEIGHTS = 8  # of Kulfan's parameters a side, as the networks take them
KULFAN = 2 * WEIGHTS + 2
NAMES = ("CL", "CD", "CM")


@dataclass(frozen=True, eq=False, repr=False)
class Coefficients:
    """Lift, drag and moment coefficients of sections (...), and their derivatives.

    Parameters
    ----------
    values : (..., 3) array
        Lift, drag, and the moment about the quarter chord, nose up positive.
    in_points : (..., 3, n, 2) array
        Derivatives in the points, angle of attack to the chord line and Reynolds number held.
    in_alpha, in_reynolds : (..., 3) arrays
        Derivatives in the angle of attack [rad], and in the Reynolds number.
    """

    values: Array
    in_points: Array
    in_alpha: Array
    in_reynolds: Array

    __repr__ = brief


def coefficients(points: Any, alpha: Any, reynolds: Any, *, size: str = "xlarge") -> Coefficients:
    """Return the coefficients of sections.

    Parameters
    ----------
    points : (..., n, 2) array
        Sections, suction side first, leading edge in the middle, from trailing edge to trailing
        edge; suction lies to the left of the chord line.
    alpha : (...) array
        Angles of attack from the chord line [rad].
    reynolds : (...) array
        Reynolds numbers.
    size : str
        Of the network: "xxsmall" to "xxxlarge".

    Raises
    ------
    MissingLibraryError
        If NeuralFoil is not installed.
    BladegenError
        If points are none of sections.
    """
    sections = numbers(points, "points", BladegenError, "sections (..., n, 2)")
    if sections.ndim < 2 or sections.shape[-1] != 2 or sections.shape[-2] < KULFAN:
        raise BladegenError(
            f"points: got shape {sections.shape}, must be (..., n, 2), n >= {KULFAN}"
        )
    lead, n = sections.shape[:-2], sections.shape[-2]
    z = (sections[..., 0] + 1j * sections[..., 1]).reshape(-1, n)
    angles, numbers_ = (
        np.broadcast_to(numbers(value, name, BladegenError), lead).ravel()
        for value, name in ((alpha, "alpha"), (reynolds, "reynolds"))
    )
    middle = n // 2
    nose, chord = z[:, middle, None], 0.5 * (z[:, :1] + z[:, -1:]) - z[:, middle, None]
    flat = (z - nose) / chord
    kulfan, back = _kulfan(flat.real, flat.imag)
    values, slopes = _network(size)(kulfan, np.degrees(angles), numbers_)
    in_x, in_y = back(slopes[..., :KULFAN])
    # flat = (z - nose) / chord, a complex function: its derivative's conjugate takes gradients back
    turned = (in_x + 1j * in_y) / chord.conj()[:, None]
    in_chord = -(turned * flat.conj()[:, None]).sum(axis=-1)
    in_nose = -turned.sum(axis=-1) - in_chord
    turned[..., middle] += in_nose
    turned[..., 0] += 0.5 * in_chord
    turned[..., -1] += 0.5 * in_chord
    return Coefficients(
        values.reshape(*lead, 3),
        np.stack([turned.real, turned.imag], axis=-1).reshape(*lead, 3, n, 2),
        np.degrees(slopes[..., KULFAN]).reshape(*lead, 3),
        slopes[..., KULFAN + 1].reshape(*lead, 3),
    )


def _kulfan(x: Array, y: Array) -> tuple[Array, Any]:
    """Fit Kulfan's parameters (b, 18) to sections in chords, leading edge in the middle.

    Upper and lower weights, the weight of the leading edge, the edge's thickness, which is not
    negative: the order in which NeuralFoil takes them.  The second result takes gradients
    (b, q, 18) in parameters back to x and y (b, q, n).
    """
    n, middle = x.shape[-1], x.shape[-1] // 2
    upper = np.arange(n) < middle
    # the nose is 0, 0 whatever the parameters are; the others lie within a chord of the edge
    x = np.where(np.arange(n) == middle, 0.5, np.maximum(x, 1e-12))
    kept = np.arange(n) != middle
    basis, slopes = _basis(x)
    nose = x * np.maximum(1.0 - x, 0.0) ** (WEIGHTS + 0.5)
    nose_slope = np.maximum(1.0 - x, 0.0) ** (WEIGHTS - 0.5) * (1.0 - (WEIGHTS + 1.5) * x)
    side = np.where(upper, 0.5, -0.5)

    def rows(basis: Array, nose: Array, edge: Array) -> Array:
        halves = basis * upper[:, None], basis * ~upper[:, None]
        made = np.concatenate([*halves, nose[..., None], edge[..., None]], axis=-1)
        return np.asarray(made * kept[:, None])

    matrix = rows(basis, nose, side * x)
    slope = rows(slopes, nose_slope, np.broadcast_to(side, x.shape))
    inverse = np.linalg.pinv(matrix)
    sharp = np.einsum("bn,bn->b", inverse[:, -1], y) < 0.0
    matrix[sharp, :, -1], slope[sharp, :, -1] = 0.0, 0.0
    if sharp.any():
        inverse[sharp] = np.linalg.pinv(matrix[sharp])
    found = np.einsum("bmn,bn->bm", inverse, y)
    missed = (y - np.einsum("bnm,bm->bn", matrix, found)) * kept

    def back(gradient: Array) -> tuple[Array, Array]:
        in_y = gradient @ inverse
        moved = in_y @ inverse.mT
        through = np.einsum("bnm,bm->bn", slope, found)[:, None]
        in_x = missed[:, None] * (moved @ slope.mT) - in_y * through
        return in_x, in_y

    return found, back


def _basis(x: Array) -> tuple[Array, Array]:
    """Return the terms (b, n, 8) of one side, class exponents 1/2 and 1, and their slopes."""
    k = np.arange(WEIGHTS)
    choose = np.array([float(comb(WEIGHTS - 1, int(j))) for j in k])
    x = x[..., None]
    # x^(k + 1/2) (1 - x)^(8 - k): at blunt edges x passes 1 by a little, where whole powers hold
    low, high = x ** (k + 0.5), (1.0 - x) ** (WEIGHTS - k)
    low_slope = (k + 0.5) * x ** (k - 0.5)
    high_slope = -(WEIGHTS - k) * (1.0 - x) ** (WEIGHTS - k - 1)
    return choose * low * high, choose * (low_slope * high + low * high_slope)


@cache
def _network(size: str) -> Any:
    """Return NeuralFoil as a function of Kulfan's parameters (b, 18), degrees and Reynolds numbers.

    It gives values (b, 3), and derivatives (b, 3, 20) in these.
    """
    try:
        import casadi
        import neuralfoil
    except ImportError as error:
        raise MissingLibraryError(error) from None
    x = casadi.MX.sym("x", KULFAN + 2)
    given = {
        "upper_weights": x[:WEIGHTS],
        "lower_weights": x[WEIGHTS : 2 * WEIGHTS],
        "leading_edge_weight": x[KULFAN - 2],
        "TE_thickness": x[KULFAN - 1],
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FutureWarning)  # casadi's, on how NumPy takes its matrices
        try:
            made = neuralfoil.get_aero_from_kulfan_parameters(
                given, x[KULFAN], x[KULFAN + 1], model_size=size
            )
        except ValueError as error:
            raise BladegenError(f"size: {' '.join(str(error).split())}") from None
        values = casadi.vertcat(*(made[name] for name in NAMES))
        function = casadi.Function("polar", [x], [values, casadi.jacobian(values, x)])

    def called(kulfan: Array, degrees: Array, reynolds: Array) -> tuple[Array, Array]:
        columns = np.concatenate([kulfan.T, [degrees], [reynolds]])
        values, slopes = (np.array(part) for part in function(columns))
        return values.T, slopes.reshape(len(NAMES), -1, KULFAN + 2).swapaxes(0, 1)

    return called
