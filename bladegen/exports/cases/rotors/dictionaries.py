"""OpenFOAM's dictionaries of a rotor in steady wind: k-omega SST, solved by simpleFoam.

All cells turn with the blade: velocities are those of the frame at rest, and the equations have the
terms of a frame that turns (MRF), so that the flow around the blade is steady.  Only the blade's
patches turn; the cylinder at the hub and the far one let air slip along them.
"""

from math import pi
from typing import Any

from bladegen.definition.estimates import AIR
from bladegen.exports.cases import dictionaries
from bladegen.exports.cases.conditions import INDUCTION
from bladegen.exports.cases.dictionaries import BLADE, DIMENSIONS
from bladegen.exports.cases.rotors.blocks import FAR, HUB, INLET, OUTLET, SIDES, ZONE
from bladegen.exports.cases.rotors.operation import DENSITY, Operation
from bladegen.support.foam import number, vector

__all__ = ["constant", "fields", "numerics", "system"]

EDDIES = 100.0  # of the viscosity, in the wind
BEGUN = 1000.0  # where a run begins: walls at rest in still air leave pressure nothing to hold
OMEGA = 5.0  # wind speeds over the reference chord, see `conditions.OMEGA`


def turbulence(flow: Operation) -> tuple[float, float]:
    """Return kinetic energy [m2/s2] and specific dissipation rate [1/s] of the wind."""
    omega = OMEGA * flow.section_speed / flow.chord
    return EDDIES * AIR * omega, omega


def fields(flow: Operation) -> dict[str, tuple[str, dict[str, Any]]]:
    """Return class and entries of the fields that a run begins with."""
    kinetic, omega = turbulence(flow)
    begun = {"k": number(BEGUN * AIR * omega), "nut": number(BEGUN * AIR)}
    given: dict[str, tuple[str, dict[str, Any]]] = {  # the value in the wind, on the blade
        "U": (vector((flow.wind, 0.0, 0.0)), {"type": "noSlip"}),
        "p": ("0", {"type": "zeroGradient"}),
        "k": (number(kinetic), {"type": "kqRWallFunction", "value": f"uniform {number(kinetic)}"}),
        "omega": (
            number(omega),
            {"type": "omegaWallFunction", "value": f"uniform {number(omega)}"},
        ),
        "nut": (
            number(kinetic / omega),
            {"type": "nutUSpaldingWallFunction", "value": "uniform 0"},
        ),
    }
    made = {}
    for name, (value, wall) in given.items():
        uniform = f"uniform {value}"
        fixed = {"type": "fixedValue", "value": uniform}
        free = {"type": "inletOutlet", "inletValue": uniform, "value": uniform}
        ends = {
            "U": (fixed, free),
            "p": ({"type": "zeroGradient"}, fixed),
            "nut": 2 * ({"type": "calculated", "value": uniform},),
        }.get(name, (fixed, free))
        made[name] = (
            "volVectorField" if name == "U" else "volScalarField",
            {
                "dimensions": DIMENSIONS[name],
                "internalField": f"uniform {begun.get(name, value)}",
                "boundaryField": {
                    BLADE: wall,
                    INLET: ends[0],
                    OUTLET: ends[1],
                    **{slip: {"type": "slip"} for slip in (FAR, HUB)},
                    **{side: {"type": "cyclic"} for side in SIDES},
                },
            },
        )
    return made


def constant(flow: Operation, sense: float) -> dict[str, dict[str, Any]]:
    """Return what the fluid is, its model of turbulence, and how cells turn about x (sense +-1)."""
    return dictionaries.fluid(AIR) | {
        "MRFProperties": {
            "turning": {
                "cellZone": ZONE,
                "active": "yes",
                "nonRotatingPatches": (INLET, OUTLET, FAR, HUB),
                "origin": (0, 0, 0),
                "axis": (1, 0, 0),
                "omega": sense * flow.speed,
            },
        },
    }


def system(flow: Operation, blades: int, length: float, end: int) -> dict[str, dict[str, Any]]:
    """Return how the equations are solved and what is written; the wake's length in metres."""
    return {
        "controlDict": _control(flow, blades, end),
        **numerics(),
        "setFieldsDict": _wake(flow, length),
        "decomposeParDict": {
            "numberOfSubdomains": 2,
            "method": "simple",
            "coeffs": {"n": (1, 1, 2)},  # along the blade
        },
    }


def numerics() -> dict[str, dict[str, Any]]:
    """Return schemes and solvers on snappyHexMesh's cells.

    Velocity is relaxed by little: air past the blade goes round faster than the wake goes downwind,
    by the tip speed ratio, and the wake would take as many more iterations.
    """
    limited = dict.fromkeys(("grad(U)", "grad(k)", "grad(omega)"), "cellLimited Gauss linear 1")
    gradients = {"default": "Gauss linear", **limited}
    return {
        "fvSchemes": dictionaries.schemes(gradients, "upwind", "limited corrected 0.5"),
        "fvSolution": dictionaries.solution(0.1, velocity=0.9, eddies=0.8),
    }


def _control(flow: Operation, blades: int, end: int) -> dict[str, Any]:
    every = {"writeControl": "timeStep", "writeInterval": 1, "log": "false"}
    about = {
        "libs": ('"libforces.so"',),
        "patches": (BLADE,),
        "rho": "rhoInf",
        "rhoInf": DENSITY,
        "CofR": (0, 0, 0),
    }
    return dictionaries.stepping(end) | {
        "functions": {
            "forces": {"type": "forces", **about, **every},
            "coefficients": {  # Cd is that of thrust, CmRoll, about the drag, that of torque
                "type": "forceCoeffs",
                **about,
                "magUInf": flow.wind,
                "lRef": flow.radius,
                "Aref": pi * flow.radius**2 / blades,
                "dragDir": (1, 0, 0),
                "liftDir": (0, 0, 1),
                "pitchAxis": (0, 1, 0),
                **every,
            },
            **dictionaries.WATCHED,
        },
    }


def _wake(flow: Operation, length: float) -> dict[str, Any]:
    """Return where a run begins: a wake as Betz has it, which slows the wind down at the rotor.

    Without it blades would stall before their wake has grown.
    """
    slow = (1.0 - 2.0 * INDUCTION) * flow.wind
    return {
        "defaultFieldValues": (f"volVectorFieldValue U {vector((flow.wind, 0.0, 0.0))}",),
        "regions": [
            f"cylinderToCell {{ p1 (0 0 0); p2 {vector((length, 0.0, 0.0))}; "
            f"radius {number(flow.radius)}; "
            f"fieldValues (volVectorFieldValue U {vector((slow, 0.0, 0.0))}); }}"
        ],
    }
