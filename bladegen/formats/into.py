"""A blade put back into a full model of a tool, everything else of which stays as it is."""

from pathlib import Path

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import Finding
from bladegen.formats.hawc2.into import write_into_htc
from bladegen.formats.openfast.into import write_into_main
from bladegen.formats.proof import GRID, WHOLE, put_in_place, read_back, taken_back
from bladegen.formats.windio.into import write_into_turbine
from bladegen.support.files import require_suffix

__all__ = ["write_into"]

OTHERS = {".dat": write_into_main, ".htc": write_into_htc}
YAML = (".yaml", ".yml")


def write_into(definition: BladeDefinition, turbine: Path, path: Path) -> tuple[Finding, ...]:
    """Write a turbine file with its blade replaced, in the windIO version that it is in.

    AeroDyn's main input and an htc file of HAWC2 are turbine files too, as OTHERS has them.

    Parameters
    ----------
    definition : BladeDefinition
        The blade.
    turbine : Path
        The full turbine file of windIO, AeroDyn's main input (.dat), or an htc file.
    path : Path
        Where to; may be `turbine` itself.

    Returns
    -------
    tuple of Finding
        What the version cannot hold, and what of the turbine may no longer fit the blade.

    Raises
    ------
    FileError
        If the turbine file cannot be read or holds no blade.
    ExportError
        If the file with the blade in it cannot be read, by what was wrong before or else.
    """
    own = turbine.suffix.lower()
    require_suffix(path, YAML if own in YAML else (own,))
    other = OTHERS.get(own)
    if other is not None:
        with taken_back(path):
            said = other(definition, turbine, path)
            partly = any(finding.where == "aero" for finding in said)
            if partly or path.parent.resolve() != turbine.parent.resolve():
                return said  # names lead to files that are elsewhere
            return said + read_back(path, path, definition, GRID)
    with put_in_place(path) as draft:
        said = write_into_turbine(definition, turbine, draft)
        return said + read_back(draft, path, definition, WHOLE, turbine)
