"""The data card of a family: what it holds, how it was made, how to use it and to cite it."""

from collections.abc import Mapping
from typing import Any

from bladegen.families.dataset.splits import SHARES, SPLITS
from bladegen.families.labels.figures import FIGURES

__all__ = ["card"]

MEANING = """Polars are estimates: NeuralFoil (clean surface, free transition) for each
section's own shape, with the network's confidence beside them; sections thicker than 40 % are
thinned to that and mixed with a cylinder. Rotors are rigid, in steady uniform wind along their
axis, by blade-element momentum theory, at the pitch and the tip speed ratio of the largest power.
Compare variants with each other before you compare them with a turbine.
"""
MEANT = {
    "ellipsoid": "independent, uniform in the ellipsoid that holds the space's data",
    "sobol": "scrambled Sobol points in the box of the bounds",
    "lhs": "a Latin hypercube in the box of the bounds",
    "box": "independent, uniform in the box of the bounds",
    "smallest": "independent, uniform in the smallest ellipsoid that holds the space's data",
    "hull": "independent, uniform in the convex hull of the space's data",
    "mixture": "independent, of a mixture of normal distributions that the space's data follow",
    "normal": "independent, normal with the covariance of the space's data",
    "sweep": "from corner to opposite corner of the box, along each diagonal",
    "table": "the rows of a table",
}


def card(
    identity: Mapping[str, Any],
    about: Mapping[str, Any],
    ranges: Mapping[str, tuple[float, float, str]],
    sound: int,
    draws: int,
) -> str:
    """Return the card of a family as Markdown.

    Parameters
    ----------
    identity : mapping
        What `family.json` holds.
    about : mapping
        Attributes of its dataset.
    ranges : mapping
        Least and largest value of each parameter among the variants, and its unit, by variable.
    sound, draws : int
        How many variants are sound, and how often all were drawn.
    """
    count, spans, landmarks = (identity[name] for name in ("count", "spans", "landmarks"))
    kind = identity["design"]
    factors = "\n".join(
        f"| `{name}` | {low:.6g} | {high:.6g} | {unit} |"
        for name, (low, high, unit) in ranges.items()
    )
    shares = ", ".join(f"{name} {share:.0%}" for name, share in zip(SPLITS, SHARES, strict=True))
    said = "\n".join(f"- {name.replace('_', ' ')}: {about[name]}" for name in about if _told(name))
    labels = _labels(identity.get("labels", {}))
    unsound = "are drawn again" if identity["invalid"] == "redraw" else "are kept and marked"
    return f"""# {count} variants of {identity["blade"]}

Perturbed wind turbine blades: {count} variants, each {spans} sections of {landmarks} landmarks,
in metres, with what was changed, chord, twist, thickness and section properties.

## Use

```python
import xarray

data = xarray.open_zarr("sections.zarr")  # one dataset: sections, parameters, properties
train = data.sel(variant=(data.split == "train") & data.valid)
```

```python
import bladegen as bg

family = bg.load_family(".")  # the same with NumPy alone
family.parameters, family["sections"][0], family["chord"][:], family[3]  # the last is a blade
```

## What it holds

`sections.zarr` is a store of Zarr format 3 with the dimensions variant, span, landmark and xyz;
each variable says its `long_name` and `units`. `manifest.parquet` holds the same as a table,
without the sections. Origin at the blade root, z to the tip, x toward the suction side, y toward
the trailing edge.

| parameter | least | largest | unit |
| --- | --- | --- | --- |
{factors}

These are the variants' own values. The bounds that the design was given stand in `family.json`;
ellipsoids and normal distributions about the mean can reach beyond them.

## How it was made

Variants are {MEANT.get(kind, kind)} (design {kind}, seed {identity["seed"]}).
{sound} of {count} are sound: no section crosses itself, loses its thickness, leaves the data of
the space or has a nose, tail or waves of no airfoil, within what was allowed. Draws that are not
sound {unsound}: {draws} draws in all.

{said}
{labels}
## Splits

The variable `split` says for each variant train, validation or test: {shares} on
average, by the seed and the place of the variant alone, so that a family which is added to keeps
its splits. Variants of a sweep are neighbours: split those by diagonals instead.

## Licence and citation

The perturbed geometry derives from the baseline's definition: the licence of that file holds for
it too. (The definitions that come with bladegen name theirs in their first lines.) Cite bladegen
{identity["bladegen"]}, the publication of the baseline turbine, and for the shape representation
O. A. Doronina, Z. J. Grey, A. Glaws: Grassmannian Shape Representations for Aerodynamic
Applications, 2022.
"""


def _labels(labels: Mapping[str, Any]) -> str:
    """Return the section on labels; nothing but a line's end if there are none."""
    if not labels:
        return ""
    rows = [
        f"| `{one.name}` | {', '.join(('variant', *one.dims))} | {one.long_name} | {one.units} |"
        for label in labels
        for one in FIGURES[label]
    ]
    told = []
    for label, how in labels.items():
        words = [f"`{key}` {_shown(value)}" for key, value in how.items()]
        told += [f"- {label}: {', '.join(words)}"] if words else []
    return f"""
## Labels

Computed for each sound variant; NaN for others.

| variable | dimensions | what | unit |
| --- | --- | --- | --- |
{chr(10).join(rows)}

{chr(10).join([MEANING, *told])}
"""


def _shown(value: Any) -> str:
    """Return a setting as text: numbers short, lists with slashes."""
    if isinstance(value, list):
        return " / ".join(map(_shown, value))
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _told(name: str) -> bool:
    return name in (
        "source",
        "command",
        "baseline",
        "baseline_file",
        "baseline_sha256",
        "made_from",
    )
