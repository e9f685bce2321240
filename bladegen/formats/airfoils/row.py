"""What bladegen does with folders of airfoil files, which hold no blade."""

from functools import partial
from pathlib import Path

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import Finding
from bladegen.formats.format import Format, Writer

__all__ = ["FORMAT"]


def _write(definition: BladeDefinition, path: Path, layout: str) -> tuple[Finding, ...]:
    from bladegen.formats.airfoils.writing import write_folder

    return write_folder(definition, path, layout)


FORMAT = Format(
    "airfoil files",
    writers=tuple(
        Writer(
            name,
            f"a folder of airfoil files ({name.title()})",
            ("",),
            partial(_write, layout=name),
            tolerance=None,
        )
        for name in ("selig", "lednicer")
    ),
)
