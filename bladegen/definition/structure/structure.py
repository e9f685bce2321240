"""Materials, webs and layers of a blade, as windIO has them, in SI units and radians."""

from collections import Counter
from dataclasses import dataclass

from bladegen.definition.distribution import Distribution
from bladegen.definition.structure.positions import Position, around
from bladegen.errors import DefinitionError
from bladegen.support.values import brief

__all__ = ["Layer", "Material", "Stated", "Structure", "Web"]

Axes = tuple[float, float, float]
Stated = tuple[Distribution | None, Distribution | None]
NOTHING: Stated = (None, None)


@dataclass(frozen=True, repr=False)
class Material:
    """A material, along its fibres, across them, and through the thickness.

    Parameters
    ----------
    name : str
    density : float
        [kg/m3]
    E, G : tuple of 3 float, optional
        Moduli in directions 1, 2, 3, and 12, 13, 23 [Pa]; one figure three times if isotropic.
    nu : tuple of 3 float, optional
        Poisson's ratios 12, 13, 23.
    tensile, compressive, shear : tuple of 3 float, optional
        Strengths [Pa].
    ply_thickness : float, optional
        [m]
    orthotropic : bool
        Whether the directions differ.
    others : tuple of (str, value)
        What else the file says of it, under its own names: cost, waste, fatigue, source.
    """

    name: str
    density: float
    E: Axes | None = None
    G: Axes | None = None
    nu: Axes | None = None
    tensile: Axes | None = None
    compressive: Axes | None = None
    shear: Axes | None = None
    ply_thickness: float | None = None
    orthotropic: bool = False
    others: tuple[tuple[str, str | float | tuple[float, ...]], ...] = ()

    __repr__ = brief


@dataclass(frozen=True, repr=False)
class Web:
    """A plane wall between two places on the skin.

    Parameters
    ----------
    name : str
    start, end : Position
        On the suction and on the pressure side.
    extent : pair of float
        Span fractions between which it stands.
    stated : pair of Distribution or None
        Fractions of the arc that the file gives besides its rule: what its own tool found.
    """

    name: str
    start: Position
    end: Position
    extent: tuple[float, float] = (0.0, 1.0)
    stated: Stated = NOTHING

    __repr__ = brief


@dataclass(frozen=True, repr=False)
class Layer:
    """A layer of one material, on the skin or on a web.

    Parameters
    ----------
    name, material : str
        Its own name, and its material's.
    thickness : Distribution
        [m]
    start, end : Position
        On the skin; on a web fractions of its height, from the suction side.
    angle : Distribution, optional
        Of the fibres to the span [rad], positive toward the leading edge as seen from the root.
    web : str
        The web it lies on, "" for the skin.
    extent : pair of float
        Span fractions between which it lies: nothing of it is outside.
    stated : pair of Distribution or None
        Fractions of the arc that the file gives besides its rule.
    """

    name: str
    material: str
    thickness: Distribution
    start: Position
    end: Position
    angle: Distribution | None = None
    web: str = ""
    extent: tuple[float, float] = (0.0, 1.0)
    stated: Stated = NOTHING

    __repr__ = brief

    @property
    def around(self) -> bool:
        """Whether it lies around the trailing edge, from the pressure to the suction side."""
        return not self.web and around(self.start, self.end)


@dataclass(frozen=True, repr=False)
class Structure:
    """What lies inside the skin of a blade.

    Parameters
    ----------
    materials : tuple of Material
        At least those of the layers; of resin and adhesive tools ask what they weigh and cost.
    webs : tuple of Web
    layers : tuple of Layer
        From the outside to the inside, in the order of the file.
    """

    materials: tuple[Material, ...]
    webs: tuple[Web, ...]
    layers: tuple[Layer, ...]

    def __post_init__(self) -> None:
        for kind in ("materials", "webs", "layers"):
            names = Counter(part.name for part in getattr(self, kind))
            for name, count in names.items():
                if count > 1:
                    raise DefinitionError(
                        f"structure: {kind}: {name} stands {count} times, allowed is once"
                    )
        materials = self.by_name
        webs = {web.name for web in self.webs}
        for layer in self.layers:
            if layer.material not in materials:
                raise DefinitionError(
                    f"structure: layer {layer.name}: material {layer.material} is not among "
                    f"{', '.join(sorted(materials))}"
                )
            if layer.web and layer.web not in webs:
                raise DefinitionError(
                    f"structure: layer {layer.name}: web {layer.web} is not among "
                    f"{', '.join(sorted(webs))}"
                )

    def __repr__(self) -> str:
        return (
            f"<Structure of {len(self.webs)} webs, {len(self.layers)} layers, "
            f"{len(self.materials)} materials>"
        )

    @property
    def by_name(self) -> dict[str, Material]:
        """The materials by name."""
        return {material.name: material for material in self.materials}
