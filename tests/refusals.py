"""What reading a file is answered with: its problems, or the findings on what was read."""

from pathlib import Path

import pytest

import bladegen as bg
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import FileError


def problems(path: Path, **options: object) -> str:
    """The problems for which a file is refused."""
    with pytest.raises(FileError) as caught:
        bg.read(path, **options)
    return "; ".join(caught.value.problems)


def findings(definition: BladeDefinition) -> str:
    """What was mended or looks odd."""
    return "; ".join(str(finding) for finding in definition.findings)
