"""Laminates in plane stress: stiffness of their layers, and the one material that stands for them.

The stand-in has the laminate's stiffness in its plane, its mass and any thickness; it bends as an
even wall does.  Classical laminate theory: Jones, Mechanics of Composite Materials, 2nd ed., ch. 4.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.definition.structure.structure import Material
from bladegen.errors import ExportError
from bladegen.support.arrays import Array

__all__ = ["Even", "even", "moduli", "plane_stiffness"]


@dataclass(frozen=True)
class Even:
    """An orthotropic material for a whole laminate, equal across and through it [Pa, kg/m3]."""

    along: float
    across: float
    shear: float
    poisson: float
    density: float


def moduli(material: Material) -> tuple[float, float, float, float]:
    """Return E1, E2, G12 [Pa] and nu12 of a material.

    Raises
    ------
    ExportError
        If its file does not say, or says what no material can be.
    """
    if material.E is None or material.nu is None:
        raise ExportError(f"material {material.name}: E and nu are needed, and not given")
    first, second, poisson = material.E[0], material.E[1], material.nu[0]
    if material.orthotropic and material.G is not None:
        shear = material.G[0]
    else:
        shear = first / (2.0 * (1.0 + poisson))
    if min(first, second, shear) <= 0.0 or poisson**2 * second >= first:
        raise ExportError(
            f"material {material.name}: E = {first:g}, {second:g} Pa, G = {shear:g} Pa, nu = "
            f"{poisson:g} are those of no material"
        )
    return first, second, shear, poisson


def plane_stiffness(material: Material, angle: float) -> Array:
    """Return the stiffness (3, 3) in plane stress [Pa] of fibres at an angle [rad] to the axis."""
    first, second, shear, poisson = moduli(material)
    held = 1.0 - poisson**2 * second / first
    own = np.array(
        [
            [first / held, poisson * second / held, 0.0],
            [poisson * second / held, second / held, 0.0],
            [0.0, 0.0, shear],
        ]
    )
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array(
        [[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]]
    )
    turned: Array = turn.T @ own @ turn
    return turned


def even(layers: list[tuple[Material, float, float]], thickness: float) -> Even:
    """Return the material that stands for layers (material, thickness [m], angle [rad])."""
    stiffness = sum(t * plane_stiffness(material, angle) for material, t, angle in layers)
    weight = sum(t * material.density for material, t, _ in layers)
    give = thickness * np.linalg.inv(np.asarray(stiffness))
    return Even(
        along=1.0 / give[0, 0],
        across=1.0 / give[1, 1],
        shear=1.0 / give[2, 2],
        poisson=-give[0, 1] / give[0, 0],
        density=weight / thickness,
    )
