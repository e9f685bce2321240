"""A blade found in a file: its unit, its pose, and whether it is one blade at all."""

from dataclasses import replace

import numpy as np

from bladegen.curves.crossing import crossing_sections
from bladegen.errors import GeometryError
from bladegen.fitting.placing.pose import Pose, cuts_across
from bladegen.fitting.placing.root import upright
from bladegen.fitting.placing.suction_side import chord_of, sided
from bladegen.fitting.sections.chains import Cut
from bladegen.measures.surfaces import Surface
from bladegen.support.arrays import Array
from bladegen.surface.mesh import TriangleMesh

__all__ = ["FRAMES", "SHORTEST", "UNITS", "found"]

FRAMES = ("auto", "file", "blade")
UNITS = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "in": 0.0254, "ft": 0.3048}
METRES, MILLIMETRES = 300.0, 2000.0  # lengths below the first are metres, above the other mm
SMALL = 20.0  # m: in such a unit it may be a model, or in inches a blade
SHORTEST = 1.0  # m of a blade; shorter ones are worth a word
PLANES = 41  # at which a surface is first looked at
SLENDER = 3.0  # times as long as wide, at least
ALIGNED = np.radians(0.3)  # between the pitch axis and an axis of the file
INSIDE = 0.05  # of the root's diameter, by which an axis of the file may miss its centre
LEAST_TURN = np.radians(30.0)  # between the chord near the tip and the file's axis of no twist
FEW, OPENED = 5, 0.2  # points of an outline, and of its length that a gap may have
AROUND, FOLDED = 401, 3  # points of an outline, and outlines that may cross themselves at ends
FILLED = 0.9999  # of the hull's volume, that a mesh has which is one
ENOUGH = 0.5  # of the planes that must cut an outline


def found(
    surface: Surface,
    name: str,
    *,
    metres: float | None,
    unit: str | None,
    frame: str = "auto",
    root: str = "auto",
    flanged: bool = True,
) -> Pose:
    """Find a blade in a file.

    Parameters
    ----------
    surface : Surface
        In the file's axes and unit.
    name : str
        What errors call it.
    metres : float, optional
        The file's unit as it says it; None if it says none.
    unit : str, optional
        The unit of `UNITS` that the user says.
    frame : str
        "file": the file's own axes, up to their names, are the blade's; "blade": they follow from
        the shape alone, and twist is zero at 90 % span; "auto": the file's where these fit.

    root : str
        What the pitch axis follows: "flange", "circles" or "auto", see `root.upright`.
    flanged : bool
        Whether its ends can be flanges; those of a surface through a cloud are none.

    Raises
    ------
    GeometryError
        If what it holds is no blade: the message says what is missing.
    """
    start = _lengthwise(surface.mesh)
    pose, said = _scaled(start, surface, metres, unit)
    widths = _widths(pose, surface, name)
    if _root_last(widths):
        pose = _turned(pose, surface)
        widths = widths[::-1]
    pose, diameter, doubt = upright(pose, surface, said, root=root, flanged=flanged)
    pose = sided(pose, surface, name, said)
    own = _own_axes(pose, diameter) if frame != "blade" else None
    if own is None and frame == "file":
        raise GeometryError(
            f"{name}: frame: its own axes are no blade's: none runs through the middle of the root "
            "along the blade; allowed here are auto and blade"
        )
    if own is not None:
        pose = own
        said.append("the axes are those of the file: " + _named(pose))
    else:
        pose = _untwisted(pose, surface)
        said.append("the file's axes are not the blade's: twist is zero at 90 % of the span")
        said += [doubt] if doubt else []
    if _is_hull(surface.mesh):
        said.append(
            "it is the convex hull of a blade: hollows are filled, and its sections are no airfoils"
        )
    if pose.mirrored:
        said.append("it is a mirror image: its rotor turns anticlockwise seen from upwind")
    return replace(pose, said=tuple(said))


def _is_hull(mesh: TriangleMesh) -> bool:
    """Tell whether a mesh is its own convex hull, as some programs export what they join."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        hull = ConvexHull(mesh.vertices[np.unique(mesh.faces)])
    except QhullError:
        return False
    corners = mesh.vertices[mesh.faces] - mesh.vertices.mean(axis=0)
    return bool(abs(np.linalg.det(corners).sum()) / 6.0 > FILLED * hull.volume)


def _lengthwise(mesh: TriangleMesh) -> Pose:
    """Return the pose whose z is along a mesh's longest extent, its low end at z = 0."""
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    centres = (a + b + c) / 3.0
    total = area.sum()
    if not total > 0.0:
        raise GeometryError("the surface has no area")
    middle = area @ centres / total
    away = centres - middle
    _, axes = np.linalg.eigh((away * area[:, None]).T @ away / total)
    axes = axes * np.where(np.linalg.det(axes) < 0.0, -1.0, 1.0)
    placed = mesh.vertices @ axes
    return Pose(1.0, axes, np.array([0.0, 0.0, -placed[:, 2].min()]) - [*(middle @ axes)[:2], 0.0])


def _scaled(
    pose: Pose, surface: Surface, metres: float | None, unit: str | None
) -> tuple[Pose, list[str]]:
    """Return the pose in metres, and how the unit was found."""
    length = float(np.ptp(pose(surface.mesh.vertices)[:, 2]))
    if unit is not None:
        scale, said = UNITS[unit], f"the unit is {unit}, as asked"
    elif metres is not None:
        scale, said = metres, "the file says its unit"
        if metres * length < SHORTEST:
            said += f"; it is {metres * length:.3g} m long: if its millimetres are metres, --unit m"
    else:
        name = "m" if length < METRES else "mm" if length > MILLIMETRES else "cm"
        scale = UNITS[name]
        said = f"the file says no unit; a length of {length:.5g} is taken to be in {name}"
        if scale * length < SMALL <= UNITS["in"] * length:
            said += f"; were it inches, it would be {UNITS['in'] * length:.3g} m long: --unit in"
    return replace(pose, scale=scale, origin=scale * pose.origin), [said]


