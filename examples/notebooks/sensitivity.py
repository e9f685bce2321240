# %% [markdown]
# ## What power is sensitive to
#
# An active subspace: the directions among the parameters along which power changes most on
# average. They are the eigenvectors of the mean of gradient times gradient (P. G. Constantine,
# Active Subspaces, SIAM, 2015). The gradients are those of a Gaussian process on the family.

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
low, high = np.array(list(family.identity["factors"].values())).T
x = (2.0 * (family.parameters - low) / (high - low) - 1.0)[family.valid]  # -1 to 1
y = family["rotor_power_coefficient"][:][family.valid]
kernel = ConstantKernel(10.0, (1e-2, 1e5)) * RBF(np.full(x.shape[1], 3.0), (0.1, 1e4))
model = GaussianProcessRegressor(kernel + WhiteKernel(1e-4, (1e-8, 1.0)), normalize_y=True).fit(
    x, y
)

# %%
signal = model.kernel_.k1
lengths = signal.k2.length_scale
weights = signal(x) * model.alpha_ * np.std(y)  # (n, n)
gradients = (weights @ x - weights.sum(axis=1)[:, None] * x) / lengths**2


def spectrum(gradients):
    """Return eigenvalues (p,), largest first, and eigenvectors (p, p) of the mean product."""
    values, vectors = np.linalg.eigh(gradients.T @ gradients / len(gradients))
    return values[::-1], vectors[:, ::-1]


rng = np.random.default_rng(1)
values, vectors = spectrum(gradients)
again = [spectrum(gradients[rng.integers(0, len(x), len(x))])[0] for _ in range(200)]
lowest, highest = np.percentile(again, [2.5, 97.5], axis=0)
first = vectors[:, 0] * np.sign(vectors[np.argmax(np.abs(vectors[:, 0])), 0])
shares = 100 * values / values.sum()
print(f"of the gradients' square: first direction {shares[0]:.0f} %, second {shares[1]:.0f} %")
for name, weight in zip(family.factors, first, strict=True):
    print(f"{name:>10} {weight:+.2f}")

# %%
drawn, (left, middle, right) = plt.subplots(1, 3, figsize=(13, 3.8), layout="constrained")
order = np.arange(1, len(values) + 1)
left.fill_between(order, lowest, highest, color="#0072b2", alpha=0.25, linewidth=0)
left.semilogy(order, values, "o-", color="#0072b2")
left.set(xlabel="direction", title="eigenvalues, 95 % of resamples")
middle.barh(family.factors, first, color="#0072b2")
middle.axvline(0.0, color="#22303c", linewidth=0.8)
middle.invert_yaxis()
middle.set(title="first direction, parameters from -1 to 1")
right.plot(x @ first, y, ".", color="#0072b2", markersize=4)
right.set(xlabel="along the first direction", title="power coefficient")
drawn.savefig(
    "sensitivity.png",
    dpi=150,
    metadata={"Title": "Eigenvalues, the first direction, and power along it"},
)
