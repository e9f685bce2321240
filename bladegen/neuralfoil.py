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
from typing import Any

import numpy as np

from bladegen.blade.aero.kulfan import KULFAN, WEIGHTS, in_chords, kulfan
from bladegen.errors import BladegenError, MissingLibraryError
from bladegen.support.arguments import numbers
from bladegen.support.arrays import Array
from bladegen.support.values import brief

__all__ = ["Coefficients", "coefficients"]

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
    angles, numbers_ = (
        np.broadcast_to(numbers(value, name, BladegenError), lead).ravel()
        for value, name in ((alpha, "alpha"), (reynolds, "reynolds"))
    )
    middle = n // 2
    flat, chord = in_chords(sections.reshape(-1, n, 2))
    weights, back = kulfan(flat.real, flat.imag)
    values, slopes = _network(size)(weights, np.degrees(angles), numbers_)
    in_x, in_y = back(slopes[..., :KULFAN])
    # flat = (z - nose) / chord, a complex function: its derivative's conjugate takes gradients back
    turned = (in_x + 1j * in_y) / chord.conj()[:, None, None]
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
