"""What one call of `Blade.perturbed` asks for, and what that does to a blade's values.

Shape moves along the modes of a space, the same at every span; thickness, chord, twist and
prebend move by the paper's affine parameters.  A `Perturbation` takes a `Shape` to a shape and a
`BladeDefinition` to a definition; what it does not touch stays the same value.
"""

from dataclasses import dataclass, replace
from typing import Any, TypedDict, TypeVar

from bladegen.airfoils.chord_lines import KEPT
from bladegen.blade.changes.deformation import (
    RANGES,
    AffineChange,
    Coordinates,
    Deformation,
    Thickening,
    Window,
    deformation_of,
    in_units,
)
from bladegen.blade.shape import Shape
from bladegen.definition.blade_definition import BladeDefinition, Distribution
from bladegen.errors import PerturbationError
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arguments import amount, instance, numbers, shown
from bladegen.support.arrays import ArrayLike

__all__ = ["PERTURBED", "Perturbation", "Where", "change_of", "deviated", "together", "told"]

PERTURBED = "; perturbed: "  # ahead of what one call of `perturbed` asked for

Own = TypeVar("Own")
CALL = "call perturbed(space, [t1, t2, ...]), with space = bladegen.ShapeSpace.bundled()"


class Where(TypedDict, total=False):
    """Where a perturbation acts and how far it may go: see `Blade.perturbed`."""

    window: Window | None
    chord_line: str
    allow_extrapolation: bool


@dataclass(frozen=True, eq=False)
class Perturbation:
    """What is asked of a blade.

    Parameters
    ----------
    change : AffineChange
        The affine parameters and scalings.
    window : Window
        Where shape, thickness, camber, chord and twist change.
    deformation : Deformation, optional
        What is done to shapes.
    """

    change: AffineChange
    window: Window
    deformation: Deformation | None = None

    @classmethod
    def of(
        cls,
        shape: Shape,
        definition: BladeDefinition,
        space: ShapeSpace | None,
        t: ArrayLike | Coordinates,
        change: AffineChange,
        *,
        window: Window | None = None,
        chord_line: str = KEPT,
        allow_extrapolation: bool = False,
    ) -> "Perturbation":
        """Return what is asked of a shape and a definition, or say what is not allowed."""
        if window is None:
            window = Window.beyond_circles(definition.stations)
        instance(window, Window, "window", "a bladegen.Window(start, end)", PerturbationError)
        coordinates = t if isinstance(t, Coordinates) else Coordinates.constant(t)
        if not coordinates.values.size:
            return cls(change, window)
        deformation = deformation_of(
            space,
            coordinates,
            window,
            shape.loft.u,
            allow_extrapolation=allow_extrapolation,
            chord_line=chord_line,
        )
        return cls(change, window, deformation)

    @property
    def asked(self) -> dict[str, Any]:
        """What is changed, by name, to be told."""
        asked: dict[str, Any] = self.change.changed()
        if self.deformation is not None:
            t = self.deformation.t
            asked |= {"pga": t.values.tolist(), "pga_at_eta": t.grid.tolist()}
            line = self.deformation.chord_line
            asked |= {} if line == KEPT else {"chord_line": line}
        return asked | {"window": [self.window.start, self.window.end]}

    def defined(self, definition: BladeDefinition, name: str | None) -> BladeDefinition:
        """Return a definition changed, and of another name if one is given."""
        if name is not None:
            instance(name, str, "name", "a text", PerturbationError)
        changed = self.change.applied(definition, self.window)
        return replace(changed, name=name or definition.name)

    def shaped(self, shape: Shape) -> Shape:
        """Return a shape deformed and thickened; its loft is the same."""
        thickening = Thickening(self.change.rule("thickening"), self.window)
        if self.deformation is None and thickening.factor == 1.0:
            return shape
        return replace(
            shape,
            deformations=shape.deformations + ((self.deformation,) if self.deformation else ()),
            thickenings=shape.thickenings + ((thickening,) if thickening.factor != 1.0 else ()),
        )


def change_of(*amounts: float | Distribution, prebend: Distribution | None = None) -> AffineChange:
    """Return affine parameters in the order of `AffineChange`, or say which is no number."""

    def known(key: str, value: float | Distribution) -> float | Distribution:
        over = isinstance(value, Distribution)
        return value if over else amount(value, key, PerturbationError)

    plain: Any = {key: known(key, a) for key, a in zip(RANGES, amounts, strict=True)}
    return AffineChange(**plain, prebend=prebend)


def together(space: Any, t: Any) -> tuple[ShapeSpace | None, Coordinates]:
    """Return a space and coordinates that were given together, or neither."""
    if space is not None and not isinstance(space, ShapeSpace):
        raise PerturbationError(f"space: got {shown(space)}, must be a ShapeSpace; {CALL}")
    if not isinstance(t, Coordinates):
        values = numbers(() if t is None else t, "t", PerturbationError)
        t = Coordinates.constant(values)
    if space is not None and not t.values.size:
        raise PerturbationError(f"t: got no coordinates for the shape space; {CALL}")
    if space is None and t.values.size:
        raise PerturbationError(f"t: coordinates need a shape space; {CALL}")
    return space, t


def told(change: dict[str, Any]) -> str:
    """Return in a few words what one call of `perturbed` asked for."""
    asked = [in_units(key, value) for key, value in change.items() if isinstance(value, float)]
    names = [key for key, value in change.items() if isinstance(value, float)]
    words = [f"{name} {value}" for name, value in zip(names, asked, strict=True)]
    words += [f"{name} over span" for name, value in change.items() if isinstance(value, dict)]
    rows = change.get("pga", [])
    if rows:
        first = ", ".join(f"{value:.4g}" for value in rows[0])
        words.insert(0, f"t {first}" if len(rows) == 1 else f"t at {len(rows)} spans")
    return f"{PERTURBED}{', '.join(words) or 'by nothing'}"


def deviated(blade: Own, deviation: Any) -> Own:
    """Return a blade with a deviation on its skin, or say that it is none."""
    if deviation is None:
        return blade
    if not callable(getattr(deviation, "applied", None)):
        raise PerturbationError(
            f"deviation: got {shown(deviation)}, must be a bladegen.DeviationMap, such as "
            "bladegen.DeviationMap.erosion(blade, start=0.7, end=0.98, width=0.03, depth=0.004)"
        )
    made: Own = deviation.applied(blade)
    return made
