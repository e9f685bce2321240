"""OpenFOAM's dictionaries of a section in a steady stream: k-omega SST, solved by simpleFoam.

Each function returns entries by file name.  Wall functions are those that hold from the sublayer to
the logarithmic layer, so that a mesh of any y+ runs.  References: OpenFOAM's user guide; F. R.
Menter, M. Kuntz and R. Langtry, Turbulence, Heat and Mass Transfer 4 (2003), 625-632.
"""

from math import cos, sin
from typing import Any

from bladegen.exports.cases.conditions import Conditions
from bladegen.exports.cases.poly_mesh import FAR, PLANES
from bladegen.support.foam import number, vector

__all__ = [
    "BLADE",
    "DIMENSIONS",
    "WATCHED",
    "constant",
    "fields",
    "fluid",
    "schemes",
    "solution",
    "stepping",
    "system",
]

BLADE = "blade"  # the group of all walls
QUARTER = 0.25  # chords; where moments are about
SETTLED = {'"(p|U|k|omega)"': 1e-6}  # initial residuals that end a run
WATCHED: dict[str, Any] = {  # besides forces
    "yPlus": {
        "type": "yPlus",
        "libs": ('"libfieldFunctionObjects.so"',),
        "writeControl": "writeTime",
    },
    "residuals": {
        "type": "solverInfo",
        "libs": ('"libutilityFunctionObjects.so"',),
        "fields": ("U", "p", "k", "omega"),
    },
}
DIMENSIONS = {
    "U": "[0 1 -1 0 0 0 0]",
    "p": "[0 2 -2 0 0 0 0]",
    "k": "[0 2 -2 0 0 0 0]",
    "omega": "[0 0 -1 0 0 0 0]",
    "nut": "[0 2 -1 0 0 0 0]",
}


def fields(flow: Conditions) -> dict[str, tuple[str, dict[str, Any]]]:
    """Return class and entries of the fields that a run begins with."""
    stream = vector((flow.speed * cos(flow.alpha), flow.speed * sin(flow.alpha), 0.0))
    eddies = number(flow.kinetic / flow.omega)
    free: dict[str, tuple[str, str, dict[str, Any]]] = {  # the value, far away, on walls
        "U": (stream, "freestreamVelocity", {"type": "noSlip"}),
        "p": ("0", "freestreamPressure", {"type": "zeroGradient"}),
        "k": (number(flow.kinetic), "freestream", {"type": "kLowReWallFunction"}),
        "omega": (number(flow.omega), "freestream", {"type": "omegaWallFunction"}),
        "nut": (eddies, "freestream", {"type": "nutUSpaldingWallFunction"}),
    }
    made = {}
    for name, (value, far, wall) in free.items():
        uniform = f"uniform {value}"
        start = {} if len(wall) > 1 or name in "Up" else {"value": "uniform 0"}
        if name in ("k", "omega"):
            start = {"value": uniform}
        made[name] = (
            "volVectorField" if name == "U" else "volScalarField",
            {
                "dimensions": DIMENSIONS[name],
                "internalField": uniform,
                "boundaryField": {
                    BLADE: {**wall, **start},
                    FAR: {"type": far, "freestreamValue": uniform},
                    PLANES: {"type": "empty"},
                },
            },
        )
    return made


def constant(flow: Conditions) -> dict[str, dict[str, Any]]:
    """Return what the fluid is, and its model of turbulence."""
    return fluid(flow.viscosity)


def fluid(viscosity: float) -> dict[str, dict[str, Any]]:
    """Return what a fluid of a kinematic viscosity [m2/s] is, and its model of turbulence."""
    return {
        "transportProperties": {"transportModel": "Newtonian", "nu": number(viscosity)},
        "turbulenceProperties": {
            "simulationType": "RAS",
            "RAS": {"RASModel": "kOmegaSST", "turbulence": "on", "printCoeffs": "on"},
        },
    }


