"""bladegen: wind turbine blades from spanwise tables to STEP solids and meshes.

>>> import bladegen as bg
>>> definition = bg.read("iea15mw")
>>> blade = bg.Blade.from_definition(definition, landmarks=401)
>>> blade.sections([0.0, 0.5, 1.0]).shape
(3, 401, 3)

The names below are loaded when first used, so that ``import bladegen`` stays fast.
"""

from importlib import import_module
from logging import NullHandler, getLogger
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from bladegen.blade import Blade
    from bladegen.definition import (
        Airfoil,
        BladeDefinition,
        Distribution,
        ReferenceAxis,
        Rotor,
        Station,
    )
    from bladegen.deformation import Coordinates, Window
    from bladegen.errors import BladegenError, Finding
    from bladegen.exporters import export
    from bladegen.families import Family, family
    from bladegen.pga import ShapeSpace
    from bladegen.readers import bundled, read
    from bladegen.writers import write, write_airfoil

__version__ = "1.0.0"

getLogger(__name__).addHandler(NullHandler())  # who wants to hear more asks for it

_HOME = {
    "Airfoil": "definition",
    "Blade": "blade",
    "BladeDefinition": "definition",
    "BladegenError": "errors",
    "Coordinates": "deformation",
    "Distribution": "definition",
    "Family": "families",
    "Finding": "errors",
    "ReferenceAxis": "definition",
    "Rotor": "definition",
    "ShapeSpace": "pga",
    "Station": "definition",
    "Window": "deformation",
    "bundled": "readers",
    "export": "exporters",
    "family": "families",
    "read": "readers",
    "write": "writers",
    "write_airfoil": "writers",
}

__all__ = [
    "Airfoil",
    "Blade",
    "BladeDefinition",
    "BladegenError",
    "Coordinates",
    "Distribution",
    "Family",
    "Finding",
    "ReferenceAxis",
    "Rotor",
    "ShapeSpace",
    "Station",
    "Window",
    "__version__",
    "bundled",
    "export",
    "family",
    "read",
    "write",
    "write_airfoil",
]


_MODULES = ("affine", "grassmann")


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return import_module(f"bladegen.{name}")
    if name not in _HOME:
        raise AttributeError(f"module 'bladegen' has no attribute {name!r}")
    value = getattr(import_module(f"bladegen.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
