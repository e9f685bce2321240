"""Where commands write: folders and files, refused if their names say another kind of file."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["FamilyTarget", "Target", "each_ending_in", "ending_in"]

STORE = re.compile(r"[a-z][a-z0-9+.-]+:/", re.IGNORECASE)  # s3://bucket, as a Path shows it


def ending_in(*suffixes: str) -> Callable[[typer.CallbackParam, Path | None], Path | None]:
    """Return a callback that refuses an output file whose suffix says another kind of file."""

    def checked(param: typer.CallbackParam, value: Path | None) -> Path | None:
        from bladegen.support.files import require_suffix

        if value is not None:
            require_suffix(value, suffixes, param.opts[-1])
        return value

    return checked


def each_ending_in(*suffixes: str) -> Callable[..., list[Path] | None]:
    """Return a callback that refuses any of several output files as `ending_in` does."""
    one = ending_in(*suffixes)

    def checked(param: typer.CallbackParam, values: list[Path] | None) -> list[Path] | None:
        for value in values or ():
            one(param, value)
        return values

    return checked


def _folder(param: typer.CallbackParam, value: Path) -> Path:
    """Refuse a file's name, or an object store, where a folder is meant."""
    from bladegen.errors import ExportError

    if STORE.match(str(value)):
        raise ExportError(
            f"{param.opts[-1]}: got {value}, must be a folder of this machine; only `bladegen "
            "family` writes into object stores; copy it from there (aws s3 sync, gsutil rsync)"
        )
    return _no_file(param, value)


def _no_file(param: typer.CallbackParam, value: Path) -> Path:
    """Refuse a file's name where a folder is meant."""
    from bladegen.errors import ExportError
    from bladegen.exports.registry import FORMATS

    suffix = next((one for one in FORMATS if value.name.lower().endswith(one)), "")
    if suffix and not value.is_dir():
        raise ExportError(
            f"{param.opts[-1]}: got {value}, must be a folder; such as -o {value.parent} "
            f"--format {suffix.lstrip('.')}"
        )
    return value


def _family(param: typer.CallbackParam, value: str) -> str:
    """Refuse a file's name where a family's folder is meant."""
    _no_file(param, Path(value))
    return value


FamilyTarget = Annotated[
    str,
    typer.Option(
        "-o",
        "--output",
        metavar="PATH",
        help="Folder for the family, or a place in an object store: s3://BUCKET/FOLDER, gs://...",
        callback=_family,
    ),
]
Target = Annotated[
    Path, typer.Option("-o", "--output", help="Folder for the files.", callback=_folder)
]
