# %% [markdown]
# ## A surrogate with error bars
#
# From seven parameters to power coefficient and root bending moment: a Gaussian process, held
# against a linear model on variants that neither has seen.

# %%
import warnings

import matplotlib.pyplot as plt
import numpy as np
from sklearn.exceptions import ConvergenceWarning
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

import bladegen as bg

warnings.simplefilter("ignore", ConvergenceWarning)
family = bg.load_family("family")
train = np.concatenate([family.split("train"), family.split("validation")])
test = family.split("test")
low, high = np.array(list(family.identity["factors"].values())).T
x = 2.0 * (family.parameters - low) / (high - low) - 1.0  # -1 to 1
NAMES = {"rotor_power_coefficient": "power coefficient", "rotor_root_moment": "root moment, N m"}

# %% [markdown]
# Each parameter has its own length in the kernel. One at its bound, which scikit-learn warns of,
# says that the figure is linear in this parameter, or does not depend on it.  The root moment
# follows the tip speed ratio of the largest power, about which power is flat, with a kink where the
# largest tip speed begins to count: it is harder to learn than power, and the error bars say so.

# %%
drawn, axes = plt.subplots(1, 2, figsize=(11, 4.4), layout="constrained")
for axis, (name, title) in zip(axes, NAMES.items(), strict=True):
    y = family[name][:]
    kernel = ConstantKernel(10.0, (1e-2, 1e5)) * RBF(np.full(x.shape[1], 3.0), (0.1, 1e4))
    model = GaussianProcessRegressor(kernel + WhiteKernel(1e-4, (1e-8, 1.0)), normalize_y=True)
    model.fit(x[train], y[train])
    found, spread = model.predict(x[test], return_std=True)
    ones = np.ones(len(x))[:, None]
    slopes = np.linalg.lstsq(np.hstack([ones, x])[train], y[train], rcond=None)[0]
    linear = (np.hstack([ones, x]) @ slopes)[test]

    off = {"process": found - y[test], "linear": linear - y[test]}
    share = {k: 100 * np.sqrt(np.mean(v**2)) / np.std(y[test]) for k, v in off.items()}
    inside = 100 * np.mean(np.abs(off["process"]) < 2.0 * spread)
    print(
        f"{title}: RMS error {share['process']:.1f} % of the spread, "
        f"linear {share['linear']:.1f} %; "
        f"{inside:.0f} % of {len(test)} within two standard deviations"
    )
    axis.plot(y[test], linear, "x", color="#d55e00", label=f"linear, {share['linear']:.0f} %")
    axis.errorbar(
        y[test],
        found,
        yerr=2.0 * spread,
        fmt=".",
        color="#0072b2",
        label=f"process, {share['process']:.0f} %",
    )
    ends = [y[test].min(), y[test].max()]
    axis.plot(ends, ends, color="#22303c", linewidth=0.8)
    axis.set(xlabel="computed", ylabel="predicted", title=title)
    axis.legend(title="RMS error, of the spread")
drawn.savefig(
    "surrogate.png",
    dpi=150,
    metadata={"Title": "Power and root moment of unseen variants, predicted and computed"},
)
