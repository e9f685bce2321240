"""A turbine with its own, the same and a perturbed blade in WISDEM: power, thrust, mass, modes.

Run: python benchmarks/wisdem_run.py [TURBINE.yaml | BLADE].  The turbine is a full windIO 2 file,
by default the IEA 15 MW of the windIO package; of a bundled BLADE (iea15mw, nrel5mw) the variants
run as they are written, without a turbine file.  WISDEM is no dependency of bladegen: install it,
or name the Python that has it in WISDEM_PYTHON.  Every blade goes through the commands that a user
types.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

PGA = "0.04,-0.03,0.02,0.01"
WISDEM = """
import json, os, sys, warnings
warnings.filterwarnings("ignore")
from wisdem.glue_code.runWISDEM import run_wisdem
problem, _, _ = run_wisdem(*sys.argv[1:4])
def most(name, unit): return float(problem.get_val(name, units=unit).max())
print("RESULT" + json.dumps({
    "Cp": most("rotorse.rp.powercurve.Cp_regII", None),
    "AEP": most("rotorse.rp.AEP", "GW*h"),
    "power": most("rotorse.rp.powercurve.P", "MW"),
    "rated at": most("rotorse.rp.powercurve.rated_V", "m/s"),
    "thrust": most("rotorse.rp.powercurve.T", "MN"),
    "mass": most("rotorse.blade_mass", "t"),
    "tip moves": most("rotorse.rs.tip_pos.tip_deflection", "m"),
    "flap": float(problem.get_val("rotorse.rs.frame.flap_mode_freqs", units="Hz")[0]),
    "edge": float(problem.get_val("rotorse.rs.frame.edge_mode_freqs", units="Hz")[0]),
}))
"""
MODELING = """
General: {verbosity: false}
WISDEM:
  RotorSE:
    flag: true
    spar_cap_ss: Spar_Cap_SS
    spar_cap_ps: Spar_Cap_PS
    te_ss: TE_reinforcement_SS
    te_ps: TE_reinforcement_PS
  DriveSE: {flag: false}
  TowerSE: {flag: false}
  FixedBottomSE: {flag: false}
  BOS: {flag: false}
  LCOE: {flag: true}
Environment: {air_density: 1.225, air_dyn_viscosity: 1.81e-5, shear_exp: 0.2}
"""
ANALYSIS = "general: {folder_output: outputs, fname_output: out}\n"
HEAD = (
    *("blade", "Cp", "AEP, GWh", "power, MW", "rated at, m/s", "thrust, MN", "mass, t", "tip, m"),
    *("flap, Hz", "edge, Hz"),
)
BUNDLED = ("iea15mw", "nrel5mw")
VARIANTS = (
    ("as it is", ()),
    ("other airfoils", ("--pga", PGA)),
    ("2 % thicker", ("--thickness", "1.02")),
    ("sections 3 % larger", ("--chord-scale", "1.03")),
    ("twist 1 degree more", ("--twist", "1")),
)


def bladegen(*arguments: object) -> None:
    """Run the command line; what it prints of a failure is shown."""
    command = [sys.executable, "-c", "from bladegen.cli.commands import main; main()"]
    done = subprocess.run(
        [*command, *map(str, arguments)], capture_output=True, text=True, check=False
    )
    if done.returncode:
        sys.exit(done.stderr)


def run(python: str, turbine: Path) -> list[float]:
    """Return what WISDEM finds for a turbine file, in the order of the table."""
    folder = turbine.parent
    (folder / "modeling.yaml").write_text(MODELING)
    (folder / "analysis.yaml").write_text(ANALYSIS)
    files = [turbine, folder / "modeling.yaml", folder / "analysis.yaml"]
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    done = subprocess.run(
        [python, "-c", WISDEM, *map(str, files)],
        capture_output=True,
        text=True,
        check=False,
        cwd=folder,
        env=environment | {"OMP_NUM_THREADS": "1"},
    )
    found = [line for line in done.stdout.splitlines() if "RESULT" in line]
    if not found:
        sys.exit(f"{turbine.name}: WISDEM stopped\n{done.stderr[-2000:]}")
    return list(json.loads(found[0].split("RESULT")[1]).values())


def default_turbine(python: str) -> Path:
    """Return the IEA 15 MW of the windIO package that WISDEM brings with it."""
    code = "import windIO.examples.turbine as t; print(list(t.__path__)[0])"
    found = subprocess.run([python, "-c", code], capture_output=True, text=True, check=True)
    return Path(found.stdout.strip()) / "IEA-15-240-RWT.yaml"


def shown(title: str, row: list[float]) -> None:
    """Print a line of the table."""
    print(f"| {title} | " + " | ".join(f"{value:.5g}" for value in row) + " |", flush=True)


def alone(python: str, blade: str) -> None:
    """Print what WISDEM makes of variants of a bundled blade, each from its own file alone."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for i, (title, change) in enumerate(VARIANTS):
            made, case = f"variant{i}", folder / str(i)
            if change:
                bladegen(
                    "perturb", blade, "-o", case, *change, "--format", "yaml", "--name", made,
                    "--polars", "estimate-all",
                )  # fmt: skip
            else:
                case.mkdir()
                bladegen("convert", blade, case / f"{made}.yaml", "--polars", "estimate-all")
            shown(f"{blade}: {title}", run(python, case / f"{made}.yaml"))


def main() -> None:
    """Print a table of what WISDEM makes of each file."""
    python = os.environ.get("WISDEM_PYTHON", sys.executable)
    probe = subprocess.run([python, "-c", "import wisdem"], capture_output=True, check=False)
    if probe.returncode:
        sys.exit(
            "wisdem is missing: pip install wisdem into an environment, and name its Python "
            "in WISDEM_PYTHON"
        )
    print("| " + " | ".join(HEAD) + " |")
    print("| --- " * len(HEAD) + "|")
    if sys.argv[1:] and sys.argv[1] in BUNDLED:
        alone(python, sys.argv[1])
        return
    turbine = Path(sys.argv[1]) if len(sys.argv) > 1 else default_turbine(python)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for title, change, polars in (
            ("the file as it is", None, None),
            ("its blade put back", (), "keep"),
            ("its blade, all polars estimated", (), "estimate-all"),
            ("perturbed, polars kept", ("--pga", PGA), "keep"),
            ("perturbed, polars estimated", ("--pga", PGA), "estimate"),
            ("perturbed, all polars estimated", ("--pga", PGA), "estimate-all"),
        ):
            made = folder / "new.yaml"
            source, then = turbine, polars
            if change:
                bladegen(
                    "perturb", turbine, "-o", folder, *change, "--format", "yaml",
                    "--name", "variant", "--polars", polars,
                )  # fmt: skip
                source, then = folder / "variant.yaml", "keep"
            if change is None:
                made.write_bytes(turbine.read_bytes())
            else:
                bladegen("convert", source, made, "--into", turbine, "--polars", then)
            shown(title, run(python, made))


if __name__ == "__main__":
    main()
