"""Measuring what was made: blades against their definitions, solids and meshes from any file.

Every figure is measured on the thing itself, never assumed from how it was made.  Lengths
are metres, volumes m3; STEP files state their unit, mesh files do not and are taken as they are.
"""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.airfoils.chord_lines import ChordLines
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.blade.blade import Blade
from bladegen.blade.edges import MinimumThickness
from bladegen.curves import polygons
from bladegen.curves.crossing import crossing_sections
from bladegen.errors import Finding
from bladegen.measures import foreign, inflections, properties, smoothness, spanwise
from bladegen.measures.fairness import fairness
from bladegen.measures.file_figures import mesh_figures, solid_figures
from bladegen.shapes import affine
from bladegen.support.arrays import Array

__all__ = ["Check", "check_blade", "check_file", "mesh_figures", "solid_figures"]

SPANS = 200  # spans at which a blade is held against its definition
ADDED = 0.01  # of the volume: what the finish of trailing edges may add without a finding
DIGITS = 4  # of a list of creases
SAME = 1e-9  # relative, of thicknesses that differ by rounding


@dataclass(frozen=True)
class Check:
    """What was measured on a file or blade, and what is wrong with it.

    Parameters
    ----------
    source : str
        What was checked.
    kind : str
        "solid", "mesh", "grid" or "blade".
    figures : dict
        Measured figures by name; units stand in the names.
    problems : tuple of str
        What keeps it from being usable; none if all is well.
    """

    source: str
    kind: str
    figures: dict[str, Any]
    problems: tuple[str, ...] = ()


def check_file(path: Path) -> Check:
    """Measure a CAD file, a mesh or a structured grid that anyone made.

    Raises
    ------
    FileError
        If it cannot be read or is of no known format.
    """
    kind = foreign.kind_of(path)
    figures = foreign.ask("figures", path).facts
    wanted = _NEEDS[kind]
    problems = [message for key, message in wanted if not figures[key]]
    odd = [key for key, value in figures.items() if not _finite(value)]
    problems += [f"its {key.rpartition('_')[0] or key} is no finite number" for key in odd]
    if kind == "solid" and "volume_m3" not in odd and figures["closed"]:
        problems += ["encloses no volume"] if figures["volume_m3"] <= 0 else []
    return Check(str(path), kind, figures | dict.fromkeys(odd), tuple(problems))


def _finite(value: Any) -> bool:
    """Tell whether all numbers of a figure are finite."""
    if isinstance(value, list):
        return all(_finite(member) for member in value)
    return not isinstance(value, float) or math.isfinite(value)


def check_blade(blade: Blade) -> Check:
    """Hold a blade against its own definition, and look for sections that cross themselves.

    A mirror image is as good as what it is the image of.
    """
    if blade.mirrored:
        return check_blade(blade.mirror_image())
    eta = np.unique(np.concatenate([np.linspace(0.0, 1.0, SPANS), blade.eta]))
    profiles = blade.profiles(eta)
    curves = SectionSplines(blade.u).fit(profiles)
    thickness = blade.wanted_thickness(eta)
    finished = blade.trailing_edge(profiles, blade.chord(eta))
    built = SectionSplines(blade.u).fit(finished)
    added = _added(blade, eta, profiles, finished)
    layup = blade.layup
    figures: dict[str, Any] = {
        "stations": len(blade.eta),
        "landmarks": len(blade.u),
        "length_m": blade.length,
        "volume_m3": properties.volume(blade),
        "stations_missed_by_chord": float(_missed(blade).max()),
        "chord_error_relative": float(np.abs(curves.chord - 1.0).max()),
        "twist_error_deg": float(np.degrees(np.abs(_twist_error(blade, eta)).max())),
        "thickness_error": None
        if thickness is None
        else float(np.abs(built.relative_thickness - thickness).max()),
        "edge_adds_volume": added,
        "airfoils_moved_by_chord": max((c.moved for c in blade.contours or ()), default=0.0),
        **_smoothness(blade),
        **({} if layup is None else {"structure_mass_kg": layup.mass}),
        "findings": [
            str(finding)
            for finding in (
                *blade.findings,
                *_thickened(blade, added),
                *_wiggles(blade),
                *(() if layup is None else layup.findings),
            )
        ],
    }
    problems = [
        f"section at eta = {eta[k]:.4f} crosses itself" for k in crossing_sections(finished)
    ]
    figures["sections_crossing"] = len(problems)
    return Check(blade.definition.source or blade.name, "blade", figures, tuple(problems))


