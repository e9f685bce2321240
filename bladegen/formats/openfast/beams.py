"""Lines of OpenFAST's structural files: ElastoDyn's and BeamDyn's blade, and BeamDyn's main input.

In: `BeamProperties` over the whole span.  ElastoDyn's stations count along the straight blade,
BeamDyn's along its axis; key points are the axis, whose frame is BeamDyn's (x to the suction side,
y to the trailing edge).  Mode shapes are those of the blade without its twist, clamped and not
turning, as ElastoDyn turns them into each section's axes.  Damping is no result: `DAMPING`.
"""

import numpy as np

from bladegen.blade.layup.beam.modes import POWERS, bending, polynomial, torsion
from bladegen.blade.layup.beam.properties import BeamProperties

__all__ = [
    "DAMPING",
    "LATEST",
    "beamdyn_blade",
    "beamdyn_main",
    "elastodyn_blade",
    "frequencies",
]

LATEST = 5  # of OpenFAST's versions that are told apart; 4 stands for those before, too
DAMPING = (
    0.477465  # % of critical: NREL 5 MW (Jonkman et al., NREL/TP-500-38060, 2009), 3 % decrement
)
ORDER = 10  # of BeamDyn's element, as IEA 15 and 22 MW have it
RULE = 80  # characters


def elastodyn_blade(beam: BeamProperties, openfast: int = LATEST) -> list[str]:
    """Return ElastoDyn's blade file; its second line is free."""
    _, flap = bending(beam.along, beam.flap, beam.mass, 2)
    _, edge = bending(beam.along, beam.edge, beam.mass, 1)
    adjusted = ("FlStTunr1", "FlStTunr2", "AdjBlMs", "AdjFlSt", "AdjEdSt")
    meant = (
        *(
            "Blade flapwise modal stiffness tuner, 1st mode",
            "Blade flapwise modal stiffness tuner, 2nd mode",
        ),
        *(f"Factor to adjust blade {of}" for of in ("mass density", "flap stiffness")),
        "Factor to adjust blade edge stiffness",
    )
    lines = [
        "------- ELASTODYN V1.00.* INDIVIDUAL BLADE INPUT FILE ".ljust(RULE, "-"),
        "",
        _rule("BLADE PARAMETERS"),
        _entry(len(beam.eta), "NBlInpSt", "Number of blade input stations (-)"),
    ]
    for name, which in (("BldFlDmp1", "flap mode #1"), ("BldFlDmp2", "flap mode #2")):
        lines.append(_entry(DAMPING, name, f"Blade {which} structural damping, of critical (%)"))
    lines += [
        _entry(DAMPING, "BldEdDmp1", "Blade edge mode #1 structural damping, of critical (%)"),
        _rule("BLADE ADJUSTMENT FACTORS"),
        *(_entry(1.0, name, f"{what} (-)") for name, what in zip(adjusted, meant, strict=True)),
        _rule("DISTRIBUTED BLADE PROPERTIES"),
        *beam.distributed(pitch_axis=openfast < LATEST),
        _rule("BLADE MODE SHAPES"),
    ]
    for name, mode, shape in (
        ("BldFl1Sh", "Flap mode 1", flap[0]),
        ("BldFl2Sh", "Flap mode 2", flap[1]),
        ("BldEdgSh", "Edge mode 1", edge[0]),
    ):
        for power, factor in zip(POWERS.tolist(), polynomial(shape).tolist(), strict=True):
            lines.append(
                _entry(f"{factor:.10f}", f"{name}({power})", f"{mode}, coeff of x^{power}")
            )
    return lines


def beamdyn_blade(beam: BeamProperties, openfast: int = LATEST) -> list[str]:
    """Return BeamDyn's blade file; its second line is free.

    Damping goes with the stiffness: 2 zeta over the first circular frequency of each motion.
    """
    flap, edge, twisted = frequencies(beam)
    each = np.array([flap, edge, twisted, edge, flap, twisted])
    ratio = DAMPING / 100.0
    lines = [
        "------- BEAMDYN V1.00.* INDIVIDUAL BLADE INPUT FILE ".ljust(RULE, "-"),
        "",
        _rule("BLADE PARAMETERS"),
        _entry(len(beam.eta), "station_total", "Number of blade input stations (-)"),
        _entry(1, "damp_type", "Damping type (switch): 0: none; 1: stiffness-proportional"),
        _rule("STIFFNESS-PROPORTIONAL DAMPING"),
        "  ".join(f"mu{i}".center(12) for i in range(1, 7)).rstrip(),
        "  ".join(["(s)".center(12)] * 6).rstrip(),
        "  ".join(f"{value:.6e}" for value in ratio / (np.pi * each)),
    ]
    if openfast >= LATEST:
        lines += [
            _rule("MODAL DAMPING [used only if damp_type=2]"),
            _entry(3, "n_modes", "Number of modal damping coefficients (-)"),
            _entry(" ".join([f"{ratio:.6f}"] * 3), "zeta", "Damping coefficients of these modes"),
        ]
    return [*lines, _rule("DISTRIBUTED PROPERTIES"), *beam.matrices()]


