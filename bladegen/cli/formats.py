"""The command `bladegen formats`: what can be read and written, by bladegen and by plug-ins."""

import typer

from bladegen.cli.terminal import print_table

__all__ = ["formats"]


def formats() -> None:
    """List the formats that are read and written, those of plug-ins too."""
    from bladegen.exports import registry as exports
    from bladegen.formats import registry

    rows = [("bladegen", row) for row in registry.FORMATS] + list(registry.plugged())
    print_table(
        ["blade files", "read", "written (--to)", "--into", "by"],
        [
            [
                row.name,
                " ".join(row.reader.suffixes) if row.reader else "",
                " ".join(writer.name for writer in row.writers),
                " ".join(row.put_back.suffixes) if row.put_back else "",
                name,
            ]
            for name, row in rows
        ],
    )
    makers = {row.suffix: name for name, row in reversed(exports.plugins().rows)}
    print_table(
        ["--format", "holds", "files", "by"],
        [
            [suffix, row.kind, row.description, makers.get(row.suffix, "bladegen")]
            for suffix, row in exports.formats().items()
        ],
    )
    for fault in (*registry.plugins().faults, *exports.plugins().faults):
        typer.echo(f"note: {fault}")
