"""Turbine files in YAML or JSON: parsed once, then read in the windIO version they are in."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from bladegen.definition.blade_definition import Airfoil, BladeDefinition
from bladegen.errors import FileError, Finding
from bladegen.formats.common.document import Node, Notes
from bladegen.formats.windio import version1, version2
from bladegen.formats.windio.writing import Document, Note
from bladegen.formats.windio.yaml_file import YamlError, load_yaml

__all__ = ["MARK", "SUFFIXES", "VERSIONS", "Version", "read", "recognises"]


@dataclass(frozen=True)
class Version:
    """A layout of YAML documents: what it is, how to tell it, read it and make it."""

    name: str
    mark: str
    recognises: Callable[[object], bool]
    read: Callable[[Node, Path], BladeDefinition | None]
    document: Callable[[BladeDefinition, Note], Document]
    polars: Callable[[Airfoil], list[Document]]


VERSIONS = tuple(
    Version(
        f"windIO {module.LAYOUT.version}",
        f"components.blade.{module.LAYOUT.shape}",
        module.recognises,
        module.read,
        module.document,
        module.polars,
    )
    for module in (version2, version1)
)
MARK = " or ".join(f"{version.mark} ({version.name})" for version in VERSIONS)
SUFFIXES = (".yaml", ".yml", ".json")


def recognises(path: Path) -> bool:
    """Take every file of the suffixes: `read` says best what is wrong with one."""
    return path.suffix.lower() in SUFFIXES


def read(path: Path, notes: Notes, airfoils: Path | None = None) -> BladeDefinition | None:
    """Read a blade from a turbine file; its airfoils are in the file."""
    try:
        document, findings = load_yaml(path)
    except YamlError as error:
        raise FileError(str(path), [str(error)]) from None
    notes.findings.extend(findings)
    if airfoils is not None:
        notes.findings.append(
            Finding("airfoils", f"are in the file itself; {airfoils} is passed over")
        )
    root = Node(document, "", notes)
    if document is None:
        root.problem("is empty, must hold a turbine in the layout of windIO")
        return None
    for version in VERSIONS:
        if version.recognises(document):
            definition = version.read(root, path)
            return None if definition is None else replace(definition, format=version.name)
    root.problem(f"holds no blade that is known, must hold {MARK}")
    return None
