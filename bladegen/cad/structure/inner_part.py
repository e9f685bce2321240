"""The inner surface of a blade's wall as a sheet of named faces, and its figures.

Two sides that share an edge below the nose, and a strip between them at the trailing edge where
they leave one; open at root and tip.  Millimetres; OCP comes late.
"""

from dataclasses import replace

import numpy as np

from bladegen.blade.layup.layup import Layup
from bladegen.cad import shaping
from bladegen.cad.shapes import MILLIMETRES, area
from bladegen.cad.solids import SEWING, edge_strip
from bladegen.cad.step_documents import Part
from bladegen.errors import Finding
from bladegen.support.threads import one_thread
from bladegen.surface.inner.inner import inner_surface
from bladegen.surface.net import SurfaceNet
from bladegen.surface.regions import EDGE

__all__ = ["INNER", "inner_part"]

DIGITS = 6  # of a pole's coordinates in mm
INNER, SHADE = "inner surface", (150, 150, 150)
OPEN = 1e-5  # m; sides that come nearer than this have no strip between them


@one_thread()
def inner_part(
    net: SurfaceNet, layup: Layup, tolerance: float
) -> tuple[Part | None, dict[str, float], tuple[Finding, ...]]:
    """Return the inner surface below a net [m], its figures by name, and findings."""
    made = inner_surface(net, layup, tolerance)
    if made.net is None:
        return None, {}, made.findings
    scaled = replace(made.net, poles=np.round(made.net.poles * MILLIMETRES, DIGITS))
    faces = [
        (side, shaping.face(shaping.surface(half.poles, half.u_knots, half.v_knots)))
        for side, half in zip(layup.blade.sides, scaled.halves(), strict=True)
    ]
    if made.net.gaps.min() > OPEN:
        strip = shaping.surface(*edge_strip(scaled.poles, scaled.v_knots))
        faces.append((EDGE, shaping.face(strip)))
    shell, sewn = shaping.sewn([face for _, face in faces], SEWING)
    named = [(f"{INNER}: {side}", face, SHADE) for (side, _), face in zip(faces, sewn, strict=True)]
    figures = {
        "area_m2": area(shell) / MILLIMETRES**2,
        "wall_m3": made.volume,
        "layers_m3": _layers(layup),
        "without_room_m3": made.left_out,
        "deviation_m": made.deviation.maximum,
        "from_eta": float(made.net.v[0]),
        "to_eta": float(made.net.v[-1]),
    }
    return Part(INNER, shell, named), figures, made.findings


def _layers(layup: Layup) -> float:
    """Return the volume [m3] of the skin's layers, by what they weigh."""
    structure, masses = layup.structure, layup.layer_masses
    skin = (layer for layer in structure.layers if not layer.web)
    return sum(masses[one.name] / structure.by_name[one.material].density for one in skin)