def _added(blade: Blade, eta: Array, profiles: Array, finished: Array) -> float:
    """Return what finishing the trailing edges adds to the volume, of the volume as given."""
    chord = blade.chord(eta)[:, None, None]
    before, after = (
        np.trapezoid(polygons.measure(points * chord)[:, 0], eta) for points in (profiles, finished)
    )
    return float(after / before - 1.0)


def _thickened(blade: Blade, added: float) -> list[Finding]:
    """Return what trailing edges change that a designer would not expect."""
    said, rule = [], blade.trailing_edge
    if isinstance(rule, MinimumThickness):
        eta = np.linspace(0.0, 1.0, SPANS)
        chord = blade.chord(eta)
        thickness = rule.width(chord) * chord
        least = int(np.argmin(thickness))
        if thickness[least] < rule.thickness * (1.0 - SAME):
            said.append(
                f"at least {1e3 * thickness[least]:.3g} mm thick at eta = {eta[least]:.3f}, where "
                f"{1e3 * rule.thickness:g} mm would be more than {100 * (rule.most or 0):g} % of "
                f"the chord; --trailing-edge {1e3 * rule.thickness:g}mm makes it so all over"
            )
    if abs(added) > ADDED:
        verb = "adds" if added > 0 else "takes"
        said.append(
            f"its finish ({rule}) {verb} {100 * abs(added):.1f} % of the volume; "
            "--trailing-edge given leaves edges as they are"
        )
    return [Finding("trailing edge", text) for text in said]


def _smoothness(blade: Blade) -> dict[str, Any]:
    fair = fairness(blade)
    worst = max(fair.creases, key=lambda pair: pair[1], default=None)
    jump, at = fair.jump
    return {
        "crease_deg": 0.0 if worst is None else float(np.degrees(worst[1])),
        "crease_at_eta": None if worst is None else worst[0],
        "creases_deg": [
            [round(eta, DIGITS), round(float(np.degrees(angle)), DIGITS)]
            for eta, angle in fair.creases
        ],
        "curvature_jump_per_m": jump,
        "curvature_jump_at_eta": at,
        "spanwise_curvature_varies_per_m": fair.spanwise,
        "chordwise_curvature_varies": fair.chordwise,
    }


def _wiggles(blade: Blade) -> list[Finding]:
    """Return what the surface does over span that the definition does not."""
    bulges = [
        Finding(
            f"eta = {eta:.4f}",
            f"the trailing edge's width leaves that of the stations beside it by "
            f"{100 * excess:.2f} % of the chord",
        )
        for eta, excess in smoothness.edge_bulges(blade)
    ]
    sliver = 100.0 / (smoothness.FINE - 1)
    breaks = [
        Finding(
            f"eta = {eta:.4f}",
            f"sections change by {100 * change:.2f} % of the chord on {sliver:g} % of the span, "
            f"{times:.0f} times as much as beside it: the surface has a step there, as where two "
            "noses compete to be the leading edge",
        )
        for eta, change, times in smoothness.steps(blade)
    ]
    bends = [
        Finding(
            f"eta = {found.eta:.4f}",
            f"{found.quantity} has an inflection over span that the definition has not, "
            f"{100 * found.depth:.2f} % of the chord deep",
        )
        for found in inflections.inflections(blade)
    ]
    return breaks + bulges + bends


def _missed(blade: Blade) -> Array:
    """Return how far a blade is from its stations' airfoils, up to a stretch [chord].

    Perturbed airfoils are brought to the blade's chord lines first.
    """
    splines = SectionSplines(blade.u)
    airfoils = affine.restore(blade.points, blade.M, blade.b)
    profiles = blade.profiles(blade.eta)
    if blade.wanted_thickness(blade.eta) is None:
        wanted = None
    else:
        wanted = splines.fit(profiles).relative_thickness
    curves = splines.fit(airfoils)
    A, c = curves.normalising(wanted)
    if blade.deformations:  # its place in the plane is held against the twist
        lines = ChordLines.of(splines.fit(profiles))
        A, c = ChordLines.of(curves.mapped(A, c)).onto(lines).after(A, c)
    missed: Array = np.abs(affine.restore(airfoils, A, c) - profiles).max(axis=(1, 2))
    return missed


def _twist_error(blade: Blade, eta: Array) -> Array:
    """Return the twist of the sections that are written, less the definition's [rad]."""
    error: Array = spanwise.built(blade, eta)[1] - blade.twist(eta)
    return error


_NEEDS = {
    "solid": (
        ("one_solid", "must be one solid"),
        ("valid", "OCCT finds the shape invalid"),
        ("closed", "is not closed"),
    ),
    "mesh": (
        ("watertight", "is not watertight"),
        ("outward", "does not face outward throughout"),
        ("no_degenerate_triangle", "has degenerate triangles"),
    ),
    "grid": (("no_folded_cell", "has folded cells"),),
}
