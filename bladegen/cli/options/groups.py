"""Groups of options: a frozen dataclass whose fields are options of several commands.

`grouped` gives a command the options of every group among its parameters, so that each option
stands in one place; `COMMAND` holds what was typed, as files tell it.
"""

import inspect
import shlex
from collections.abc import Callable
from contextvars import ContextVar
from copy import copy
from dataclasses import fields, is_dataclass
from functools import wraps
from pathlib import Path
from typing import Annotated, Any, get_args

import typer

__all__ = ["COMMAND", "grouped"]


def grouped(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command the options of each group among its parameters, in the group's place."""
    own = inspect.signature(command)
    groups: dict[str, Any] = {}
    parameters: list[inspect.Parameter] = []
    for parameter in own.parameters.values():
        if not is_dataclass(parameter.annotation):
            parameters.append(parameter)
            continue
        groups[parameter.name] = parameter.annotation
        parameters += [
            parameter.replace(
                name=field.name,
                annotation=_in_panel(field.type, parameter.annotation),
                default=field.default,
            )
            for field in fields(parameter.annotation)
        ]

    @wraps(command)
    def whole(**given: Any) -> None:
        words = command.__name__.replace("_", " ")  # of a command within a group: group_command
        COMMAND.set(_typed(words, parameters, given))
        made = {
            name: group(**{field.name: given.pop(field.name) for field in fields(group)})
            for name, group in groups.items()
        }
        command(**given, **made)

    whole.__dict__["__signature__"] = own.replace(parameters=parameters)
    whole.__annotations__ = {one.name: one.annotation for one in parameters}
    return whole


COMMAND: ContextVar[str] = ContextVar("what was typed", default="")
UNTOLD = ("output", "jobs", "dask", "resume", "append")  # options that change no file


def _typed(name: str, parameters: list[inspect.Parameter], given: dict[str, Any]) -> str:
    """Return a command as files tell it: without folders, defaults and what changes no file."""
    words = ["bladegen", *name.split()]
    for parameter in parameters:
        value = given[parameter.name]
        if value == parameter.default or parameter.name in UNTOLD:
            continue
        option = get_args(parameter.annotation)[1]
        values = list(value) if isinstance(value, list | tuple) else [value]
        if isinstance(option, typer.models.ArgumentInfo):
            words += [Path(str(one)).name for one in values]
            continue
        said = next(
            (
                flag
                for flag in (option.default, *(option.param_decls or ()))
                if isinstance(flag, str) and flag.startswith("--")
            ),
            "--" + parameter.name.replace("_", "-"),
        )
        if isinstance(value, tuple):  # of one option that takes several words
            words += [said, *(Path(str(one)).name for one in values)]
            continue
        for one in values:
            words += [said] if one is True else [said, Path(str(one)).name]
    return shlex.join(words)


def _in_panel(annotation: Any, group: Any) -> Any:
    """Return an option that the help shows under its group's heading."""
    kind, option = get_args(annotation)
    shown = copy(option)
    shown.rich_help_panel = option.rich_help_panel or group.__doc__.rstrip(".")
    return Annotated[kind, shown]
