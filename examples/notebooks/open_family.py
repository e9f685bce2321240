# %% [markdown]
# ## Open a family, look, split
#
# The family that all notebooks read is made by one command, in the folder that they run in:
#
# ```sh
# bladegen family iea15mw -o family/ --count 400 --seed 7 --reach 0.5 --spans 50 --jobs 2 \
#   --vary thickness=0.95:1.05 --vary chord=0.95:1.05 --vary twist=-2:2 --label rotor,mass
# ```
#
# It is one dataset: sections, what was varied, properties over span, and labels.

# %%
import matplotlib.pyplot as plt
import numpy as np

import bladegen as bg

family = bg.load_family("family")
print(family, family.factors)
print(family["sections"].shape, "variants, spans, landmarks, xyz [m]")

# %% [markdown]
# `xarray.open_zarr("family/sections.zarr")` opens the same. Conditions find variants, and each
# variant is a blade:

# %%
light = family.where("mass < 68000 and rotor_power_coefficient > 0.48")
print(f"{len(light)} of {len(family)} are light and take more than 48 % of the wind's power")
best = int(np.nanargmax(family["rotor_power_coefficient"][:]))
print(f"variant {best} takes the most: {family[best]}")

# %% [markdown]
# The split is a part of the family: it is by seed and place, so that a larger family keeps it.

# %%
parts = {part: family.split(part) for part in ("train", "validation", "test")}
print({part: len(places) for part, places in parts.items()})

drawn, (left, right) = plt.subplots(1, 2, figsize=(11, 3.8), layout="constrained")
area, eta = family["area"][:], family["eta"][:]
area = area / area.mean(axis=0)
left.plot(eta, area[:60].T, color="#c9d1d9", linewidth=0.6)
left.plot(eta, area[best], color="#0072b2", label="the most power")
left.set(xlabel="span fraction", title="area of sections over its mean")
left.legend()
for colour, (part, places) in zip(("#56b4e9", "#009e73", "#d55e00"), parts.items(), strict=True):
    power, moment = (
        family[name][:][places] for name in ("rotor_power_coefficient", "rotor_root_moment")
    )
    right.plot(1e-6 * moment, power, ".", color=colour, label=part, markersize=4)
right.set(xlabel="root bending moment, MN m", title="power coefficient")
right.legend()
drawn.savefig(
    "open_family.png",
    dpi=150,
    metadata={"Title": "Areas over span of 60 variants; power and root moment of all, by split"},
)
