"""What bladegen does with windIO turbine files."""

from pathlib import Path

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import Finding
from bladegen.formats.format import Format, PutBack, Reader, Writer
from bladegen.formats.windio import turbine_file, version1, version2

__all__ = ["FORMAT"]

YAML = (".yaml", ".yml")


def _into(definition: BladeDefinition, turbine: Path, path: Path) -> tuple[Finding, ...]:
    from bladegen.formats.windio.into import write_into_turbine

    return write_into_turbine(definition, turbine, path)


FORMAT = Format(
    "windIO",
    Reader(turbine_file.SUFFIXES, turbine_file.MARK, turbine_file.recognises, turbine_file.read),
    (
        Writer("windio2", "windIO 2", YAML, version2.write, polars=True, structure=True),
        Writer("windio1", "windIO 1", YAML, version1.write, polars=True, structure=True),
    ),
    put_back=PutBack(YAML, _into),
    alone=True,
)
