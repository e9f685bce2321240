"""A differentiable blade as a component of OpenMDAO, with exact partial derivatives.

In: the parameters, as one vector or one input a kind.  Out: sections [m] and quantities by name
in metres and radians.  The extra `openmdao` installs the library.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from bladegen.errors import MissingLibraryError, PerturbationError
from bladegen.parametric.adapters.outputs import SECTIONS, UNITS, Evaluated, Outputs, follows
from bladegen.parametric.model import ParametricBlade
from bladegen.support.arrays import Array

try:
    from openmdao.api import ExplicitComponent
except ImportError as error:
    raise MissingLibraryError(error) from None

__all__ = ["BladeComponent"]

WHOLE = "x"


class BladeComponent(ExplicitComponent):  # type: ignore[misc]
    """The outputs of a blade's parameters.

    Parameters
    ----------
    model : ParametricBlade
        The blade; its `lower` and `upper` are the bounds for a driver.
    outputs : sequence of str
        "sections" (k, n, 3) or names of `Quantities`, each with its units.
    split : bool
        One input a kind of parameter in place of "x": "x_pga", "x_chord", "x_twist" [rad] and so
        on, each with its knots in the model's order; `places` says where they stand in x.
    matrix_free : bool, optional
        Whether derivatives are products along the chain, and no partials are kept.  By default
        they are where "sections" is an output: its partials are 10^6 numbers and more.

    Examples
    --------
    ``problem.model.add_subsystem("blade", BladeComponent(model, ("volume", "section_area")))``
    """

    def __init__(
        self,
        model: ParametricBlade,
        outputs: tuple[str, ...] = ("volume", "area"),
        *,
        split: bool = False,
        matrix_free: bool | None = None,
        **options: Any,
    ) -> None:
        super().__init__(**options)
        self.blade, self.made = model, Outputs(model, outputs)
        self.places = _places(model) if split else {WHOLE: np.arange(len(model.names))}
        self.matrix_free = SECTIONS in self.made.names if matrix_free is None else matrix_free

    def setup(self) -> None:
        """Declare inputs, outputs and partials."""
        for name, place in self.places.items():
            units = "rad" if name == "x_twist" else None
            self.add_input(name, self.blade.baseline[place], units=units)
        for output, shape in self.made.shapes.items():
            self.add_output(output, shape=shape or (1,), units=UNITS.get(output))
            given = [name for name in self.places if follows(output, name.removeprefix("x_"))]
            self.declare_partials(output, given)

    def _at(self, inputs: Mapping[str, Array]) -> Evaluated:
        x = np.empty(len(self.blade.names))
        for name, place in self.places.items():
            given = np.asarray(inputs[name])
            if np.iscomplexobj(given):
                raise PerturbationError(
                    f"{self.pathname}: got complex inputs; its partials are exact, check them with "
                    "check_partials(method='fd')"
                )
            x[place] = given
        return self.made.at(x)

    def compute(self, inputs: Mapping[str, Array], outputs: dict[str, Array], *_: Any) -> None:
        """Set the outputs."""
        here = self._at(inputs)
        for name in self.made.names:
            outputs[name] = here.value(name)

    def compute_partials(
        self, inputs: Mapping[str, Array], partials: dict[Any, Array], *_: Any
    ) -> None:
        """Set the partials of outputs in inputs."""
        here = self._at(inputs)
        for name in self.made.names:
            jacobian = here.jacobian(name).reshape(-1, len(self.blade.names))
            for given, place in self.places.items():
                if (name, given) in partials:
                    partials[name, given] = jacobian[:, place]

    def compute_jacvec_product(
        self,
        inputs: Mapping[str, Array],
        d_inputs: Mapping[str, Array],
        d_outputs: Mapping[str, Array],
        mode: str,
    ) -> None:
        """Add products with the partials to outputs ("fwd") or to inputs ("rev")."""
        here = self._at(inputs)
        for name in (name for name in self.made.names if name in d_outputs):
            shape = self.made.shapes[name]
            if mode == "fwd":
                dx = np.zeros(len(self.blade.names))
                for given in (given for given in self.places if given in d_inputs):
                    dx[self.places[given]] = d_inputs[given]
                d_outputs[name] += here.along(name, dx).reshape(d_outputs[name].shape)
            else:
                gradient = here.back(name, np.asarray(d_outputs[name]).reshape(shape))
                for given in (given for given in self.places if given in d_inputs):
                    d_inputs[given] += gradient[self.places[given]]


def _places(model: ParametricBlade) -> dict[str, Array]:
    """Return where the parameters of each kind stand in x."""
    kinds = [name.partition(" at ")[0].partition("[")[0] for name in model.names]
    found = {kind: [i for i, other in enumerate(kinds) if other == kind] for kind in kinds}
    return {f"x_{kind}": np.array(places) for kind, places in found.items()}