def _widths(pose: Pose, surface: Surface, name: str) -> Array:
    """Return the least widths of sections from end to end [m], or say what keeps it from a blade.

    Raises
    ------
    GeometryError
        If it is too short, open or crosses itself.
    """
    shares = np.linspace(0.0, 1.0, PLANES + 2)[1:-1]
    cuts, z = cuts_across(pose, surface, shares)
    solid = [cut for cut in cuts if len(cut.outline) and cut.gap < OPENED]
    if len(solid) < ENOUGH * len(cuts):
        raise GeometryError(
            f"{name}: no blade: only {len(solid)} of {len(cuts)} planes across it cut a closed "
            "outline; is the surface whole?"
        )
    if sum(any(other > 0.2 for other in cut.others) for cut in cuts) > 0.2 * len(cuts):
        raise GeometryError(
            f"{name}: no single blade: planes across it cut several outlines of similar size; "
            "leave one blade in the file"
        )
    least, most = _extents(cuts)
    length = float(z[-1] - z[0]) * (PLANES + 1) / (PLANES - 1)
    wide = max(float(most.max()), float(np.ptp(pose(surface.mesh.vertices)[:, :2], axis=0).max()))
    if length < SLENDER * wide:
        raise GeometryError(
            f"{name}: no blade: {length:.4g} m long and {wide:.4g} m wide, must be at least "
            f"{SLENDER:g} times as long as wide; leave one blade in the file"
        )
    folded = crossing_sections(np.stack([_resampled(cut.outline) for cut in solid]))
    if len(folded) > FOLDED:
        raise GeometryError(
            f"{name}: the surface crosses itself: {len(folded)} of {len(cuts)} planes across it "
            "cut outlines that do; repair it first"
        )
    crossing = sum(cut.crossing for cut in cuts)
    if crossing > ENOUGH * len(cuts):
        raise GeometryError(
            f"{name}: the mesh crosses or touches itself: {crossing} of {len(cuts)} planes meet "
            "edges of more than two triangles; repair it first"
        )
    return least


def _resampled(outline: Array) -> Array:
    """Return points (AROUND, 2) of a closed outline, evenly along it."""
    ring = np.concatenate([outline, outline[:1]])
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(ring, axis=0).T))])
    at = np.linspace(0.0, arc[-1], AROUND)
    return np.stack([np.interp(at, arc, ring[:, k]) for k in (0, 1)], axis=-1)


def _extents(cuts: list[Cut]) -> tuple[Array, Array]:
    """Return the least and the largest widths of outlines, 0 of those that are not there."""
    angle = np.linspace(0.0, np.pi, 37)[:-1]
    ways = np.stack([np.cos(angle), np.sin(angle)])
    sizes = [
        np.ptp(cut.outline @ ways, axis=0) if len(cut.outline) else np.zeros(len(angle))
        for cut in cuts
    ]
    return np.array([s.min() for s in sizes]), np.array([s.max() for s in sizes])


def _root_last(widths: Array) -> bool:
    """Tell whether the thick end is the last one."""
    count = max(1, len(widths) // 5)
    return bool(widths[-count:].mean() > widths[:count].mean())


def _turned(pose: Pose, surface: Surface) -> Pose:
    """Turn a pose half round x, its other end to z = 0."""
    high = float(pose(surface.mesh.vertices)[:, 2].max())
    return pose.then(np.diag([1.0, -1.0, -1.0]), np.array([0.0, 0.0, high]))


def _own_axes(pose: Pose, diameter: float) -> Pose | None:
    """Return the pose along the file's own axes that is nearest, None if none is near."""
    along = np.abs(pose.axes)
    z = int(np.argmax(along[:, 2]))
    if along[z, 2] < np.cos(ALIGNED):
        return None
    y = int(np.argmax(np.where(np.arange(3) == z, 0.0, along[:, 1])))
    x = 3 - y - z
    if along[y, 1] < np.cos(LEAST_TURN):
        return None
    axes = np.zeros((3, 3))
    for column, row in enumerate((x, y, z)):
        axes[row, column] = np.sign(pose.axes[row, column])
    centre = np.zeros(3) @ axes - (pose.back(np.zeros(3)) * pose.scale) @ axes
    if np.hypot(*centre[:2]) > INSIDE * diameter:
        return None
    return replace(pose, axes=axes, origin=np.array([0.0, 0.0, centre[2]]))


def _named(pose: Pose) -> str:
    names = []
    for column, name in enumerate("xyz"):
        row = int(np.argmax(np.abs(pose.axes[:, column])))
        sign = "-" if pose.axes[row, column] < 0.0 else ""
        names.append(f"{name} = {sign}{'xyz'[row]}")
    return ", ".join(names)


def _untwisted(pose: Pose, surface: Surface) -> Pose:
    """Turn a pose about z until the chord at 90 % of the span is along y."""
    cuts, _ = cuts_across(pose, surface, np.array([0.9]))
    chord = chord_of(cuts[0].outline)  # in x and y
    chord = chord * (1.0 if chord[1] > 0.0 else -1.0)
    s, c = chord
    axes = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return pose.then(axes, np.zeros(3))
