"""Which parameters a measured blade has: Gauss-Newton on points of its surface, with covariance.

    python examples/fit_parameters.py [FILE.png]

The points are those of a variant at random places around 25 sections, 2 mm of noise added.  Where
around a section a point lies is not known: it is held against the tangent at the nearest landmark.
"""

import sys
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

import bladegen as bg
from bladegen.views.plots import figures, style

NOISE, POINTS, SEED, STEPS = 2e-3, 120, 3, 12  # m, points a section
SPANS = np.linspace(0.3, 0.98, 25)
KINDS = (("pga", [0.4, 0.9]), "thickness", "chord", "twist")
MODEL = bg.ParametricBlade(
    bg.Blade.from_definition(bg.read("iea15mw")), bg.ShapeSpace.bundled(), KINDS, SPANS
)


def measured(truth: np.ndarray) -> np.ndarray:
    """Return noisy points (25, 120, 3) between landmarks of a variant."""
    rng = np.random.default_rng(SEED)
    sections = MODEL.sections(truth)
    place = rng.uniform(5, sections.shape[1] - 6, size=(len(SPANS), POINTS))
    low, share = place.astype(int), (place % 1.0)[..., None]
    rows = np.arange(len(SPANS))[:, None]
    points = (1.0 - share) * sections[rows, low] + share * sections[rows, low + 1]
    normals = normals_of(sections)[rows, low]
    return points + NOISE * rng.normal(size=(*low.shape, 1)) * normals


def normals_of(sections: np.ndarray) -> np.ndarray:
    """Return unit normals (k, n, 3) of sections in their planes."""
    along = np.gradient(sections, axis=1)
    planes = MODEL.blade.planform.frames(SPANS)[:, None, 2]
    normals = np.cross(planes, along)
    return normals / np.linalg.norm(normals, axis=-1, keepdims=True)


def residuals(x: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the points' distances (m,) from the surface [m], and the derivatives (m, p)."""
    sections, slopes = MODEL.sections(x), MODEL.jacobian(x)
    normals = normals_of(sections)
    apart, rows = [], []
    for section, normal, slope, given in zip(sections, normals, slopes, points, strict=True):
        near = cKDTree(section).query(given)[1]
        apart.append(np.sum(normal[near] * (given - section[near]), axis=-1))
        rows.append(-np.einsum("mi,mip->mp", normal[near], slope[near]))
    return np.concatenate(apart), np.concatenate(rows)


def main(target: Path) -> None:
    """Fit, and draw each parameter's error beside its standard deviation."""
    rng = np.random.default_rng(SEED)
    reach = 0.25 * (MODEL.upper - MODEL.lower)
    truth = MODEL.baseline + reach * rng.uniform(-1.0, 1.0, len(MODEL.names))
    points, x, history = measured(truth), MODEL.baseline, []
    for _ in range(STEPS):
        apart, slopes = residuals(x, points)
        history.append(np.sqrt(np.mean(apart**2)))
        step = -np.linalg.lstsq(slopes, apart, rcond=None)[0]
        x = x + step
        if np.abs(step).max() < 1e-8:
            break
    apart, slopes = residuals(x, points)
    free = len(apart) - len(x)
    variance = apart @ apart / free
    spread = np.sqrt(variance * np.diag(np.linalg.inv(slopes.T @ slopes)))

    drawn, ((left, right),) = figures.figure(1, 2, width=11, height=3.8)
    left.semilogy(1e3 * np.array(history), ".-", color=style.VARIANT)
    left.axhline(1e3 * NOISE, color=style.BASELINE, label="noise")
    left.set(xlabel="step", ylabel="RMS distance, mm", title="Gauss-Newton")
    left.legend()
    places = np.arange(len(x))
    right.errorbar(
        (x - truth) / reach, places, xerr=2.0 * spread / reach, fmt="o", color=style.VARIANT
    )
    right.axvline(0.0, color=style.BASELINE)
    right.set(yticks=places, yticklabels=MODEL.names, title="found less true")
    right.set_xlabel("share of the largest change; bars: two standard deviations")
    figures.save_figure(drawn, target)
    print(
        f"wrote {target}; RMS {1e3 * history[0]:.1f} to {1e3 * np.sqrt(variance):.2f} mm in "
        f"{len(history)} steps; errors up to {np.max(np.abs(x - truth) / spread):.1f} standard "
        "deviations"
    )


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "fit_parameters.png"))
