"""What the examples of optimisation say of themselves: derivatives, optima, covariance."""

import runpy
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bladegen as bg

EXAMPLES = Path(bg.__file__).parent.parent / "examples"


def example(name):
    return runpy.run_path(str(EXAMPLES / f"{name}.py"))


def along(f, x, way, step):
    """The derivative of f at x along a direction, by differences of fourth order."""
    far, near = (f(x + s * step * way) - f(x - s * step * way) for s in (2, 1))
    return (8.0 * near - far) / (12.0 * step)


def test_lift_over_drag_has_exact_gradients_and_the_optimum_of_differences():
    made = example("lift_to_drag")
    model, rng = made["MODEL"], np.random.default_rng(2)
    x = model.baseline + 0.2 * (model.upper - model.lower) * rng.uniform(-1, 1, 5)
    way = rng.normal(size=5)
    for name in ("ratio", "margins"):
        moved = along(lambda x, f=made[name]: np.asarray(f(x)[0]), x, way, 1e-4)
        assert_allclose(made[name](x)[1] @ way, moved, rtol=1e-6, atol=1e-8)
    assert made["ratio"](x)[0] == pytest.approx(made["plain_ratio"](x), rel=1e-9)
    assert_allclose(made["margins"](x)[0], made["plain_margins"](x), atol=1e-9)
    limits = {"fun": lambda x: made["margins"](x)[0], "jac": lambda x: made["margins"](x)[1]}
    best, values, _ = made["solved"](made["ratio"], limits, True)
    other, more, _ = made["solved"](made["plain_ratio"], {"fun": made["plain_margins"]}, False)
    assert_allclose(best, other, atol=1e-4)
    assert len(more) > 3 * len(values)
    assert values[-1] > 1.15 * values[0]
    assert made["margins"](best)[0].min() > -1e-8
    assert model.valid(best)


def test_the_power_of_a_rotor_has_exact_totals():
    problem = example("rotor_power")["problem"]()
    problem.run_model()
    x, rng = problem["x"].copy(), np.random.default_rng(3)
    assert 0.4 < problem["power"].item() < 16 / 27
    way, of = rng.normal(size=len(x)), ["power", "volume", "relative_thickness"]
    totals = problem.compute_totals(of, ["x"], return_format="array")

    def run(x):
        problem["x"] = x
        problem.run_model()
        return np.concatenate([problem[name] for name in of])

    assert_allclose(totals @ way, along(run, x, way, 1e-4), rtol=1e-6, atol=1e-8)


def test_a_fit_finds_the_truth_within_its_covariance():
    made = example("fit_parameters")
    model = made["MODEL"]
    truth = model.baseline + 0.1 * (model.upper - model.lower)
    points, x = made["measured"](truth), model.baseline
    for _ in range(10):
        apart, slopes = made["residuals"](x, points)
        x = x - np.linalg.lstsq(slopes, apart, rcond=None)[0]
    spread = made["NOISE"] * np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes)))
    assert np.sqrt(np.mean(apart**2)) == pytest.approx(made["NOISE"], rel=0.05)
    assert (np.abs(x - truth) < 4.0 * spread).all()
    assert np.sum(((x - truth) / spread) ** 2) > 1.0  # nor is it far too large
