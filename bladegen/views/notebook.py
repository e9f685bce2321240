"""How a blade shows itself in a notebook: its figures in a table beside a small picture.

`bladegen/__init__.py` registers this for `Blade._repr_html_`, which imports nothing that draws.
"""

import base64
import html
import io

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.errors import visible
from bladegen.views.blade_plots import overview
from bladegen.views.tables import digits

__all__ = ["blade_html"]

DPI = 90


def blade_html(blade: Blade) -> str:
    """Return a blade as HTML that needs nothing else: a table and a picture."""
    rows = "".join(
        f"<tr><th style='text-align:left'>{html.escape(key)}</th>"
        f"<td style='text-align:left'>{html.escape(value)}</td></tr>"
        for key, value in _figures(blade).items()
    )
    title = html.escape(visible(blade.definition.description or blade.name))
    return (
        "<div style='display:flex;flex-wrap:wrap;align-items:center;gap:1.5em'>"
        f"<table><caption style='text-align:left'><b>{title}</b></caption>{rows}</table>"
        f"<img alt='outline and sections of {title}' style='max-width:100%' "
        f"src='data:image/png;base64,{_picture(blade)}'></div>"
    )


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