def system(flow: Conditions, thickness: float, end: int) -> dict[str, dict[str, Any]]:
    """Return how the equations are solved and what is written, for a slab of a thickness [m]."""
    return {
        "controlDict": _control(flow, thickness, end),
        "fvSchemes": schemes({"default": "Gauss linear"}, "limitedLinear 1", "corrected"),
        "fvSolution": solution(0.05, velocity=0.95, eddies=0.9),
        "decomposeParDict": {
            "numberOfSubdomains": 2,
            "method": "simple",
            "coeffs": {"n": (2, 1, 1)},
        },
    }


def stepping(end: int) -> dict[str, Any]:
    """Return the entries of controlDict but what is written at each iteration."""
    return {
        "application": "simpleFoam",
        "startFrom": "latestTime",
        "startTime": 0,
        "stopAt": "endTime",
        "endTime": end,
        "deltaT": 1,
        "writeControl": "timeStep",
        "writeInterval": end,
        "purgeWrite": 2,
        "writeFormat": "ascii",
        "writePrecision": 10,
        "timeFormat": "general",
        "timePrecision": 8,
        "runTimeModifiable": "true",
    }


def _control(flow: Conditions, thickness: float, end: int) -> dict[str, Any]:
    return stepping(end) | {
        "functions": {
            "forces": {
                "type": "forceCoeffs",
                "libs": ('"libforces.so"',),
                "patches": (BLADE,),
                "rho": "rhoInf",
                "rhoInf": 1,
                "magUInf": flow.speed,
                "lRef": flow.chord,
                "Aref": flow.chord * thickness,
                "CofR": (QUARTER * flow.chord, 0, 0),
                "liftDir": (-sin(flow.alpha), cos(flow.alpha), 0),
                "dragDir": (cos(flow.alpha), sin(flow.alpha), 0),
                "pitchAxis": (0, 0, -1),
                "writeControl": "timeStep",
                "writeInterval": 1,
                "log": "false",
            },
            **WATCHED,
        },
    }


def schemes(gradients: dict[str, str], eddies: str, normal: str) -> dict[str, Any]:
    """Return the schemes of a steady run.

    Parameters
    ----------
    gradients : dict
        Schemes of gradients, "default" among them.
    eddies : str
        How k and omega are carried along.
    normal : str
        How gradients normal to faces are corrected.
    """
    return {
        "ddtSchemes": {"default": "steadyState"},
        "gradSchemes": gradients,
        "divSchemes": {
            "default": "none",
            "div(phi,U)": "bounded Gauss linearUpwind grad(U)",
            "div(phi,k)": f"bounded Gauss {eddies}",
            "div(phi,omega)": f"bounded Gauss {eddies}",
            "div((nuEff*dev2(T(grad(U)))))": "Gauss linear",
        },
        "laplacianSchemes": {"default": f"Gauss linear {normal}"},
        "interpolationSchemes": {"default": "linear"},
        "snGradSchemes": {"default": normal},
        "wallDist": {"method": "meshWave"},
    }


def solution(transport: float, *, velocity: float, eddies: float) -> dict[str, Any]:
    """Return the solvers of a steady run, by SIMPLE-C.

    Parameters
    ----------
    transport : float
        By how much residuals of velocity and eddies fall in an iteration.
    velocity, eddies : float
        Relaxation of their equations, 1 for none.
    """
    pressure = {"solver": "GAMG", "smoother": "GaussSeidel", "tolerance": 1e-10, "relTol": 0.05}
    return {
        "solvers": {
            "p": pressure,
            '"(U|k|omega)"': {
                "solver": "smoothSolver",
                "smoother": "symGaussSeidel",
                "tolerance": 1e-12,
                "relTol": transport,
            },
        },
        "SIMPLE": {
            "consistent": "yes",
            "nNonOrthogonalCorrectors": 0,
            "residualControl": SETTLED,
        },
        "relaxationFactors": {"equations": {"U": velocity, '"(k|omega)"': eddies}},
    }
