# %% [markdown]
# ## Many objectives
#
# More energy, less root bending moment, less mass: more of one costs another. Optuna's NSGA-II
# (`pip install 'bladegen[optuna]'`) looks for the front: blades that no other beats in everything.
# It begins with the best of the family; each generation is a small family of its own.

# %%
import matplotlib.pyplot as plt
import numpy as np
import optuna

import bladegen as bg
from bladegen.blade.variants.designs import tabulated
from bladegen.families.labels.labelling import Labelling

family, space = bg.load_family("family"), bg.ShapeSpace.bundled()
blade = bg.Blade.from_definition(bg.read("iea15mw"))
GENERATIONS, SIZE = (12, 40) if len(family) >= 100 else (2, 6)
OBJECTIVES = {"rotor_annual_energy": 1.0, "rotor_root_moment": -1.0, "mass": -1.0}
SIGNS = np.array(list(OBJECTIVES.values()))


def undominated(values):
    """Tell which rows (n, 3), the more the better, no other is better than in everything."""
    better = np.all(values[:, None] >= values, axis=-1) & np.any(values[:, None] > values, axis=-1)
    return ~better.any(axis=0)


def evaluated(x):
    """Return the objectives (n, 3) of parameters (n, p); NaN for blades that are not sound."""
    design = tabulated(space, dict(zip(family.factors, x.T, strict=True)))
    planned = bg.family(blade, space, design=design, invalid="keep", spans=50)
    labels = Labelling(planned, ("rotor", "mass")).computed(planned.block(np.arange(len(x))))
    return np.stack([labels[name] for name in OBJECTIVES], axis=-1)


# %% [markdown]
# The family's own front is where the search begins.

# %%
known = np.stack([family[name][:] for name in OBJECTIVES], axis=-1)[family.valid]
first = undominated(SIGNS * known)
optuna.logging.set_verbosity(optuna.logging.WARNING)
study = optuna.create_study(
    directions=["maximize", "minimize", "minimize"],
    sampler=optuna.samplers.NSGAIISampler(population_size=SIZE, seed=1),
)
low, high = family.parameters.min(axis=0), family.parameters.max(axis=0)
bounds = {
    name: optuna.distributions.FloatDistribution(*ends)
    for name, *ends in zip(family.factors, low.tolist(), high.tolist(), strict=True)
}
for x in family.parameters[family.valid][first][:SIZE]:
    study.enqueue_trial(dict(zip(family.factors, x.tolist(), strict=True)))
for _ in range(GENERATIONS):
    trials = [study.ask(bounds) for _ in range(SIZE)]
    x = np.array([[trial.params[name] for name in family.factors] for trial in trials])
    for trial, values in zip(trials, evaluated(x), strict=True):
        if np.isfinite(values).all():
            study.tell(trial, values.tolist())
        else:
            study.tell(trial, state=optuna.trial.TrialState.FAIL)

front = np.array([trial.values for trial in study.best_trials])
both = undominated(SIGNS * np.vstack([known[first], front]))
beaten = int(np.count_nonzero(~both[: first.sum()]))
print(f"{GENERATIONS * SIZE} blades evaluated, {len(front)} of all lie in the front")
print(f"it beats {beaten} of the {first.sum()} best of the family in everything")

# %%
drawn, axes = plt.subplots(1, 2, figsize=(11, 4.2), layout="constrained")
for axis, column, scale, title in (
    (axes[0], 1, 1e-6, "root bending moment, MN m"),
    (axes[1], 2, 1e-3, "mass of the layers, t"),
):
    axis.plot(scale * known[:, column], known[:, 0], ".", color="#c9d1d9", label="family")
    axis.plot(scale * known[first, column], known[first, 0], ".", color="#d55e00", label="its best")
    axis.plot(scale * front[:, column], front[:, 0], ".", color="#0072b2", label="front")
    axis.set(xlabel=title, ylabel="energy of a year, GWh")
axes[0].legend()
drawn.savefig(
    "front.png",
    dpi=150,
    metadata={"Title": "Energy over root moment and over mass: the family and the front"},
)
