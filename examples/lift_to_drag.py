"""The section at 80 % span for the most lift over drag: exact gradients, and differences.

    python examples/lift_to_drag.py [FILE.png]

SciPy's SLSQP varies four shape coordinates and the thickness.  The section stays as thick as it
was at least, and its area grows by 2 % at most.  NeuralFoil gives lift and drag at 6 degrees.
"""

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.optimize import minimize

import bladegen as bg
from bladegen.curves import polygons
from bladegen.neuralfoil import coefficients
from bladegen.views.plots import figures, style

SPAN, ALPHA, REYNOLDS = 0.8, np.radians(6.0), 9e6
BLADE, SPACE = bg.Blade.from_definition(bg.read("iea15mw")), bg.ShapeSpace.bundled()
BOUNDS = {"pga": (-0.05, 0.05), "thickness": (0.9, 1.1)}
MODEL = bg.ParametricBlade(BLADE, SPACE, ("pga", "thickness"), eta=[SPAN], bounds=BOUNDS)
AXES = BLADE.planform.frames([SPAN])[0][[1, 0]]  # of the section's plane, in space
LEAST, MOST = 1.0, 1.02  # relative thickness and area, of the baseline's
FIRST = MODEL.quantities(MODEL.baseline)
Vector = np.ndarray


def ratio(x: Vector) -> tuple[float, Vector]:
    """Return lift over drag, and its gradient (5,)."""
    found = coefficients(MODEL.sections(x) @ AXES.T, ALPHA, REYNOLDS)
    (lift, drag, _), (of_lift, of_drag, _) = found.values[0], found.in_points[0]
    in_points = of_lift / drag - of_drag * lift / drag**2
    return lift / drag, MODEL.vjp(x, (in_points @ AXES)[None])


def margins(x: Vector) -> tuple[Vector, Vector]:
    """Return what is left of both limits, and the derivatives (2, 5)."""
    found = MODEL.quantities(x)
    thickness, area = FIRST["relative_thickness"][0], FIRST["section_area"][0]
    left = [
        found["relative_thickness"][0] / thickness - LEAST,
        MOST - found["section_area"][0] / area,
    ]
    slopes = [
        found.jacobian("relative_thickness")[0] / thickness,
        -found.jacobian("section_area")[0] / area,
    ]
    return np.array(left), np.array(slopes)


def variant(x: Vector) -> Vector:
    """Return the section (n, 2) in chords as one has it without a model."""
    allowed = {"allow_odd": True, "allow_extrapolation": True}  # elsewhere along the span
    return BLADE.perturbed(SPACE, x[:4], thickness=x[4], **allowed).profiles([SPAN])[0]


def plain_ratio(x: Vector) -> float:
    """Return lift over drag of a perturbed blade."""
    lift, drag, _ = coefficients(variant(x), ALPHA, REYNOLDS).values
    return float(lift / drag)


def plain_margins(x: Vector) -> Vector:
    """Return what is left of both limits, of a perturbed blade."""
    area = polygons.measure(variant(x))[0] * FIRST["chord"][0] ** 2
    return np.array([x[4] - LEAST, MOST - area / FIRST["section_area"][0]])


def solved(value: Callable, limits: dict, exact: bool) -> tuple[Vector, list, float]:
    """Maximise from the baseline: the vector, the value of each evaluation, and the seconds."""
    history: list[float] = []

    def less(x: Vector) -> float | tuple[float, Vector]:
        found, slope = value(x) if exact else (value(x), None)
        history.append(found)
        return (-found / 100.0, -slope / 100.0) if exact else -found / 100.0

    start = time.perf_counter()
    done = minimize(
        less,
        MODEL.baseline,
        jac=exact,
        bounds=list(zip(MODEL.lower, MODEL.upper, strict=True)),
        constraints=[{"type": "ineq"} | limits],
        method="SLSQP",
        options={"ftol": 1e-10},
    )
    return done.x, history, time.perf_counter() - start


def main(target: Path) -> None:
    """Solve in both ways; draw the sections and the ways there."""
    limits = {"fun": lambda x: margins(x)[0], "jac": lambda x: margins(x)[1]}
    for value in (ratio, margins, plain_ratio):
        value(MODEL.baseline)  # nothing is timed that is done once
    exact = solved(ratio, limits, True)
    differences = solved(plain_ratio, {"fun": plain_margins}, False)

    drawn, ((left, right),) = figures.figure(1, 2, width=11, height=3.6)
    for x, colour, label in (
        (MODEL.baseline, style.BASELINE, f"baseline, {exact[1][0]:.0f}"),
        (exact[0], style.VARIANT, f"best, {exact[1][-1]:.0f}"),
    ):
        left.plot(*variant(x).T, color=colour, label=label)
    left.set(aspect="equal", ylim=(-0.12, 0.32), xlabel="chords", title="lift over drag at 6°")
    left.legend(loc="upper right")
    for (_, history, _), colour, label in (
        (differences, style.CATEGORIES[3], "differences"),
        (exact, style.VARIANT, "exact gradients"),
    ):
        steps = np.arange(1, len(history) + 1)
        right.plot(steps, history, ".-", color=colour, label=f"{label}: {len(history)}")
    right.set(xlabel="evaluation", ylabel="lift over drag", title="SLSQP, evaluations")
    right.legend(loc="lower right")
    figures.save_figure(drawn, target)
    (x, ways, seconds), (other, more, longer) = exact, differences
    print(
        f"wrote {target}; lift over drag {ways[0]:.1f} to {ways[-1]:.1f} in {len(ways)} steps "
        f"({seconds:.2f} s), by differences {more[-1]:.1f} in {len(more)} ({longer:.2f} s); ends "
        f"lie {np.abs(x - other).max():.1e} apart; {MODEL.faults(x)[0] or 'sound'}"
    )


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "lift_to_drag.png"))
