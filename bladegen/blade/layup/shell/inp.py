"""A shell model as an input file for CalculiX and Abaqus: S8R elements, metres, newtons, kilograms.

Two forms of sections.  Without more, the laminate of each is one orthotropic material of the same
stiffness in its plane and the same mass, thickness given at the nodes; CalculiX 2.20 runs it.
With `laminates` they are composite sections, layer by layer; where thickness differs between
neighbours CalculiX stops at them (it makes a rigid knot of each node, and runs out of room).

Three steps: a force on the tip, the weight, the first modes.  The root is clamped.
"""

import re
import zlib
from collections.abc import Iterable, Iterator

import numpy as np

from bladegen.blade.layup.shell.laminates import even, moduli
from bladegen.blade.layup.shell.model import Section, ShellModel
from bladegen.blade.layup.shell.quality import (
    corner_normals,
    integrals,
    shared_normals,
    wall_jacobians,
)
from bladegen.definition.structure.structure import Material
from bladegen.errors import ExportError
from bladegen.support.arrays import Array, Indices

__all__ = ["FORCE", "MODES", "inp_lines", "nodal_thickness"]

FORCE = 1e4  # N, at the tip, toward positive x
GRAVITY = 9.81  # m/s2
MODES = 8
A_LINE = 12  # numbers of a set
SHRINKS, BY = 100, 0.8  # times that a wall is made thinner whose inside folds, and by how much
LONGEST = 56  # characters of a name: three of them stand in a line of at most 256
SOFT = 1e-3  # of the largest modulus, least of an even material: none is singular


def inp_lines(model: ShellModel, *, laminates: bool = False) -> Iterator[str]:
    """Return the lines of a model's file."""
    mesh = model.mesh
    yield f"** {_name(model.blade.name)}: {len(mesh.quads)} elements; m, N, kg, s"
    yield f"** {'composite sections' if laminates else 'one even material a section'}"
    yield "*NODE, NSET=ALL_NODES"
    for i, (x, y, z) in enumerate(mesh.points.tolist(), start=1):
        yield f"{i}, {x:.9g}, {y:.9g}, {z:.9g}"
    yield "*ELEMENT, TYPE=S8R, ELSET=ALL_ELEMENTS"
    kept = [section for section in model.sections if section.layers]
    there = np.concatenate([section.elements for section in kept])
    for i in there.tolist():
        yield ", ".join(map(str, [i + 1, *(mesh.quads[i] + 1).tolist()]))
    for name, nodes in (("ROOT", mesh.root), ("TIP", mesh.tip)):
        yield f"*NSET, NSET={name}"
        yield from _listed(nodes + 1)
    for name, elements in model.sets.items():
        held = np.intersect1d(elements, there)
        if len(held):
            yield f"*ELSET, ELSET={_name(name)}"
            yield from _listed(held + 1)
    for section in kept:
        yield f"*ELSET, ELSET={_name(section.name)}"
        yield from _listed(section.elements + 1)
    yield from (_laminated if laminates else _evenly)(model, kept)
    yield from ("*BOUNDARY", "ROOT, 1, 6")
    yield from _steps(len(mesh.tip))


def _steps(tips: int) -> Iterator[str]:
    yield from ("** a force at the tip", "*STEP", "*STATIC", "*CLOAD")
    yield f"TIP, 1, {FORCE / tips:.9g}"
    yield from ("*NODE PRINT, NSET=TIP", "U", "*NODE FILE", "U", "*END STEP")
    yield from ("** the weight, whose reaction is that of the root", "*STEP", "*STATIC")
    yield from ("*CLOAD, OP=NEW", "*DLOAD, OP=NEW")
    yield f"ALL_ELEMENTS, GRAV, {GRAVITY:g}, 0., 0., -1."
    yield from ("*NODE PRINT, NSET=ROOT, TOTALS=ONLY", "RF", "*END STEP")
    yield from ("** the first modes", "*STEP", "*CLOAD, OP=NEW", "*DLOAD, OP=NEW")
    yield from ("*FREQUENCY", f"{MODES}", "*NODE FILE", "U", "*END STEP")


def _material(name: str, rows: Iterable[float], density: float) -> Iterator[str]:
    yield f"*MATERIAL, NAME={name}"
    nine = [f"{value:.9g}" for value in rows]
    yield "*ELASTIC, TYPE=ENGINEERING CONSTANTS"
    yield ", ".join(nine[:8]) + ","
    yield nine[8]
    yield from ("*DENSITY", f"{density:.9g}")


def _orientation(name: str, model: ShellModel, section: Section, angle: float) -> Iterator[str]:
    """Return an orientation, its first axis along the fibres, its second in the section's plane."""
    along, across = (axes[section.elements].mean(axis=0) for axes in model.axes)
    c, s = np.cos(angle), np.sin(angle)
    axes = np.concatenate([c * along + s * across, c * across - s * along])
    yield f"*ORIENTATION, NAME={name}, SYSTEM=RECTANGULAR"
    yield ", ".join(f"{value:.7g}" for value in axes)


