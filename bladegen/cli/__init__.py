"""The command line: parse, call, print.

In comes what a user types; out go files, figures and lines.  Nothing is computed here: a command
is a module here and a line in `commands`, a new option goes beside its command, and one that
several commands share into `options`.
"""

__all__ = ["main"]


def main() -> None:
    """Run the command line: `bladegen.cli.commands`."""
    from bladegen.cli.commands import main as run

    run()
