"""A whole blade in OpenMDAO: the most power from shape, twist and chord at three spans each.

    python examples/rotor_power.py [FILE.png]

Power is that of blade-element momentum theory at one tip-speed ratio, with NeuralFoil's lift and
drag.  The volume between these spans stays below the baseline's, and relative thicknesses within
5 % of the baseline's.  Partials are exact in every component: bladegen's, and here through the
equation for the inflow angle by the implicit function theorem.
"""

import sys
from pathlib import Path

import casadi
import numpy as np
import openmdao.api as om

import bladegen as bg
from bladegen.neuralfoil import coefficients
from bladegen.openmdao import BladeComponent
from bladegen.views.plots import figures, style

BLADES, RATIO, REYNOLDS, NETWORK = 3, 9.0, 1e7, "medium"
SPANS = np.linspace(0.25, 0.97, 10)
KNOTS = [0.3, 0.6, 0.9]
BOUNDS = {"pga": (-0.05, 0.05), "twist": (-0.06, 0.06), "chord": (0.8, 1.2)}
BLADE = bg.Blade.from_definition(bg.read("iea15mw"), landmarks=101)
HUB = BLADE.definition.rotor.hub_radius
RADIUS = HUB + BLADE.definition.length
AXES = BLADE.planform.frames(SPANS)[:, [1, 0]]  # (k, 2, 3), of the sections' planes, in space


def momentum() -> casadi.Function:
    """Return the equation for the inflow angle, and power, of an annulus, with derivatives.

    S. A. Ning, Wind Energy 17 (2014): one equation in one unknown; tip loss after Prandtl.
    """
    phi, lift, drag, chord, r = (casadi.SX.sym(name) for name in ("phi", "cl", "cd", "c", "r"))
    sine, cosine, speed = casadi.sin(phi), casadi.cos(phi), RATIO * r / RADIUS
    loss = 2 / np.pi * casadi.acos(casadi.exp(-BLADES / 2 * (RADIUS - r) / (r * sine)))
    solidity = BLADES * chord / (2 * np.pi * r)
    turning = lift * sine - drag * cosine
    axial = solidity * (lift * cosine + drag * sine) / (4 * loss * sine**2)
    swirl = solidity * turning / (4 * loss * sine * cosine)
    equation = sine * (1 + axial) - cosine * (1 - swirl) / speed
    power = BLADES * chord * turning * speed / ((1 + axial) * sine) ** 2 / (np.pi * RADIUS**2)
    both = casadi.vertcat(equation, power)
    given = casadi.vertcat(phi, lift, drag, chord)
    return casadi.Function("momentum", [given, r], [both, casadi.jacobian(both, given)])


class Rotor(om.ExplicitComponent):
    """Power coefficient of sections along the span."""

    def setup(self) -> None:
        """Declare what goes in and out."""
        self.radii, self.annulus = HUB + SPANS * BLADE.definition.length, momentum()
        self.weights = np.gradient(self.radii)
        self.weights[[0, -1]] /= 2.0  # the trapezoidal rule
        self.add_input("sections", shape=(len(SPANS), 101, 3), units="m")
        self.add_input("chord", shape=len(SPANS), units="m")
        self.add_input("twist", shape=len(SPANS), units="rad")
        self.add_output("power")
        self.declare_partials("*", "*")

    def solved(self, inputs: dict) -> tuple:
        """Solve for the inflow angles by Newton's method, from those of an ideal rotor."""
        phi = np.arctan(2.0 / 3.0 / (RATIO * self.radii / RADIUS))
        points = np.einsum("knx,kix->kni", inputs["sections"], AXES)
        for _ in range(30):
            found = coefficients(points, phi - inputs["twist"], REYNOLDS, size=NETWORK)
            given = np.stack([phi, *found.values[:, :2].T, inputs["chord"]])
            both, slopes = (np.array(part) for part in self.annulus(given, self.radii[None]))
            slopes = slopes.reshape(2, len(SPANS), 4)
            # lift and drag follow the inflow angle, too
            whole = slopes[..., 0] + np.sum(slopes[..., 1:3] * found.in_alpha[:, :2], axis=-1)
            step = both[0] / whole[0]
            if np.abs(step).max() < 1e-12:
                break
            phi = np.clip(phi - np.clip(step, -0.1, 0.1), 0.02, 1.0)
        return found, both[1], slopes, whole

    def compute(self, inputs: dict, outputs: dict) -> None:
        """Set the power."""
        outputs["power"] = self.weights @ self.solved(inputs)[1]

    def compute_partials(self, inputs: dict, partials: dict) -> None:
        """Set the partials: power follows the inputs, and the angles that solve the equation."""
        found, _, slopes, whole = self.solved(inputs)
        of = self.weights[:, None] * (slopes[1] - (whole[1] / whole[0])[:, None] * slopes[0])
        in_points = np.einsum("kq,kqni->kni", of[:, 1:3], found.in_points[:, :2])
        partials["power", "sections"] = np.einsum("kni,kix->knx", in_points, AXES).ravel()
        partials["power", "twist"] = -np.sum(of[:, 1:3] * found.in_alpha[:, :2], axis=1)
        partials["power", "chord"] = of[:, 3]


