"""A network that designs sections, trained through the geometry by PyTorch.

    python examples/inverse_design.py [FILE.png]

Asked for a relative thickness, a camber and an area it gives shape coordinates and a factor of
thickness.  It is never shown a right answer: what it is trained on is how far the section that it
gives is from what was asked for.  Camber is the height of the centroid above the chord line.
"""

import sys
from pathlib import Path

import numpy as np
import torch

import bladegen as bg
from bladegen.torch import BladeFunction
from bladegen.views.plots import figures, style

STEPS, BATCH, TESTED, SEED = 400, 48, 200, 1
BOUNDS = {"pga": (-0.06, 0.06), "thickness": (0.85, 1.15)}
MODEL = bg.ParametricBlade(
    bg.Blade.from_definition(bg.read("iea15mw"), landmarks=101),
    bg.ShapeSpace.bundled(),
    ("pga", "thickness"),
    eta=[0.8],
    bounds=BOUNDS,
)
ASKED = ("relative_thickness", "section_centroid_y", "section_area")
NAMES = ("relative thickness", "camber, m", "area, m²")
GEOMETRY = BladeFunction(MODEL, ASKED)
LOWER, UPPER = (torch.tensor(bound) for bound in (MODEL.lower, MODEL.upper))


def measured(x: torch.Tensor) -> torch.Tensor:
    """Return thickness, camber and area (b, 3) of parameters (b, 5)."""
    found = GEOMETRY(x)
    return torch.cat([found[name] for name in ASKED], dim=-1)


def drawn_at_random(count: int) -> torch.Tensor:
    """Return measures (count, 3) that some sections have, not at the bounds' edge."""
    share = 0.1 + 0.8 * torch.rand(count, len(LOWER), dtype=torch.float64)
    return measured(LOWER + (UPPER - LOWER) * share)


def main(target: Path) -> None:
    """Train, and draw what was asked for beside what came."""
    torch.manual_seed(SEED)
    torch.set_num_threads(1)
    known = drawn_at_random(500)
    mean, spread = known.mean(dim=0), known.std(dim=0)
    network = torch.nn.Sequential(
        torch.nn.Linear(len(ASKED), 24),
        torch.nn.Tanh(),
        torch.nn.Linear(24, len(LOWER)),
        torch.nn.Sigmoid(),
    ).double()

    def designed(asked: torch.Tensor) -> torch.Tensor:
        return LOWER + (UPPER - LOWER) * network((asked - mean) / spread)

    optimiser = torch.optim.Adam(network.parameters(), lr=0.02)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, STEPS)
    losses = []
    for _ in range(STEPS):
        asked = known[torch.randint(len(known), (BATCH,))]
        loss = (((measured(designed(asked)) - asked) / spread) ** 2).mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        schedule.step()
        losses.append(loss.item())

    asked = drawn_at_random(TESTED)
    with torch.no_grad():
        came = measured(designed(asked))
    off = ((came - asked) / spread).pow(2).mean().sqrt().item()
    drawn, axes = figures.figure(1, 4, width=13, height=3.2)
    axes[0, 0].semilogy(losses, color=style.VARIANT)
    axes[0, 0].set(xlabel="step", title="loss")
    for axis, name, one, other in zip(axes[0, 1:], NAMES, asked.T, came.T, strict=True):
        axis.plot(one, one, color=style.BASELINE)
        axis.plot(one, other, ".", color=style.VARIANT, markersize=3)
        axis.set(xlabel="asked for", title=name)
    figures.save_figure(drawn, target)
    sound = np.mean(MODEL.valid(designed(asked).detach().numpy()))
    print(
        f"wrote {target}; {TESTED} others are met to {100 * off:.1f} % of a standard deviation, "
        f"{100 * sound:.0f} % of the sections are sound"
    )


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "inverse_design.png"))
