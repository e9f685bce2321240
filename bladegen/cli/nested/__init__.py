"""Commands that have commands of their own: `bladegen space build`, `bladegen case openfoam`.

Each module has a Typer, `app`, that `cli.commands` names; another solver's case is a function in
`case`.
"""
