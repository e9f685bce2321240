"""The command `bladegen convert`: a blade from one file format to another."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from bladegen.cli.options.common import Airfoils, BladeName, Polars, Reynolds
from bladegen.cli.options.groups import COMMAND, grouped
from bladegen.cli.terminal import print_findings, print_table, progress_bar

__all__ = ["convert"]


@grouped
def convert(
    source: BladeName,
    target: Annotated[
        Path,
        typer.Argument(
            metavar="DST", help="The file to write; without a suffix, a folder of airfoil files."
        ),
    ],
    to: Annotated[
        str | None,
        typer.Option(metavar="FORMAT", help="The format to write; by the suffix if not given."),
    ] = None,
    into: Annotated[
        Path | None,
        typer.Option(
            help="A full turbine file of windIO, AeroDyn's main input or an htc file: DST is that "
            "one with this blade in it."
        ),
    ] = None,
    polars: Polars = None,
    reynolds: Reynolds = None,
    airfoils: Airfoils = None,
    nodes: Annotated[
        int | None,
        typer.Option(
            help="Of AeroDyn's blade file, even over span; as many as 0.5 mm needs if not given."
        ),
    ] = None,
    hub_radius: Annotated[
        str | None,
        typer.Option(
            metavar="LENGTH",
            help="From the axis to the root, instead of the definition's or where it has none; 2m.",
        ),
    ] = None,
) -> None:
    """Convert a blade between file formats, and say what the new one cannot hold."""
    from bladegen.cli.options.parsing import metres
    from bladegen.cli.options.variants import variant as variant_of
    from bladegen.errors import ExportError, Finding
    from bladegen.exports.definitions import write, write_into
    from bladegen.formats.into import with_polars_of
    from bladegen.formats.reading import read
    from bladegen.formats.writing import format_of, prepared

    if into is not None and to is not None:
        raise ExportError(
            "to: the format is that of the turbine file; leave one of --to, --into out"
        )
    row = format_of(target, to)
    with progress_bar() as progress:
        progress(f"reading {source}")
        variant = variant_of(source, None, plain=airfoils is None)
        definition = read(source, airfoils=airfoils) if variant is None else variant.definition
        if hub_radius is not None:
            given = metres(hub_radius, "hub-radius", example="2m")
            definition = replace(definition, rotor=replace(definition.rotor, hub_radius=given))
        what = definition if variant is None else replace(variant, definition=definition)
        ways: dict[str, Any] = {"polars": polars, "reynolds": reynolds, "progress": progress}
        if into is None:
            findings = write(
                what, target, format=row.name, command=COMMAND.get(), nodes=nodes, **ways
            )
            title = row.title
        else:
            kept: tuple[Finding, ...] = ()
            if variant is None and polars not in ("none", "estimate-all"):
                what, kept = with_polars_of(definition, into)
            whole, said = prepared(what, **ways)
            progress(f"writing {target}")
            findings = (
                kept + said + write_into(whole, into, target, nodes=nodes, command=COMMAND.get())
            )
            title = f"into {into}"
    read_from = ["read", definition.format, definition.source]
    if variant is not None:
        read_from = ["read", "a family's variant", source]
    print_table(
        ["", "format", "file"],
        [read_from, ["written", title, str(target)]],
    )
    print_findings([str(finding) for finding in (*definition.findings, *findings)])
