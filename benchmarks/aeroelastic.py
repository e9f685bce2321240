"""Polars out to OpenFAST and HAWC2, read by these tools' own readers, and the rotor's power.

Run: python benchmarks/aeroelastic.py [BLADE] [--tools PYTHON] [--ccblade PYTHON].  A blade with
polars (the IEA 15 MW of the windIO package if none is named) and a variant of it are written for
OpenFAST and for HAWC2.  openfast_io reads a whole model made of the files, wetb the htc part with
its ae and pc files, and WISDEM's CCBlade finds power and thrust from what each of them read,
beside those of the polars that bladegen holds.  These packages may stand in environments of
their own, whose Python the options name.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from figures import figure, parser

HERE = Path(__file__).resolve()
SPANS = np.linspace(0.015, 0.985, 41)
ALPHA = np.arange(-180.0, 181.0, 1.0)
WIND, RATIO = 8.0, 9.0  # m/s; tip speed over wind
CHANGE = (0.04, -0.03, 0.02, 0.01)
AERODYN = """------- AERODYN INPUT FILE ------
A model for a check
====== General Options
False Echo
"default" DTAero
1 Wake_Mod
0 TwrPotent
0 TwrShadow
False TwrAero
False CavitCheck
False NacelleDrag
False CompAA
"unused" AA_InputFile
====== Environmental Conditions
1.225 AirDens
1.5e-5 KinVisc
335 SpdSound
103500 Patm
1700 Pvap
====== Blade-Element/Momentum Theory
1 BEM_Mod
--- Skew correction
1 Skew_Mod
False SkewMomCorr
1 SkewRedistr_Mod
"default" SkewRedistrFactor
--- BEM algorithm
True TipLoss
True HubLoss
True TanInd
True AIDrag
True TIDrag
"Default" IndToler
500 MaxIter
--- Shear correction
False SectAvg
1 SectAvgWeighting
5 SectAvgNPoints
-60 SectAvgPsiBwd
60 SectAvgPsiFwd
--- Dynamic wake
0 DBEMT_Mod
4 tau1_const
====== OLAF
"unused" OLAFInputFileName
====== Unsteady Airfoil Aerodynamics
True AoA34
3 UA_Mod
True FLookup
3 IntegrationMethod
{part}
====== Hub Properties
0 VolHub
0 HubCenBx
====== Nacelle Properties
0 VolNac
0,0,0 NacCenB
0,0,0 NacArea
0,0,0 NacCd
0,0,0 NacDragAC
====== Tail Fin
False TFinAero
"unused" TFinFile
====== Tower Influence
0 NumTwrNds
TwrElev TwrDiam TwrCd TwrTI TwrCb TwrCp TwrCa
(m) (m) (-) (-) (-) (-) (-)
====== Outputs
False SumPrint
0 NBlOuts
0 BlOutNd
0 NTwOuts
0 TwOutNd
OutList
END of input file
"""
TURBINE = """------- OpenFAST INPUT FILE ------
A model for a check
---- SIMULATION CONTROL
False Echo
"FATAL" AbortLevel
10 TMax
0.01 DT
1 ModCoupling
2 InterpOrder
0 NumCrctn
0.9 RhoInf
1e-4 ConvTol
20 MaxConvIter
99999 DT_UJac
1e6 UJacSclFact
---- FEATURE SWITCHES AND FLAGS
1 NRotors
1 CompElast
1 CompInflow
2 CompAero
0 CompServo
0 CompSeaSt
0 CompHydro
0 CompSub
0 CompMooring
0 CompIce
0 CompSoil
0 MHK
False MirrorRotor
---- ENVIRONMENTAL CONDITIONS
9.81 Gravity
1.225 AirDens
0 WtrDens
1.5e-5 KinVisc
335 SpdSound
103500 Patm
1700 Pvap
0 WtrDpth
0 MSL2SWL
---- INPUT FILES
"ElastoDyn.dat" EDFile
"unused" BDBldFile(1)
"unused" BDBldFile(2)
"unused" BDBldFile(3)
"unused" InflowFile
"AeroDyn.dat" AeroFile
"unused" ServoFile
"unused" SeaStFile
"unused" HydroFile
"unused" SubFile
"unused" MooringFile
"unused" IceFile
"unused" SoilFile
---- OUTPUT
True SumPrint
10 SttsTime
99999 ChkptTime
0.05 DT_Out
0 TStart
1 OutFileFmt
True TabDelim
"ES10.3E2" OutFmt
---- LINEARIZATION
False Linearize
False CalcSteady
2 TrimCase
0.001 TrimTol
0.01 TrimGain
0 Twr_Kdmp
0 Bld_Kdmp
2 NLinTimes
30, 60 LinTimes
1 LinInputs
1 LinOutputs
False LinOutJac
False LinOutMod
---- VISUALIZATION
0 WrVTK
2 VTK_type
False VTK_fields
15 VTK_fps
"""


def read_openfast(path: str) -> dict[str, Any]:
    """Read a model with openfast_io; return the blade at `SPANS` as AeroDyn has it."""
    from openfast_io.FAST_reader import InputReader_OpenFAST

    reader = InputReader_OpenFAST()
    reader.FAST_directory, reader.FAST_InputFile = str(Path(path).parent), Path(path).name
    reader.read_MainInput()
    reader.read_AeroDyn()
    blade, aero = reader.fst_vt["AeroDynBlade"], reader.fst_vt["AeroDyn"]
    span = np.array(blade["BlSpn"])
    at = SPANS * span[-1]
    own = [
        np.stack([np.interp(ALPHA, data[0]["Alpha"], data[0][key]) for key in ("Cl", "Cd", "Cm")])
        for data in aero["af_data"]
    ]
    nodes = np.stack([own[int(k) - 1] for k in blade["BlAFID"]])
    before = np.clip(np.searchsorted(span, at) - 1, 0, len(span) - 2)
    share = ((at - span[before]) / (span[before + 1] - span[before]))[:, None, None]
    return {
        "r": at.tolist(),
        "chord": np.interp(at, span, blade["BlChord"]).tolist(),
        "twist": np.interp(at, span, blade["BlTwist"]).tolist(),
        "polars": ((1 - share) * nodes[before] + share * nodes[before + 1]).tolist(),
        "airfoils": aero["NumAFfiles"],
        "constants": aero["af_data"][-1][0]["InclUAdata"],
        "points": sum(len(one["x"]) for one in aero["af_coord"]),
    }


def read_hawc2(path: str) -> dict[str, Any]:
    """Read the files of a blade with wetb; return it at `SPANS` as HAWC2 has it."""
    from wetb.hawc2.ae_file import AEFile
    from wetb.hawc2.htc_file import HTCFile
    from wetb.hawc2.pc_file import PCFile

    htc = HTCFile(path)
    line = htc.new_htc_structure if "new_htc_structure" in htc.contents else htc
    sections = np.array([sec.values[1:] for sec in line.main_body.c2_def if sec.name_ == "sec"])
    here = Path(path).parent
    ae = AEFile(str(here / htc.aero.ae_filename[0]))
    pc = PCFile(str(here / htc.aero.pc_filename[0]))
    _, _, z, twist = sections.astype(float).T
    length = np.concatenate(
        [[0], np.cumsum(np.linalg.norm(np.diff(sections[:, :3], axis=0), axis=1))]
    )
    at = SPANS * (z[-1] - z[0])
    radius = np.interp(at, z - z[0], length) / length[-1] * ae.radius_ae()[-1]
    rows = ae.ae_sets[1]
    numbers = rows[np.searchsorted(rows[:, 0], radius, side="right") - 1, 3].astype(int)
    polars = [
        [find(float(ae.thickness(r)), ALPHA, int(k)).tolist() for find in (pc.CL, pc.CD, pc.CM)]
        for r, k in zip(radius, numbers, strict=True)
    ]
    return {
        "r": at.tolist(),
        "chord": ae.chord(radius).tolist(),
        "twist": (-np.interp(at, z - z[0], twist)).tolist(),
        "polars": polars,
        "sets": len(pc.pc_sets),
    }


def power(text: str) -> dict[str, float]:
    """Return the power and thrust coefficients of a blade by CCBlade."""
    from wisdem.ccblade.ccblade import CCAirfoil, CCBlade

    blade = json.loads(text)
    airfoils = [
        CCAirfoil(ALPHA, [1e6], np.array(cl)[:, None], np.array(cd)[:, None])
        for cl, cd, _ in blade["polars"]
    ]
    hub, tip = blade["hub"], blade["hub"] + blade["length"]
    rotor = CCBlade(
        hub + np.array(blade["r"]), np.array(blade["chord"]), np.array(blade["twist"]), airfoils,
        hub, tip, B=3, precone=blade["cone"], tilt=blade["tilt"], shearExp=0.0, hubHt=150.0,
    )  # fmt: skip
    turns = RATIO * WIND / tip * 30.0 / np.pi
    found, _ = rotor.evaluate([WIND], [turns], [0.0], coefficients=True)
    return {key: float(np.ravel(found[key])[0]) for key in ("CP", "CT")}


CHILDREN = {"openfast": read_openfast, "hawc2": read_hawc2, "power": power}
PACKAGES = {"openfast": "openfast_io", "hawc2": "wetb", "power": "wisdem"}


def child(python: str, name: str, argument: str) -> Any:
    """Run one of `CHILDREN` in another Python; None, and a line, if its package is missing."""
    done = subprocess.run(
        [python, str(HERE), "--child", name], input=argument, capture_output=True, text=True,
        check=False,
    )  # fmt: skip
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["nothing said"])[-1]
        missing = f"No module named '{PACKAGES[name]}" in last
        print(f"{name}: {PACKAGES[name]} is not installed in {python}" if missing else last)
        return None
    return json.loads(done.stdout.splitlines()[-1])


def held(definition: Any) -> dict[str, Any]:
    """Return the blade at `SPANS` as the definition has it."""
    from bladegen.definition.blending import between

    found = [between(definition, float(eta)).polars()[0] for eta in SPANS]
    z = definition.axis.z(SPANS) - definition.axis.z(0.0)
    return {
        "r": z.tolist(),
        "chord": definition.chord(SPANS).tolist(),
        "twist": np.degrees(definition.twist(SPANS)).tolist(),
        "polars": [[part.tolist() for part in polar.at(np.radians(ALPHA))] for polar in found],
    }


def check(definition: Any, case: str, tools: str, ccblade: str) -> None:
    """Write a blade for both tools, read it with theirs, and print how they agree."""
    import bladegen as bg

    rotor = definition.rotor
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        bg.write(definition, folder / "blade.dat")
        bg.write(definition, folder / "blade.htc")
        part = (folder / "blade_AeroDyn_part.dat").read_text().splitlines()[2:]
        (folder / "AeroDyn.dat").write_text(AERODYN.format(part="\n".join(part)))
        (folder / "turbine.fst").write_text(TURBINE)
        (folder / "ElastoDyn.dat").write_text(
            f"{rotor.blades} NumBl\n{rotor.hub_radius + definition.length!r} TipRad\n"
            f"{rotor.hub_radius!r} HubRad\n{-np.degrees(rotor.cone)!r} PreCone(1)\n"
            f"{-np.degrees(rotor.tilt)!r} ShftTilt\n"
        )
        routes = {
            "bladegen": held(definition),
            "AeroDyn by openfast_io": child(tools, "openfast", str(folder / "turbine.fst")),
            "HAWC2 by wetb": child(tools, "hawc2", str(folder / "blade.htc")),
            ".fst by bladegen": held(bg.read(folder / "turbine.fst")),
            ".htc by bladegen": held(bg.read(folder / "blade.htc")),
        }
    facts = {
        "hub": rotor.hub_radius,
        "length": definition.length,
        "cone": -np.degrees(rotor.cone),
        "tilt": -np.degrees(rotor.tilt),
    }
    first = routes["bladegen"]
    read = {route: blade for route, blade in routes.items() if blade is not None}
    off: dict[str, Any] = {
        route: np.abs(np.array(blade["polars"]) - np.array(first["polars"])).max(axis=(0, 2))
        for route, blade in read.items()
        if route != "bladegen"
    }
    for k, label in enumerate(("Cl", "Cd", "Cm")):
        of = {route: float(off[route][k]) if route in off else None for route in routes}
        del of["bladegen"]
        figure(f"largest difference of {label}", case, "", of)
    for key in ("CP", "CT"):
        found: dict[str, Any] = dict.fromkeys(routes)
        for route, blade in read.items():
            made = child(ccblade, "power", json.dumps({**blade, **facts}))
            found[route] = made[key] if made else None
        if any(value is not None for value in found.values()):
            figure(f"{key} by CCBlade", case, "", found)


def main() -> None:
    """Print how what the tools read agrees, on a blade and on a variant."""
    options = parser(__doc__)
    options.add_argument("blade", nargs="?", help="a file with polars")
    options.add_argument("--tools", default=sys.executable, help="with openfast_io and wetb")
    options.add_argument("--ccblade", default=sys.executable, help="with wisdem")
    options.add_argument("--child", help=argparse.SUPPRESS)
    asked = options.parse_args()
    if asked.child:
        print(json.dumps(CHILDREN[asked.child](sys.stdin.read())))
        return
    import bladegen as bg
    from bladegen.formats.writing import prepared

    source = asked.blade
    if source is None:
        import windIO

        source = Path(windIO.__file__).parent / "examples" / "turbine" / "IEA-15-240-RWT.yaml"
    definition = bg.read(source)
    blade = bg.Blade.from_definition(definition)
    variant = blade.perturbed(bg.ShapeSpace.bundled(), CHANGE)
    check(definition, definition.name, asked.tools, asked.ccblade)
    if asked.quick:
        return
    for policy in ("keep", "estimate"):
        made, _ = prepared(variant, polars=policy)
        check(made, f"variant, {policy}", asked.tools, asked.ccblade)
    guess, _ = prepared(definition, polars="none")
    made, _ = prepared(guess, polars="estimate")
    check(made, f"{definition.name}, estimate", asked.tools, asked.ccblade)


if __name__ == "__main__":
    main()
