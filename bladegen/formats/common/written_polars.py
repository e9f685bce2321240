"""What writers ask of a blade's polars."""

from pathlib import Path

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.blending import without_polars
from bladegen.errors import ExportError

__all__ = ["require_polars"]

SHOWN = 4  # airfoils that a message names


def require_polars(definition: BladeDefinition, path: Path, tool: str) -> None:
    """Raise unless all airfoils of a blade have polars, without which a tool does not run.

    Raises
    ------
    ExportError
        If some have none.
    """
    bare = without_polars(definition)
    if bare:
        raise ExportError(
            f"{path}: {tool} needs polars, {', '.join(bare[:SHOWN])} have none; --polars estimate "
            "makes some"
        )
