"""How values show themselves in a notebook: figures in a table, of a blade beside a small picture.

`bladegen/__init__.py` registers this for `_repr_html_` of `Blade`, `BladeDefinition`, `ShapeSpace`
and `Family`, which import nothing that draws.
"""

import base64
import html
import io
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import visible
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.views.plots.blade_plots import overview
from bladegen.views.tables import digits

__all__ = ["blade_html", "definition_html", "family_html", "space_html"]

DPI = 90


def blade_html(blade: Blade) -> str:
    """Return a blade as HTML that needs nothing else: a table and a picture."""
    title = blade.definition.description or blade.name
    return (
        "<div style='display:flex;flex-wrap:wrap;align-items:center;gap:1.5em'>"
        f"{_table(title, _figures(blade))}"
        f"<img alt='outline and sections of {_plain(title)}' style='max-width:100%' "
        f"src='data:image/png;base64,{_picture(blade)}'></div>"
    )


def definition_html(definition: BladeDefinition) -> str:
    """Return a definition as a table: its quantities, and its stations."""
    chord, twist = definition.chord.values, np.degrees(definition.twist.values)
    thickness = definition.relative_thickness
    figures = {
        "name": definition.name,
        "length": f"{digits(definition.length, 2)} m",
        "chord": f"{digits(chord[0], 2)} m at the root, {digits(chord.max(), 2)} m at most",
        "twist": f"{twist[0]:.2f} to {twist[-1]:.2f} deg",
        "relative thickness": "as the airfoils have it"
        if thickness is None
        else f"{thickness.values[0]:.4g} to {thickness.values[-1]:.4g}",
        "format": definition.format or "none",
        "findings": str(len(definition.findings)),
    }
    rows = [(f"{one.eta:.4f}", one.airfoil.name) for one in definition.stations]
    return _table(definition.description or definition.name, figures) + _columns(
        ("station eta", "airfoil"), rows
    )


def space_html(space: ShapeSpace) -> str:
    """Return a space as a table of its modes: their share of the variance, and the data's range."""
    figures = {
        "landmarks": str(len(space.u)),
        "shapes": f"{len(space.coordinates)}",
        "modes": str(space.dimension),
    }
    shares = space.variance_ratio[: space.dimension]
    if not len(space.coordinates):
        rows = [(f"t{k + 1}", f"{share:.2%}") for k, share in enumerate(shares)]
        return _table(space.about, figures) + _columns(("mode", "variance"), rows)
    bounds = zip(shares, space.lower, space.upper, strict=True)
    full = [
        (f"t{k + 1}", f"{share:.2%}", f"{low:.4f}", f"{high:.4f}")
        for k, (share, low, high) in enumerate(bounds)
    ]
    return _table(space.about, figures) + _columns(
        ("mode", "variance", "least [rad]", "largest [rad]"), full
    )


def family_html(family: Any) -> str:
    """Return a family as a table: what is planned, and between which bounds factors vary."""
    design = family.design
    figures = {
        "variants": str(len(family)),
        "of": family.blade.name,
        "design": f"{design.kind}, seed {design.seed}",
        "window": f"eta = {family.window.start:.4g} to {family.window.end:.4g}",
        "sections": f"{len(family.eta)} of {len(family.blade.u)} landmarks",
        "variants that are not sound": f"{family.invalid} (up to {family.tries} draws)",
    }
    bounds = zip(design.what.names, design.what.low, design.what.high, strict=True)
    rows = [(name, f"{low:.4g}", f"{high:.4g}") for name, low, high in bounds]
    return _table(f"Family of {family.blade.name}", figures) + _columns(
        ("factor", "least", "largest"), rows
    )


def _plain(text: str) -> str:
    """Return a text of anybody's as HTML shows it."""
    return html.escape(visible(text))


def _table(title: str, figures: Mapping[str, str]) -> str:
    rows = "".join(
        f"<tr><th style='text-align:left'>{_plain(key)}</th>"
        f"<td style='text-align:left'>{_plain(value)}</td></tr>"
        for key, value in figures.items()
    )
    return f"<table><caption style='text-align:left'><b>{_plain(title)}</b></caption>{rows}</table>"


def _columns(names: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    head = "".join(f"<th>{_plain(name)}</th>" for name in names)
    body = "".join(
        f"<tr>{''.join(f'<td>{_plain(cell)}</td>' for cell in row)}</tr>" for row in rows
    )
    return f"<table><tr>{head}</tr>{body}</table>"


def _figures(blade: Blade) -> dict[str, str]:
    eta = np.linspace(0.0, 1.0, 501)
    chord, twist = blade.chord(eta), np.degrees(blade.twist(eta))
    tip = blade.axis(1.0)
    airfoils = dict.fromkeys(station.airfoil.name for station in blade.definition.stations)
    figures = {
        "name": visible(blade.name),
        "length": f"{digits(blade.length, 2)} m",
        "chord": f"{digits(chord[0], 2)} m at the root, {digits(chord.max(), 2)} m at most",
        "twist": f"{twist[0]:.2f} to {twist[-1]:.2f} deg",
        "prebend, sweep": f"{tip[0]:.2f} m, {tip[1]:.2f} m",
        "stations": f"{len(blade.eta)}, {len(airfoils)} airfoils",
        "landmarks": str(len(blade.u)),
    }
    if blade.changes:
        asked = [f"{k} {v}" for change in blade.changes for k, v in change.items() if k != "window"]
        figures["perturbed"] = "; ".join(asked) or "no"
    return figures


def _picture(blade: Blade) -> str:
    file = io.BytesIO()
    overview(blade).savefig(file, format="png", dpi=DPI)
    return base64.b64encode(file.getvalue()).decode("ascii")
