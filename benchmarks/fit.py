"""Blades fitted to their own files: what comes back of surface, chord, twist and prebend.

    python benchmarks/fit.py [--quick]

Each blade, and variants of it, is written as STEP (1 mm) and as STL (300 sections), fitted at 1 mm
and held against the blade that it was written from: distances of the file's points, and chord
lines of both blades outside of the round root.  Where sections are thicker than 45 % of the chord
the direction of a chord line is vague; the rows say both.

Then clouds: 200,000 points of the IEA 15 MW blade's surface with normal noise of 1 and 5 mm, a
fifth of them missing in balls of 1.2 m radius, and 5 million points, with time and memory.
"""

import tempfile
from pathlib import Path

import numpy as np
from figures import asked, figure

import bladegen as bg
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.measures import distances, surfaces

SPANS = np.linspace(0.03, 0.995, 194)
CLEAR = 0.45  # of the chord


def chord_lines(blade, eta):
    """Chord [m], twist [deg] and the x of chord lines at y = 0 [m], from dense sections."""
    curves = SectionSplines(blade.u).fit(blade.profiles(eta))
    away = curves.trailing_edge - curves.leading_edge
    turn = np.arctan2(away[:, 1], away[:, 0])
    chord, twist = blade.chord(eta), blade.twist(eta)
    lead = chord[:, None] * curves.leading_edge
    lead = lead - np.stack([blade.definition.offset_y(eta), -blade.definition.offset_x(eta)], -1)
    y = lead[:, 0] * np.cos(twist) - lead[:, 1] * np.sin(twist)
    x = lead[:, 1] * np.cos(twist) + lead[:, 0] * np.sin(twist)
    crossing = x - y * np.tan(twist + turn)
    return curves.chord * chord, np.degrees(twist + turn), blade.axis(eta)[:, 0] + crossing


def compared(case, blade, path):
    fitted = bg.fit(path, tolerance=1e-3)
    off = 1e3 * np.abs(fitted.residuals)
    figure("fit: 99 % of the file's points", case, "mm", float(np.percentile(off, 99)))
    figure("fit: all of them", case, "mm", float(off.max()))
    figure("fit: stations", case, "", float(len(fitted.definition.stations)))
    thickness = blade.relative_thickness(SPANS)
    made, given = chord_lines(fitted.blade, SPANS), chord_lines(blade, SPANS)
    for what, rows in (("", thickness < 0.99), (", clear chord lines", thickness < CLEAR)):
        for name, unit, size, one, other in zip(
            ("chord", "twist", "prebend"), ("mm", "deg", "mm"), (1e3, 1.0, 1e3), made, given,
            strict=True,
        ):  # fmt: skip
            worst = float(size * np.abs(one - other)[rows].max())
            figure(f"fit: {name}, largest error{what}", case, unit, worst)


def scanned(blade, count, noise, missing):
    """Points of a blade's surface, with noise [m] and a share that is missing in balls."""
    import trimesh

    rng = np.random.default_rng(11)
    mesh = blade.mesh()
    points, _ = trimesh.sample.sample_surface(mesh, int(count / (1.0 - missing)), seed=3)
    points = points + noise * rng.normal(size=points.shape)
    whole = len(points)
    while len(points) > count:
        centre = points[rng.integers(len(points))]
        points = points[np.linalg.norm(points - centre, axis=1) > 1.2]
    return points, 1.0 - len(points) / whole


def clouds(quick):
    import resource
    import time

    blade = bg.Blade.from_definition(bg.read("iea15mw"))
    runs = [(200_000, 1e-3, 0.2), (200_000, 5e-3, 0.2), (200_000, 1e-3, 0.0)]
    for count, noise, missing in runs[:1] if quick else [*runs, (5_000_000, 1e-3, 0.0)]:
        points, gone = scanned(blade, count, noise, missing)
        start = time.perf_counter()
        fitted = bg.fit(np.asarray(points), tolerance=0.01)
        spent = time.perf_counter() - start
        case = f"{count:,} points, {1e3 * noise:g} mm, {100 * gone:.0f} % missing"
        figure("cloud: time", case, "s", spent)
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
        figure("cloud: memory of the process", case, "GB", peak)
        figure("cloud: noise found", case, "mm", 1e3 * fitted.noise)
        eta = np.linspace(0.001, 0.999, 300)
        section = fitted.blade.sections(eta).reshape(-1, 3)[::7]
        off = 1e3 * distances.signed(section, surfaces.of_blade(blade))
        for share in (50, 95, 99):
            figure(
                f"cloud: {share} % of the blade", case, "mm", float(np.percentile(abs(off), share))
            )
        made, given = chord_lines(fitted.blade, SPANS), chord_lines(blade, SPANS)
        clear = blade.relative_thickness(SPANS) < CLEAR
        for name, unit, size, one, other in zip(
            ("chord", "twist", "prebend"), ("mm", "deg", "mm"), (1e3, 1.0, 1e3), made, given,
            strict=True,
        ):  # fmt: skip
            error = size * np.abs(one - other)[clear & (SPANS < 0.98)]
            figure(f"cloud: {name}, RMS error", case, unit, float(np.sqrt(np.mean(error**2))))
            figure(f"cloud: {name}, largest error", case, unit, float(error.max()))


def main() -> None:
    quick = asked(__doc__).quick
    space = bg.ShapeSpace.bundled()
    rng = np.random.default_rng(7)
    with tempfile.TemporaryDirectory() as folder:
        for name in ("nrel5mw",) if quick else ("iea15mw", "dtu10mw", "nrel5mw"):
            base = bg.Blade.from_definition(bg.read(name))
            blades = {name: base}
            for k in range(0 if quick else 2):
                blades[f"{name}, variant {k + 1}"] = base.perturbed(
                    space,
                    0.3 * space.sample(1, rng)[0],
                    thickness=rng.uniform(0.95, 1.05),
                    chord=rng.uniform(0.95, 1.05),
                    twist=np.radians(rng.uniform(-1.0, 1.0)),
                    prebend_scale=rng.uniform(0.8, 1.2),
                    allow_odd=True,
                )
            for case, blade in blades.items():
                for suffix in ("stl",) if quick else ("step", "stl"):
                    path = Path(folder) / f"one.{suffix}"
                    how = {"tolerance": 1e-3} if suffix == "step" else {}
                    bg.export(blade, path, **how)
                    compared(f"{case}, {suffix.upper()}", blade, path)
    clouds(quick)


if __name__ == "__main__":
    main()
