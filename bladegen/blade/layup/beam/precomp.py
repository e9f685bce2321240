"""Beam properties of a blade's sections by PreComp of WISDEM (Bir, NREL/TP-500-38929).

In: a blade with webs and layers.  Out: mass and stiffness over span.  PreComp takes thin walls,
layers at their angle, webs normal to the chord; no transverse shear, for which WISDEM's own factors
stand in BeamDyn's matrices.  The extra `wisdem` installs it.
"""

import sys
from dataclasses import fields
from importlib.util import find_spec

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.layup.beam.properties import BeamProperties
from bladegen.blade.layup.layup import Layup
from bladegen.blade.layup.sectors import Sectors, Stack, sectors
from bladegen.blade.layup.shell.laminates import moduli
from bladegen.errors import ExportError, MissingLibraryError
from bladegen.support.arrays import Array, ArrayLike

__all__ = ["beam_properties", "require_solver"]

STATIONS = 50
OUTPUTS = (  # of PreComp, in its order
    *("edge", "flap", "torsion", "axial", "flap_edge", "axial_edge", "axial_flap", "edge_torsion"),
    *("flap_torsion", "axial_torsion", "mass", "area", "polar_inertia", "inertia_angle"),
    *("flap_inertia", "edge_inertia", "x_elastic", "y_elastic", "x_shear", "y_shear"),
    *("x_mass", "y_mass"),
)


def require_solver() -> None:
    """Raise unless WISDEM is there, without importing it, which takes seconds.

    Raises
    ------
    MissingLibraryError
        That says what to install.
    """
    if not (sys.modules.get("wisdem") or find_spec("wisdem")):
        raise MissingLibraryError(ModuleNotFoundError("No module named 'wisdem'", name="wisdem"))


def beam_properties(blade: Blade, eta: ArrayLike | None = None) -> BeamProperties:
    """Return the beam properties of a blade's sections.

    Parameters
    ----------
    blade : Blade
        With webs and layers.
    eta : (k,) array, optional
        Span fractions, at least two; 50 by default.

    Raises
    ------
    ExportError
        If the blade has no webs and layers, or is a mirror image; `MissingLibraryError` if WISDEM
        is not there.
    """
    require_solver()
    layup = blade.layup
    if layup is None:
        raise ExportError(f"{blade.name}: has no webs and layers, of which a beam's properties are")
    if blade.mirrored:
        raise ExportError(
            f"{blade.name}: is a mirror image; take the blade that it is the image of"
        )
    spans = np.linspace(0.0, 1.0, STATIONS) if eta is None else np.asarray(eta, dtype=np.float64)
    made = sectors(layup, spans)
    found = dict(zip(OUTPUTS, _precomp(layup, made), strict=True))
    twist = np.array([one.twist for one in made])
    nose = np.array([one.nose for one in made])
    turned = found | {"twist": twist}
    matrices = [_matrices({name: row[i] for name, row in turned.items()}) for i in range(len(made))]
    names = [one.name for one in fields(BeamProperties) if one.name in found]
    return BeamProperties(
        eta=spans,
        axis=blade.axis(spans),
        pitch_axis=nose,
        twist=np.degrees(twist),
        stiffness=np.array([pair[0] for pair in matrices]),
        inertia=np.array([pair[1] for pair in matrices]),
        **{name: found[name] for name in names},
    )


def _precomp(layup: Layup, made: list[Sectors]) -> tuple[Array, ...]:
    from wisdem.precomp.composite_section import CompositeSection
    from wisdem.precomp.orthotropic import Orthotropic2DMaterial
    from wisdem.precomp.precomp import PreComp
    from wisdem.precomp.profile import Profile

    structure, blade = layup.structure, layup.blade
    materials = [
        Orthotropic2DMaterial(*(moduli(one)), one.density, one.name) for one in structure.materials
    ]
    number = {one.name: i for i, one in enumerate(structure.materials)}

    def composite(places: ArrayLike, stacks: tuple[Stack, ...]) -> CompositeSection:
        which = [[number[structure.layers[i].material] for i, _, _ in one] for one in stacks]
        return CompositeSection(
            places,
            [np.ones(len(one)) for one in stacks],
            [np.array([t for _, t, _ in one]) for one in stacks],
            [np.degrees([turn for _, _, turn in one]) for one in stacks],
            [np.array(one) for one in which],
            materials,
        )

    span = blade.axis(np.array([one.eta for one in made]))
    length = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(span, axis=0), axis=-1)))
    walls = [tuple(zip(*one.walls, strict=True)) or ((), ()) for one in made]
    nothing = [None] * len(made)
    solver = PreComp(
        length,
        [one.chord for one in made],
        np.degrees([one.twist for one in made]),
        [one.nose for one in made],
        span[:, 0],
        span[:, 1],
        [Profile.initWithTEtoTEdata(*one.outline.T) for one in made],
        materials,
        [composite(*one.upper) for one in made],
        [composite(*one.lower) for one in made],
        [composite(*one) for one in walls],
        *(nothing,) * 4,
    )
    return tuple(solver.sectionProperties())


def _matrices(one: dict[str, float]) -> tuple[Array, Array]:
    """Return stiffness and inertia (6, 6) as WISDEM makes them of PreComp's figures.

    But for the sign of the product of flap and edge: in BeamDyn's axes, x to the suction side and
    y to the trailing edge, it is the integral of -E x y, PreComp's that of E x y.
    """
    from wisdem.precomp.precomp_to_beamdyn import pc2bd_I, pc2bd_K

    product = -one["flap_edge"]
    stiffness = pc2bd_K(
        *(one["axial"], one["edge"], one["flap"], product, one["axial_edge"], one["axial_flap"]),
        *(one[name] for name in ("edge_torsion", "flap_torsion", "axial_torsion", "torsion")),
        *(one[name] for name in ("polar_inertia", "edge_inertia", "flap_inertia")),
        *(one[name] for name in ("x_elastic", "y_elastic")),
    )
    inertia = pc2bd_I(
        *(one[name] for name in ("mass", "edge_inertia", "flap_inertia", "polar_inertia")),
        *(one[name] for name in ("x_mass", "y_mass")),
        np.radians(one["inertia_angle"]),
        one["twist"],
    )
    return np.asarray(stiffness), np.asarray(inertia)
