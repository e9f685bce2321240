"""What bladegen does with actuator lines; what does it is imported when it is asked for."""

from pathlib import Path

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import Finding
from bladegen.formats.format import Format, Writer

__all__ = ["FORMAT"]


def _turbines_foam(definition: BladeDefinition, path: Path) -> tuple[Finding, ...]:
    from bladegen.formats.actuator_lines.turbines_foam import write

    return write(definition, path)


def _sowfa(definition: BladeDefinition, path: Path) -> tuple[Finding, ...]:
    from bladegen.formats.actuator_lines.sowfa import write

    return write(definition, path)


FORMAT = Format(
    "actuator lines",
    writers=(
        Writer(
            "turbinesfoam",
            "turbinesFoam (a folder: elementData, elementProfiles, profileData)",
            ("",),
            _turbines_foam,
            polars=True,
            tolerance=None,
        ),
        Writer(
            "sowfa",
            "SOWFA (a folder: turbineProperties, airfoilProperties)",
            ("",),
            _sowfa,
            polars=True,
            tolerance=None,
        ),
    ),
)