def _evenly(model: ShellModel, sections: list[Section]) -> Iterator[str]:
    materials = model.structure.by_name
    nodal = nodal_thickness(model)
    areas, total = model.areas, model.thickness.sum(axis=0)
    volumes = integrals(model.mesh.points, model.mesh.quads, nodal)
    yield "*NODAL THICKNESS"
    for i in np.flatnonzero(nodal > 0.0).tolist():
        yield f"{i + 1}, {nodal[i]:.7g}"
    for section in sections:
        name, here = _name(section.name), section.elements
        if section.skin:
            thickness = float(volumes[here].sum() / areas[here].sum())
        else:
            thickness = float(total[model.mesh.part == model.mesh.part[here[0]]].max())
        stack = [
            (materials[model.structure.layers[i].material], t, _angle(model, section, i))
            for i, t in section.layers
        ]
        one = even(stack, thickness)
        across = max(one.across, SOFT * one.along)
        shear = max(one.shear, SOFT * one.along)
        rows = (one.along, across, across, one.poisson, 0.0, 0.0, shear, shear, shear)
        yield from _material(f"M_{name}", rows, one.density)
        yield from _orientation(f"O_{name}", model, section, 0.0)
        said = f"ELSET={name}, MATERIAL=M_{name}, ORIENTATION=O_{name}"
        if section.skin:
            yield f"*SHELL SECTION, NODAL THICKNESS, {said}, OFFSET=0.5"
        else:
            yield f"*SHELL SECTION, {said}"
        yield f"{thickness:.7g}"


def _laminated(model: ShellModel, sections: list[Section]) -> Iterator[str]:
    materials = model.structure.by_name
    for name in dict.fromkeys(layer.material for layer in model.structure.layers):
        yield from _own(materials[name])
    for section in sections:
        name = _name(section.name)
        angles = [_angle(model, section, i) for i, _ in section.layers]
        known = {angle: f"O_{name}_{k}" for k, angle in enumerate(dict.fromkeys(angles))}
        for angle, orientation in known.items():
            yield from _orientation(orientation, model, section, angle)
        offset = 0.5 if section.skin else 0.0
        yield f"*SHELL SECTION, COMPOSITE, ELSET={name}, OFFSET={offset:g}"
        for (i, t), angle in reversed([*zip(section.layers, angles, strict=True)]):
            material = _name(model.structure.layers[i].material)
            yield f"{t:.7g}, 3, {material}, {known[angle]}"


def _own(material: Material) -> Iterator[str]:
    """Return a material of a layer, in all its directions as far as they are known."""
    first, second, shear, poisson = moduli(material)
    name = _name(material.name)
    if material.orthotropic and material.E and material.G and material.nu:
        rows = (*material.E, *material.nu, *material.G)
        yield from _material(name, rows, material.density)
        return
    yield from _material(
        name, (first, second, second, *(poisson,) * 3, *(shear,) * 3), material.density
    )


def _angle(model: ShellModel, section: Section, layer: int) -> float:
    return float(model.angle[layer, section.elements[0]])


def nodal_thickness(model: ShellModel) -> Array:
    """Return the thickness (n,) of the skin at nodes [m]: the mean of the elements there.

    It is made thinner where the inside of a wall would fold, as at a sharp nose; what stands for
    the laminate is stiffer there.  0 at nodes of webs alone.
    """
    mesh = model.mesh
    skin = mesh.quads[mesh.part == 0]
    total = model.thickness.sum(axis=0)[mesh.part == 0]
    weight, count = np.zeros(len(mesh.points)), np.zeros(len(mesh.points))
    np.add.at(weight, skin, total[:, None])
    np.add.at(count, skin, 1.0)
    found = np.divide(weight, count, out=np.zeros_like(weight), where=count > 0.0)
    normals = corner_normals(mesh.points, skin)
    unit = normals / np.linalg.norm(normals, axis=-1, keepdims=True)
    shared, outer = shared_normals(unit, skin), mesh.points[skin]
    for _ in range(SHRINKS):
        inner = outer - found[skin][..., None] * unit
        flat = inner.reshape(-1, 3)
        turned = corner_normals(flat, np.arange(len(flat)).reshape(-1, 8))
        folded = np.einsum("mni,mni->mn", turned, unit) <= 0.2 * np.linalg.norm(normals, axis=-1)
        bad = folded.any(axis=1) | (wall_jacobians(outer, found[skin][..., None] * shared) <= 0.0)
        if not bad.any():
            return found
        most = BY * found[skin[bad]].max(axis=1)  # the thickest nodes first: even walls fold last
        np.minimum.at(found, skin[bad], most[:, None])
    raise ExportError("shell: its walls fold inside; a larger element size may help")


def _listed(numbers: Indices) -> Iterator[str]:
    values = numbers.tolist()
    for i in range(0, len(values), A_LINE):
        yield ", ".join(map(str, values[i : i + A_LINE])) + ","


def _name(text: str) -> str:
    """Return a name as solvers take it."""
    plain = re.sub(r"[^A-Za-z0-9_]", "_", text)
    plain = plain if plain[:1].isalpha() else f"N_{plain}"
    if len(plain) <= LONGEST:
        return plain
    return f"{plain[: LONGEST - 9]}_{zlib.crc32(text.encode()):08x}"