def beamdyn_main(beam: BeamProperties, blade_file: str, openfast: int = LATEST) -> list[str]:
    """Return BeamDyn's main input file, which names the blade's."""
    count = len(beam.eta)
    defaults = {
        "n_fact": "Factorization frequency for the Jacobian in N-R iteration (-)",
        "DTBeam": "Time step size (s)",
        "load_retries": "Number of factored load retries before quitting the simulation",
        "NRMax": "Max number of iterations in Newton-Raphson algorithm (-)",
        "stop_tol": "Tolerance for stopping criterion (-)",
        "tngt_stf_fd": "Use finite differenced tangent stiffness matrix? (flag)",
        "tngt_stf_comp": "Compare analytical finite differenced tangent stiffness matrix? (flag)",
        "tngt_stf_pert": "Perturbation size for finite differencing (-)",
        "tngt_stf_difftol": "Allowed relative difference of analytical and fd stiffness (-)",
    }
    heads = {"kp_xr": "(m)", "kp_yr": "(m)", "kp_zr": "(m)", "initial_twist": "(deg)"}
    points = np.column_stack([beam.axis - beam.axis[0], beam.twist])
    lines = [
        "--------- BEAMDYN with OpenFAST INPUT FILE ".ljust(RULE, "-"),
        "",
        _rule("SIMULATION CONTROL"),
        _entry("False", "Echo", 'Echo input data to "<RootName>.ech" (flag)'),
        _entry("True", "QuasiStaticInit", "Quasi-static pre-conditioning? (flag)"),
        _entry(0, "rhoinf", "Numerical damping parameter for generalized-alpha integrator"),
        _entry(2, "quadrature", "Quadrature method: 1=Gaussian; 2=Trapezoidal (switch)"),
        _entry(1, "refine", "Refinement factor for trapezoidal quadrature (-)"),
        *(_entry('"DEFAULT"', name, what) for name, what in defaults.items()),
        _entry("True", "RotStates", "Orient states in the rotating frame? (flag)"),
        _rule("GEOMETRY PARAMETER"),
        _entry(1, "member_total", "Total number of members (-)"),
        _entry(count, "kp_total", "Total number of key points (-)"),
        f"1 {count} - Member number; Number of key points in this member",
        *("  ".join(word.center(16) for word in row).rstrip() for row in (heads, heads.values())),
        *("  ".join(f"{value: .9e}" for value in row) for row in points),
        _rule("MESH PARAMETER"),
        _entry(ORDER, "order_elem", "Order of interpolation (basis) function (-)"),
        _rule("MATERIAL PARAMETER"),
        _entry(f'"{blade_file}"', "BldFile", "Name of file containing properties for blade"),
    ]
    if openfast < LATEST:
        lines += [
            _rule("PITCH ACTUATOR PARAMETERS"),
            _entry("False", "UsePitchAct", "Whether a pitch actuator should be used (flag)"),
            _entry(200, "PitchJ", "Pitch actuator inertia (kg-m^2)"),
            _entry(2e7, "PitchK", "Pitch actuator stiffness (kg-m^2/s^2)"),
            _entry(5e5, "PitchC", "Pitch actuator damping (kg-m^2/s)"),
        ]
    return [
        *lines,
        _rule("OUTPUTS"),
        _entry("False", "SumPrint", 'Print summary data to "<RootName>.sum" (flag)'),
        _entry('"ES10.3E2"', "OutFmt", "Format used for text tabular output"),
        _entry(0, "NNodeOuts", "Number of nodes to output to file [0 - 9] (-)"),
        _entry(1, "OutNd", "Nodes whose values will be output (-)"),
        "                       OutList - The next line(s) contains a list of output parameters",
        '"RootFxr, RootFyr, RootFzr"',
        '"RootMxr, RootMyr, RootMzr"',
        '"TipTDxr, TipTDyr, TipTDzr"',
        "END of input to output list",
        "-" * RULE,
    ]


def frequencies(beam: BeamProperties) -> tuple[float, float, float]:
    """Return the first flapwise, edgewise and torsional frequency of the straight beam [Hz]."""
    flap, _ = bending(beam.along, beam.flap, beam.mass, 1)
    edge, _ = bending(beam.along, beam.edge, beam.mass, 1)
    return (
        float(flap[0]),
        float(edge[0]),
        torsion(beam.along, beam.torsion, beam.inertia[:, 5, 5]),
    )


def _entry(value: object, name: str, meaning: str) -> str:
    return f"{value!s:<22} {name:<14} - {meaning}"


def _rule(title: str) -> str:
    return f"---------------------- {title} ".ljust(RULE, "-")
