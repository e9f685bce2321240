"""Options of what is made or shown of a whole rotor, and the rotor that they ask for."""

from typing import Annotated, Any

import typer

from bladegen.errors import BladegenError

__all__ = ["HubRadius", "Precone", "require_rotor", "rotor_given"]

HubRadius = Annotated[
    str | None,
    typer.Option(metavar="LENGTH", help="Of the rotor, instead of the definition's; 2m."),
]
Precone = Annotated[
    str | None,
    typer.Option(
        metavar="ANGLE",
        help="Of the rotor in degrees, tips upwind, instead of the definition's.",
    ),
]


def require_rotor(asked: bool, hub_radius: str | None, precone: str | None) -> None:
    """See that a rotor is asked for where its options are."""
    if not asked and (hub_radius or precone):
        raise BladegenError("hub-radius, precone: are of the rotor; add --rotor, or leave them out")


def rotor_given(
    blade: Any, hub_radius: str | None, precone: str | None, made_as: str = "assembly"
) -> Any:
    """Return a blade's rotor, with what options say instead of its definition."""
    from bladegen.cad.rotor import rotor_of
    from bladegen.cli.options.parsing import metres, radians

    hub = None if hub_radius is None else metres(hub_radius, "hub-radius", example="2m")
    cone = None if precone is None else radians(precone, "precone")
    return rotor_of(blade, hub_radius=hub, cone=cone, made_as=made_as)
