"""bladegen: wind turbine blades from spanwise tables to STEP solids and meshes.

>>> import bladegen as bg
>>> definition = bg.read("iea15mw")
>>> blade = bg.Blade.from_definition(definition, landmarks=401)
>>> blade.sections([0.0, 0.5, 1.0]).shape
(3, 401, 3)

The names below are loaded when first used, so that ``import bladegen`` stays fast.
"""

from collections.abc import Callable
from importlib import import_module
from logging import NullHandler, getLogger
from typing import TYPE_CHECKING, Any

from bladegen.support.services import provide
from bladegen.version import __version__

if TYPE_CHECKING:
    from bladegen.blade.blade import Blade
    from bladegen.blade.changes.deformation import Coordinates, Window
    from bladegen.definition.blade_definition import (
        Airfoil,
        BladeDefinition,
        Distribution,
        ReferenceAxis,
        Rotor,
        Station,
    )
    from bladegen.definition.fair_planform import PlanformFairing
    from bladegen.definition.structure.structure import Layer, Material, Structure, Web
    from bladegen.errors import BladegenError, Finding
    from bladegen.exports.definitions import write
    from bladegen.exports.exporters import export
    from bladegen.families.dataset.loading import load_family
    from bladegen.families.family import Family, family
    from bladegen.fitting.deviations import DeviationMap
    from bladegen.fitting.fit import fit
    from bladegen.fitting.fitted import Fitted
    from bladegen.formats.airfoils.writing import write_airfoil
    from bladegen.formats.bundled import bundled
    from bladegen.formats.reading import read
    from bladegen.parametric.model import ParametricBlade
    from bladegen.shapes.shape_space import ShapeSpace
    from bladegen.shapes.statistics.two_samples import TwoSamples, two_samples

getLogger(__name__).addHandler(NullHandler())  # who wants to hear more asks for it

_HOME = {
    "Airfoil": "definition.blade_definition",
    "Blade": "blade.blade",
    "BladeDefinition": "definition.blade_definition",
    "BladegenError": "errors",
    "Coordinates": "blade.changes.deformation",
    "DeviationMap": "fitting.deviations",
    "Distribution": "definition.distribution",
    "Family": "families.family",
    "Finding": "errors",
    "Fitted": "fitting.fitted",
    "Layer": "definition.structure.structure",
    "Material": "definition.structure.structure",
    "ParametricBlade": "parametric.model",
    "PlanformFairing": "definition.fair_planform",
    "ReferenceAxis": "definition.blade_definition",
    "Rotor": "definition.rotor",
    "ShapeSpace": "shapes.shape_space",
    "Station": "definition.blade_definition",
    "Structure": "definition.structure.structure",
    "TwoSamples": "shapes.statistics.two_samples",
    "Web": "definition.structure.structure",
    "Window": "blade.changes.deformation",
    "bundled": "formats.bundled",
    "export": "exports.exporters",
    "family": "families.family",
    "fit": "fitting.fit",
    "load_family": "families.dataset.loading",
    "read": "formats.reading",
    "two_samples": "shapes.statistics.two_samples",
    "write": "exports.definitions",
    "write_airfoil": "formats.airfoils.writing",
}

__all__ = [
    "Airfoil",
    "Blade",
    "BladeDefinition",
    "BladegenError",
    "Coordinates",
    "DeviationMap",
    "Distribution",
    "Family",
    "Finding",
    "Fitted",
    "Layer",
    "Material",
    "ParametricBlade",
    "PlanformFairing",
    "ReferenceAxis",
    "Rotor",
    "ShapeSpace",
    "Station",
    "Structure",
    "TwoSamples",
    "Web",
    "Window",
    "__version__",
    "bundled",
    "export",
    "family",
    "fit",
    "load_family",
    "read",
    "two_samples",
    "write",
    "write_airfoil",
]


_MODULES = ("affine", "grassmann")
_SERVICES = {  # what values offer, and the modules that do it
    "blade_html": "views.notebook",
    "definition_html": "views.notebook",
    "export": "exports.exporters",
    "family_html": "views.notebook",
    "layup": "blade.layup.layup",
    "plot_blade": "exports.pictures",
    "space_html": "views.notebook",
    "trimesh_of": "surface.mesh_files",
    "volume": "measures.properties",
}


def _finder(name: str, home: str) -> Callable[[], Any]:
    return lambda: getattr(import_module(f"bladegen.{home}"), name)


for _name, _home in _SERVICES.items():
    provide(_name, _finder(_name, _home))


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
