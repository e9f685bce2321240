"""A scene as one HTML file that turns in any browser, without a server and without a network.

The page holds its data (base64), its drawing code (`viewer.js`, WebGL 2) and a policy that lets no
request leave it.  Colours are sent as steps of a palette of 256, normals as bytes.
"""

import base64
import html
import json
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from bladegen.errors import RenderError
from bladegen.support.arrays import Array
from bladegen.support.files import require_suffix
from bladegen.views.plots import style
from bladegen.views.rendering import keys
from bladegen.views.rendering.cameras import ANGLE, VIEWS
from bladegen.views.rendering.drawing import HEADLIGHT, LIGHTS, shaded
from bladegen.views.rendering.scene import Field, Scene

__all__ = ["LANDMARKS", "LARGEST", "document", "write_page"]

LANDMARKS = 201  # of a section that a page holds
LARGEST = 10_000_000  # bytes, that can still be sent by mail
SUFFIXES = (".html", ".htm")
STEPS = 255  # of a palette


def write_page(scene: Scene, path: Path, *, colour: str = "plain") -> None:
    """Write a scene as a page.

    Parameters
    ----------
    scene : Scene
        What there is to see.
    path : Path
        The HTML file.
    colour : str
        "plain" or the name of a field: what the surface is coloured by at first.

    Raises
    ------
    RenderError
        If there is no such colour, or the surface has too many triangles for a page.
    ExportError
        If the file's name ends neither in .html nor in .htm.
    """
    require_suffix(path, SUFFIXES)
    text = document(scene, keys.On(colour=colour))
    if len(text) > LARGEST:
        raise RenderError(
            f"{path}: the page would be {len(text) / 1e6:.1f} MB for "
            f"{len(scene.surface.faces)} triangles, allowed are {LARGEST / 1e6:g} MB"
        )
    path.write_text(text, encoding="utf-8")


def document(scene: Scene, on: keys.On) -> str:
    """Return the page's text."""
    if on.colour != "plain":
        scene.field(on.colour)
    here = files("bladegen.views")
    data = json.dumps(_data(scene, on)).replace("<", "\\u003c")  # no </script> inside
    return Template((here / "page.html").read_text(encoding="utf-8")).substitute(
        title=html.escape(scene.title),
        caption=html.escape(scene.caption),
        scene=data,
        viewer=(here / "viewer.js").read_text(encoding="utf-8"),
        paper=style.PAPER,
        ink=style.INK,
        faint=style.FAINT,
        variant=style.VARIANT,
    )


def _data(scene: Scene, on: keys.On) -> dict[str, Any]:
    """Return what the drawing code reads."""
    shown = shaded(scene.surface, scene.fields)
    points = np.asarray(shown.points, dtype=np.float64)
    normals = np.zeros((len(points), 4), np.int8)  # padded: attributes begin at multiples of four
    normals[:, :3] = np.round(127.0 * np.asarray(shown.point_data["Normals"]))
    fields = [_field(field, np.asarray(shown[field.name])) for field in scene.fields]
    return {
        "points": _packed(points, np.float32),
        "normals": _packed(normals, np.int8),
        "faces": _packed(np.asarray(shown.regular_faces), np.uint32),
        "fields": fields,
        "layers": [
            {
                "name": layer.name,
                "colour": layer.colour,
                "width": layer.width,
                "lines": [[*group.shape[:2], _packed(group, np.float32)] for group in layer.lines],
            }
            for layer in scene.layers
        ],
        "labels": [vars(label) for label in scene.labels],
        "views": {name: vars(view) for name, view in VIEWS.items()},
        "angle": ANGLE,
        "lights": [*LIGHTS, (0.0, 0.0, 1.0, HEADLIGHT)],
        "paper": style.PAPER,
        "ink": style.INK,
        "surface": style.SURFACE,
        "on": {"layers": sorted(on.layers), "colour": on.colour, "view": on.view},
        "keys": _keys(scene),
    }


def _field(field: Field, values: Array) -> dict[str, Any]:
    """Return a field as steps of its palette."""
    from matplotlib import colormaps

    share = np.clip((values - field.low) / (field.high - field.low), 0.0, 1.0)
    palette = colormaps[field.colours](np.linspace(0.0, 1.0, STEPS + 1))[:, :3]
    return {
        "name": field.name,
        "label": field.label,
        "low": field.low,
        "high": field.high,
        "values": _packed(np.round(STEPS * share), np.uint8),
        "palette": _packed(np.round(255.0 * palette), np.uint8),
    }


def _keys(scene: Scene) -> dict[str, dict[str, str]]:
    """Return the usable keys with what kind each is of; a page is closed by the browser."""
    usable = keys.usable(scene.names, tuple(field.name for field in scene.fields))
    kinds = {"layer": keys.LAYERS, "colour": keys.COLOURS, "view": keys.TURNS}
    return {
        key: {
            "kind": next((kind for kind, table in kinds.items() if key in table), "other"),
            **vars(about),
        }
        for key, about in usable.items()
        if about.target != "quit"
    }


def _packed(values: Any, kind: type) -> str:
    """Return an array as base64 of its little-endian bytes."""
    plain = np.ascontiguousarray(values, dtype=np.dtype(kind).newbyteorder("<"))
    return base64.b64encode(plain.tobytes()).decode("ascii")
