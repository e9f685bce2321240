# %% [markdown]
# ## Inverse design
#
# The variant with the most power has another lift than the baseline, and another thickness. Which
# blade has its lift at the baseline's thickness? A blade as a function of its parameters, with
# NeuralFoil on its sections, has exact derivatives: least squares find it in a few steps.

# %%
import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import least_squares

import bladegen as bg
from bladegen.neuralfoil import coefficients

ALPHA, REYNOLDS, SPANS = np.radians(5.0), 1e7, np.linspace(0.35, 0.97, 12)
family, space = bg.load_family("family"), bg.ShapeSpace.bundled()
blade = bg.Blade.from_definition(bg.read("iea15mw"), landmarks=101)
axes = blade.planform.frames(SPANS)[:, [1, 0]]  # (k, 2, 3), of the sections' planes, in space


def lift(sections):
    """Return lift coefficients (k,) of sections (k, n, 3), and derivatives (k, n, 3)."""
    found = coefficients(np.einsum("knx,kix->kni", sections, axes), ALPHA, REYNOLDS)
    return found.values[:, 0], np.einsum("kni,kix->knx", found.in_points[:, 0], axes)


# %% [markdown]
# What is asked for: that lift within 0.01, the thickness within 0.002, and of all blades that have
# both the one whose parameters change least. What may change: the four shape coordinates at four
# spans each, and the thickness.

# %%
best = family[int(np.nanargmax(family["rotor_power_coefficient"][:]))]
wanted, _ = lift(best.sections(SPANS)[:, ::4])
kinds = (("pga", [0.4, 0.6, 0.8, 0.95]), "thickness")
model = bg.ParametricBlade(blade, space, kinds, SPANS)
thickness = model.quantities(model.baseline)["relative_thickness"]


reach = 0.5 * (model.upper - model.lower)


def residuals(x):
    """Return how far lift, thickness and parameters are off (2k + p,), in what is allowed."""
    off = model.quantities(x)["relative_thickness"] - thickness
    change = (x - model.baseline) / reach
    return np.concatenate([(lift(model.sections(x))[0] - wanted) / 0.01, off / 0.002, change])


def slopes(x):
    """Return the derivatives of the residuals (2k + p, p), exact."""
    of_lift = np.einsum("knx,knxp->kp", lift(model.sections(x))[1], model.jacobian(x))
    of_thickness = model.quantities(x).jacobian("relative_thickness")
    return np.vstack([of_lift / 0.01, of_thickness / 0.002, np.diag(1.0 / reach)])


bounds, how = (model.lower, model.upper), {"method": "dogbox", "ftol": 1e-5}
found = least_squares(residuals, model.baseline, slopes, bounds, x_scale=reach, **how)
vectors = {"baseline": model.baseline, "found": found.x}
lifts = {name: lift(model.sections(x))[0] for name, x in vectors.items()}
for name, value in lifts.items():
    print(f"{name}: lift is off by {np.abs(value - wanted).max():.4f} at most")
print(f"{found.nfev} evaluations; the blade is {model.faults(found.x)[0] or 'sound'}")

# %%
drawn, (left, right) = plt.subplots(1, 2, figsize=(11, 3.8), layout="constrained")
left.plot(SPANS, wanted, "o", color="#22303c", label="asked for", fillstyle="none")
for (name, value), colour in zip(lifts.items(), ("#d55e00", "#0072b2"), strict=True):
    left.plot(SPANS, value, color=colour, label=name)
left.set(xlabel="span fraction", title="lift coefficient at 5°")
left.legend()
sections = [np.einsum("knx,kix->kni", model.sections(x), axes) for x in vectors.values()]
before, after = (
    (flat - flat[:, 50:51]) / np.linalg.norm(flat[:, :1] - flat[:, 50:51], axis=-1, keepdims=True)
    for flat in sections
)
for row, colour in zip((1, 6, 10), ("#cc79a7", "#009e73", "#e69f00"), strict=True):
    off = 100.0 * (after[row, :, 1] - before[row, :, 1])
    right.plot(before[row, :51, 0], off[:51], color=colour, label=f"{100 * SPANS[row]:.0f} % span")
    right.plot(before[row, 50:, 0], off[50:], color=colour, linestyle="dashed")
right.set(xlabel="chords", title="change of sections, % chord (dashed: pressure side)")
right.legend()
drawn.savefig(
    "inverse.png",
    dpi=150,
    metadata={"Title": "Lift over span asked for and found, and how the sections change"},
)
