"""What a case says of itself: the commands to type, what comes out, what a real run needs."""

from collections.abc import Sequence
from math import degrees
from typing import Any

from bladegen.exports.cases.conditions import Conditions

__all__ = ["RUN", "allrun", "readme"]

RUN = "Allrun"
ASPECT = 1000.0  # of cells, above which checkMesh complains
DEBIAN = "/usr/share/openfoam"  # where its package has what other installs source


def readme(name: str, figures: dict[str, Any], flow: Conditions, end: int, made: str) -> str:
    """Return README.md of a section's case."""
    low, high = figures["first_height_mm"]
    rows = {
        "chord": f"{flow.chord:.4f} m",
        "relative thickness": f"{100.0 * figures['relative_thickness']:.2f} %",
        "speed": f"{flow.speed:.3f} m/s",
        "Reynolds number": f"{flow.reynolds:.4g}",
        "kinematic viscosity": f"{flow.viscosity:.4g} m2/s",
        "angle of attack": f"{degrees(flow.alpha):.3f} degrees from the chord line",
        "turbulence far away": f"k {flow.kinetic:.3g} m2/s2, omega {flow.omega:.4g} 1/s",
        "mesh": f"{figures['around']} cells around, {figures['layers']} outward, "
        f"{figures['cells']} in all; far field {figures['far_field_chords']:g} chords away",
        "first cells": f"{low:.4g} to {high:.4g} mm high: y+ of their centres about "
        f"{figures['y_plus']:g} by a flat plate's friction",
        "quality": f"non-orthogonality up to {figures['non_orthogonality_deg']:.0f} degrees, "
        f"scaled Jacobian from {figures['scaled_jacobian']:.2f}, aspect on the wall up to "
        f"{figures['aspect']:.0f}",
    }
    table = [f"| {key} | {value} |" for key, value in rows.items()]
    told = (
        f"\n\n{flow.told[0].upper()}{flow.told[1:]}; wind slowed down by a third."
        if flow.told
        else ""
    )
    slender = (
        "\n\n`checkMesh` calls an aspect above 1000 high; it is that of a thin boundary layer, "
        "which simpleFoam takes. More cells around or a larger y+ lower it."
        if figures["aspect"] > ASPECT
        else ""
    )
    stalled = (
        "\n\nAt this angle most sections stall: a steady run may not settle, and its mean is no "
        "substitute for an unsteady one."
        if flow.is_stalled
        else ""
    )
    return f"""# {name}: the section at {100.0 * figures["eta"]:g} % span

The steady flow around the section in two dimensions, k-omega SST, turbulent from the nose on.
x runs along the chord line from the nose, y to the suction side; metres.

{chr(10).join(["| what | value |", "| --- | --- |", *table])}{told}{slender}{stalled}

## Run it

With OpenFOAM on the path (v1912 or later of openfoam.com; Debian and Ubuntu: `apt-get install
openfoam`), in this folder:

```sh
./Allrun
```

or command by command:

```sh
export WM_PROJECT_DIR={DEBIAN}    # Debian's; elsewhere source OpenFOAM's etc/bashrc
checkMesh
simpleFoam    # {end} iterations at most; ends earlier once residuals have fallen
```

`./Allrun 4` does it in four processes. Allrun begins anew: it removes the results of earlier runs.

## What comes out

- `postProcessing/forces/0/coefficient.dat`: lift, drag, and the moment about the quarter chord,
  nose up positive, at each iteration. The last line is the result if those before it are alike.
- `postProcessing/residuals/0/`: residuals at each iteration.
- the last time's folder: the fields. `paraview case.foam` (an empty file of that name) shows them.

## For a real run

Look whether lift and drag change with twice the cells around (`--cells`), with y+ (`--y-plus`) and
with the far field's radius (`--radius`). Transition is not modelled: where the boundary layer is
laminar over much of the chord, drag is lower and lift a few per cent higher than here.

{made}
"""


def allrun(steps: Sequence[str], slices: str, results: str, told: str) -> str:
    """Return the script that runs a case.

    Parameters
    ----------
    steps : sequence of str
        What is run before simpleFoam, each with a log of its own.
    slices : str
        How many along x, y and z the cells are cut for `$count` processes.
    results : str
        The function object whose coefficients are shown in the end.
    told : str
        Its first columns' names, parted by commas.
    """
    made = " constant/polyMesh" if "blockMesh" in steps else ""
    before = "\n".join(f"step {step.split()[0]} {step}" for step in steps)
    last = f"postProcessing/{results}/0/coefficient.dat"
    return f"""#!/bin/sh
# Runs the case to its coefficients; ./{RUN} 4 solves in four processes.  As root, in a container,
# OpenMPI asks for OMPI_ALLOW_RUN_AS_ROOT=1 and OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1.
set -e
cd "$(dirname "$0")"
count=${{1:-1}}
if [ -z "$WM_PROJECT_DIR" ] && [ -d {DEBIAN}/etc ]; then
    export WM_PROJECT_DIR={DEBIAN}
fi
command -v simpleFoam > /dev/null || {{
    echo "{RUN}: no simpleFoam on the path; install OpenFOAM, or source its etc/bashrc" >&2
    exit 1
}}
step() {{    # name command...: runs a command, with a log of that name
    log=log.$1
    shift
    echo "$(date +%H:%M:%S) $*"
    "$@" > "$log" 2>&1 || {{
        echo "{RUN}: $1 failed; the end of $log:" >&2
        tail -n 12 "$log" >&2
        exit 1
    }}
}}
foamListTimes -rm
rm -rf processor* postProcessing{made} log.*
{before}
echo "         iterations take minutes: tail -f log.simpleFoam shows how far they are"
if [ "$count" -gt 1 ]; then
    foamDictionary -entry numberOfSubdomains -set "$count" system/decomposeParDict > log.processes
    foamDictionary -entry coeffs/n -set "({slices})" system/decomposeParDict >> log.processes
    step decomposePar decomposePar -force
    step simpleFoam mpirun -np "$count" simpleFoam -parallel
    step reconstructPar reconstructPar -latestTime
else
    step simpleFoam simpleFoam
fi
touch case.foam
echo "{told}, ...: the last line of {last}"
tail -n 1 {last} | cut -f 1-{len(told.split(","))}
"""
