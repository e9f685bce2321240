"""What a rotor's case says of itself: the commands to type, what comes out, what a run needs."""

from typing import Any

from bladegen.exports.cases.guidance import DEBIAN
from bladegen.exports.cases.rotors.operation import Operation

__all__ = ["readme"]


def readme(
    name: str, figures: dict[str, Any], flow: Operation, end: int, remarks: list[str], made: str
) -> str:
    """Return README.md of a rotor's case."""
    rows = {
        "rotor": f"{figures['blades']} blades, tip radius {flow.radius:.3f} m; the case is one "
        f"blade in {figures['sector_deg']:g} degrees",
        "wind": f"{flow.wind:.4g} m/s along the axis",
        "rotor speed": f"{figures['rotor_speed_rpm']:.4g} 1/min, tip speed "
        f"{flow.tip_speed:.4g} m/s, tip speed ratio {flow.ratio:.4g}",
        "pitch": f"{figures['pitch_deg']:.4g} degrees toward feather",
        "Reynolds number": f"{flow.reynolds:.4g} of the chord at 75 % span",
        "background": f"{figures['background_cells']} cells, {figures['background_cell_m']:.3g} m "
        f"around the blade; far field {figures['far_field_radii']:g} tip radii away",
        "cells on the blade": f"{figures['surface_cell_m']:.3g} m ({figures['level']} halvings), "
        f"{figures['around']} around the section at 75 % span, a quarter of it at "
        "both edges; three times as long along the span",
        "layers": f"{figures['layers']}, the first {figures['first_height_mm']:.3g} mm high (y+ of "
        f"its centre about {figures['y_plus']:g} at 75 % span), growth {figures['growth']:g}",
    }
    table = [f"| {key} | {value} |" for key, value in rows.items()]
    told = f"\n\nFrom the blade's file: {flow.told}." if flow.told else ""
    return f"""# {name}: a rotor in steady wind

One blade in its sector, all of which turns with it; the sector's sides are cyclic.  Steady, k-omega
SST with wall functions, turbulent all over.  x runs along the axis, downwind, the blade points up
along z; metres.  A cylinder of {figures["hub_cylinder_m"]:.3g} m radius stands for hub and nacelle:
air slips along it.  There is neither tilt nor tower, and the wind is the same at all heights.

{chr(10).join(["| what | value |", "| --- | --- |", *table])}{told}

## Run it

With OpenFOAM on the path (v1912 or later of openfoam.com; Debian and Ubuntu: `apt-get install
openfoam`), in this folder:

```sh
./Allrun
```

or command by command:

```sh
export WM_PROJECT_DIR={DEBIAN}    # Debian's; elsewhere source OpenFOAM's etc/bashrc
blockMesh
snappyHexMesh -overwrite
checkMesh
setFields    # a wake to begin with, so that the blade does not stall at first
simpleFoam    # {end} iterations at most; ends earlier once residuals have fallen
```

`./Allrun 4` solves in four processes.  Allrun begins anew: it removes the results of earlier runs.

## What comes out

- `postProcessing/forces/0/force.dat` and `moment.dat`: on the one blade at each iteration, N and
  N m; the rotor's thrust and torque are {figures["blades"]} times the x of total force and moment,
  positive downwind and by the right hand.
- `postProcessing/coefficients/0/coefficient.dat`: the rotor's, over 1/2 rho U^2 pi R^2 =
  {flow.force:.6g} N; `Cd` is that of thrust, `CmRoll` that of torque (over R besides), and
  that of power is {flow.ratio:.4g} times its size.
- `postProcessing/residuals/0/`: residuals at each iteration.
- the last time's folder: the fields. `paraview case.foam` (an empty file of that name) shows them.

`bladegen evaluate` says what blade element momentum theory makes of the same blade.
{"".join(f"{chr(10)}Mind: {line}.{chr(10)}" for line in remarks)}
{made}
"""
