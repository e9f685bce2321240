"""The surface of a file that anyone made, or of a blade, and what is known of its unit.

Files are read by a process of their own (`foreign`); what comes back is looked at before it is
used.  Metres, or a mesh file's own unit where it names none.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.errors import FileError
from bladegen.measures import foreign, surfaces
from bladegen.measures.surfaces import Surface
from bladegen.surface.mesh import TriangleMesh
from bladegen.surface.mesh_files import FARTHEST
from bladegen.surface.tips import Tip, flat_tip

__all__ = ["MILLIMETRES", "Side", "surface_of"]

MILLIMETRES = 1e-3  # m
PLACES = ("/poles", "/vertices")


@dataclass(frozen=True, eq=False)
class Side:
    """One of the two things that are compared.

    Parameters
    ----------
    name : str
        What it is and which file, as a sentence begins with it.
    surface : Surface
        Its surface [m], or in a mesh file's own unit.
    measured : bool
        Whether its unit is known: mesh files but GLB and 3MF name none.
    defined : bool
        Whether it is a blade, whose metres are right.
    remarks : tuple of str
        What the result should say of it.
    """

    name: str
    surface: Surface
    measured: bool = True
    defined: bool = False
    remarks: tuple[str, ...] = ()


def surface_of(
    source: Path | Blade, tip: Tip = flat_tip, *, millimetres: float = MILLIMETRES
) -> Side:
    """Return the surface of a file, or of a blade with a tip.

    A CAD file's millimetres are taken to be `millimetres` [m]: some call their metres so.

    Raises
    ------
    FileError
        If the file is of no kind that has a surface, or cannot be read.
    """
    if isinstance(source, Blade):
        name = Path(source.definition.source).name or source.name
        return Side(f"the definition {name}", surfaces.of_blade(source, tip), defined=True)
    answer = foreign.ask("surface", source)
    numbers = [values for values in answer.arrays.values() if values.dtype.kind == "f"]
    weights = [values for name, values in answer.arrays.items() if name.endswith("/weights")]
    sound = all(np.isfinite(n).all() for n in numbers) and all((w > 0).all() for w in weights)
    if not sound:
        raise FileError(str(source), ["has a surface of points that are no numbers"])
    reach = max((float(np.abs(n).max()) for n in numbers if n.size), default=0.0)
    if reach > FARTHEST:
        raise FileError(
            str(source), [f"has a number of {reach:.3g} in its surface, allowed is {FARTHEST:g}"]
        )
    if foreign.kind_of(source) == "solid":
        surface = surfaces.of_faces(
            {
                name: values * (millimetres / MILLIMETRES) if name.endswith(PLACES) else values
                for name, values in answer.arrays.items()
            }
        )
    else:
        surface = surfaces.of_mesh(TriangleMesh(answer.arrays["vertices"], answer.arrays["faces"]))
    if not surface.size > 0.0:
        raise FileError(str(source), ["has a surface that is one point"])
    metres, lost, sheets = (answer.facts[name] for name in ("metres", "lost", "sheets"))
    remarks = [f"{source.name}: {lost} of its faces could not be read"] if lost else []
    if sheets:
        remarks.append(
            f"{source.name}: {sheets} sheets beside its solid, such as webs, are left out"
        )
    kind = source.suffix.lstrip(".").upper().replace("STP", "STEP").replace("IGS", "IGES")
    return Side(
        f"the {kind} file {source.name}",
        surface if metres is None else surface.scaled(metres),
        measured=metres is not None,
        remarks=tuple(remarks),
    )
