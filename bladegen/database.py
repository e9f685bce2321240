"""The paper's database of airfoils, and shape spaces learned from it or from other airfoils.

16 baseline airfoils of the three reference turbines, 18 CST coefficients each, 1,000
perturbations of up to 20 % of every coefficient.
"""

import numpy as np

from bladegen import cst
from bladegen.affine import standardise
from bladegen.arrays import Array
from bladegen.landmarks import landmark_parameters, landmarks
from bladegen.pga import ShapeSpace
from bladegen.readers import read

__all__ = ["BASELINES", "baselines", "build_space"]

# The turbines hold 17 lifting airfoils.  DTU's ffaw3480 is its ffaw3360 stretched by 4/3 in y,
# the same point of the Grassmannian; without it there are the paper's 16.
BASELINES = (
    ("nrel5mw", ("DU40_A17", "DU35_A17", "DU30_A17", "DU25_A17", "DU21_A17", "NACA64_A17")),
    ("dtu10mw", ("ffaw3241", "ffaw3301", "ffaw3360")),
    (
        "iea15mw",
        (
            "FFA-W3-211",
            "FFA-W3-241",
            "FFA-W3-270blend",
            "FFA-W3-301",
            "FFA-W3-330blend",
            "FFA-W3-360",
            "SNL-FFA-W3-500",
        ),
    ),
)


def baselines() -> dict[str, Array]:
    """Return the coordinates of the 16 baseline airfoils by name."""
    found = {}
    for turbine, names in BASELINES:
        airfoils = {station.airfoil.name: station.airfoil for station in read(turbine).stations}
        for name in names:
            found[f"{turbine} {name}"] = airfoils[name].coordinates
    return found


def build_space(
    airfoils: dict[str, Array],
    *,
    seed: int,
    count: int = 1000,
    modes: int = 4,
    n: int = 401,
    reach: float = 0.2,
) -> tuple[ShapeSpace, dict[str, float]]:
    """Learn a space from perturbations of airfoils' CST coefficients.

    Parameters
    ----------
    airfoils : dict
        Coordinates (m, 2) by name, in any of the forms that `landmarks` takes.
    seed : int
        Of the perturbations.
    count : int
        Perturbations of each airfoil; 0 takes the airfoils themselves, with no CST.
    modes : int
        Modes to keep.
    n : int
        Landmarks.
    reach : float
        Largest relative change of a coefficient.

    Returns
    -------
    ShapeSpace
    dict
        The residual of each airfoil's CST fit, RMS [chord].
    """
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1):  # the same sums in the same order, whatever the machine
        shapes = np.stack([landmarks(xy, n) for xy in airfoils.values()])
        if count == 0:
            about = f"{len(airfoils)} airfoils"
            return ShapeSpace.fit(standardise(shapes)[0], modes=modes, about=about), {}
        fits = [cst.fit(shape) for shape in shapes]
        coefficients = np.stack([coefficients for coefficients, _ in fits])
        drawn = cst.perturbations(coefficients, count, np.random.default_rng(seed), reach=reach)
        space = ShapeSpace.fit(
            cst.standardised_shapes(drawn, n),
            modes=modes,
            u=landmark_parameters(n),
            about=f"{len(airfoils)} airfoils, {count} CST perturbations each of up to {reach:g}, "
            f"seed {seed}",
        )
        return space, {name: residual for name, (_, residual) in zip(airfoils, fits, strict=True)}
