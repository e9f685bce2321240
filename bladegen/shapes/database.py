"""Shape spaces learned from a database of airfoils: the paper's, or any other.

18 CST coefficients an airfoil, and perturbations of up to 20 % of every coefficient; the paper
takes 1,000 of each of 16 airfoils (`formats.baselines`).
"""

import numpy as np

from bladegen.airfoils.landmarks import Spacing, clustered, landmark_parameters, landmarks
from bladegen.curves.crossing import crossing_sections
from bladegen.shapes import cst
from bladegen.shapes.affine import standardise
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arrays import Array
from bladegen.support.threads import one_thread

__all__ = ["build_space"]

CHUNK = 500  # shapes that are tested at once


def build_space(
    airfoils: dict[str, Array],
    *,
    seed: int,
    count: int = 1000,
    modes: int = 4,
    n: int = 401,
    reach: float = 0.2,
    edge: float = 0.0,
    spacing: Spacing = clustered,
    sound: bool = False,
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
    edge : float
        Thickness of the perturbed airfoils' trailing edges [chord]; the paper's are sharp.
    spacing : callable
        Of the landmarks along each side.
    sound : bool
        Leave out perturbed airfoils that cross themselves.

    Returns
    -------
    ShapeSpace
    dict
        The residual of each airfoil's CST fit, RMS [chord].
    """
    with one_thread():  # the same sums in the same order, whatever the machine
        u = landmark_parameters(n, spacing)
        shapes = np.stack([landmarks(xy, n, spacing=spacing) for xy in airfoils.values()])
        if count == 0:
            about = f"{len(airfoils)} airfoils"
            return ShapeSpace.fit(standardise(shapes)[0], modes=modes, u=u, about=about), {}
        fits = [cst.fit(shape) for shape in shapes]
        coefficients = np.stack([coefficients for coefficients, _ in fits])
        drawn = cst.perturbations(coefficients, count, np.random.default_rng(seed), reach=reach)
        points = cst.standardised_shapes(drawn, u=u, edge=edge)
        about = (
            f"{len(airfoils)} airfoils, {count} CST perturbations each of up to {reach:g}, "
            f"seed {seed}"
        )
        if edge:
            about += f", trailing edges open by {edge:g} chord"
        if sound:
            parts = (crossing_sections(points[i : i + CHUNK]) for i in range(0, len(points), CHUNK))
            crossing = [i * CHUNK + j for i, part in enumerate(parts) for j in part]
            points = np.delete(points, crossing, axis=0)
            about += f", without {len(crossing)} that cross themselves"
        space = ShapeSpace.fit(points, modes=modes, u=u, about=about)
        return space, {name: residual for name, (_, residual) in zip(airfoils, fits, strict=True)}