def problem() -> om.Problem:
    """Return the problem, set up."""
    kinds = [(kind, KNOTS) for kind in BOUNDS]
    model = bg.ParametricBlade(BLADE, bg.ShapeSpace.bundled(), kinds, SPANS, bounds=BOUNDS)
    first = model.quantities(model.baseline)
    outputs = ("sections", "chord", "twist", "relative_thickness", "volume")
    made = om.Problem(reports=False)
    made.model.add_subsystem("blade", BladeComponent(model, outputs), promotes=["*"])
    made.model.add_subsystem("rotor", Rotor(), promotes=["*"])
    made.model.add_design_var("x", lower=model.lower, upper=model.upper)
    thickness = first["relative_thickness"]
    made.model.add_constraint("relative_thickness", lower=0.95 * thickness, upper=1.05 * thickness)
    made.model.add_constraint("volume", upper=first["volume"], ref=100.0)
    made.model.add_objective("power", ref=-0.1)
    made.driver = om.ScipyOptimizeDriver(optimizer="SLSQP", tol=1e-6, maxiter=60, disp=False)
    made.setup(mode="rev")
    return made


def main(target: Path) -> None:
    """Solve; draw planform and sections, before and after."""
    made = problem()
    made.run_model()
    names = ("sections", "chord", "twist", "power", "volume")
    before = {name: made[name].copy() for name in names}
    made.run_driver()
    after = {name: made[name] for name in names}
    drawn, ((left, middle, right),) = figures.figure(1, 3, width=12, height=3.4)
    for found, colour, label in (
        (before, style.BASELINE, "baseline"),
        (after, style.VARIANT, "best"),
    ):
        left.plot(SPANS, found["chord"], ".-", color=colour, label=label)
        middle.plot(SPANS, np.degrees(found["twist"]), ".-", color=colour)
        flat = np.einsum("knx,kix->kni", found["sections"], AXES)[::3]
        for row, xy in enumerate((flat - flat[:, 50:51]) / found["chord"][::3, None, None]):
            right.plot(xy[:, 0], xy[:, 1] - 0.4 * row, color=colour)
    left.set(xlabel="span fraction", title="chord, m")
    left.legend()
    middle.set(xlabel="span fraction", title="twist, degrees")
    right.set(aspect="equal", yticks=[], xlabel="chords", title="sections, root above")
    figures.save_figure(drawn, target)
    power, volume = ((before[n].item(), after[n].item()) for n in ("power", "volume"))
    print(
        f"wrote {target}; power coefficient {power[0]:.4f} to {power[1]:.4f}, volume "
        f"{volume[0]:.1f} to {volume[1]:.1f} m3, {made.driver.result.model_evals} evaluations"
    )


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "rotor_power.png"))
