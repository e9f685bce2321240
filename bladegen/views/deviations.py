"""Maps of deviations to files: a picture over span and arc, a table, and the skin for ParaView."""

from pathlib import Path

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.fitting.deviations import DeviationMap
from bladegen.support.arrays import Array
from bladegen.views.plots.figures import figure, save_figure
from bladegen.views.plots.style import DIVERGING

__all__ = ["SUFFIXES", "figures_of", "write"]

SUFFIXES = (".csv", ".png", ".vtp")
MILLIMETRES = 1e3
COLUMNS = "eta,u,x_m,y_m,z_m,deviation_mm,affine_mm,space_mm,rest_mm"


def figures_of(deviation: DeviationMap, blade: Blade) -> dict[str, float]:
    """Return RMS and extremes of a deviation, and the RMS of each of its parts [mm]."""
    off = MILLIMETRES * deviation.values
    parts = deviation.parts(blade)
    return {
        "deviation_rms_mm": float(np.sqrt(np.mean(off**2))),
        "deviation_outward_mm": float(off.max()),
        "deviation_inward_mm": float(-off.min()),
        **{
            f"deviation_{name}_rms_mm": float(MILLIMETRES * np.sqrt(np.mean(part**2)))
            for name, part in parts.items()
        },
    }


def write(deviation: DeviationMap, blade: Blade, path: Path) -> None:
    """Write a map by a path's suffix: `SUFFIXES`."""
    points = blade.sections(deviation.eta)
    fields = {"deviation": deviation.values, **deviation.parts(blade)}
    fields = {name: MILLIMETRES * values for name, values in fields.items()}
    {".csv": _table, ".png": _picture, ".vtp": _skin}[path.suffix.lower()](
        deviation, points, fields, path
    )


def _table(deviation: DeviationMap, points: Array, fields: dict[str, Array], path: Path) -> None:
    eta, u = np.meshgrid(deviation.eta, deviation.u, indexing="ij")
    columns = [eta, u, *np.moveaxis(points, -1, 0), *fields.values()]
    rows = np.stack([values.ravel() for values in columns], axis=1)
    np.savetxt(path, rows, fmt="%.7g", delimiter=",", header=COLUMNS, comments="")


def _picture(deviation: DeviationMap, points: Array, fields: dict[str, Array], path: Path) -> None:
    del points
    drawn, axes = figure(2, 2, width=12.0, height=7.0)
    for axis, (name, values) in zip(axes.flat, fields.items(), strict=True):
        reach = max(float(np.percentile(np.abs(values), 99.5)), 1e-6)
        shown = axis.pcolormesh(
            deviation.eta, deviation.u, values.T, cmap=DIVERGING, vmin=-reach, vmax=reach
        )
        axis.set(title=name, xlabel="span fraction", ylabel="suction TE 0, LE 0.5, pressure TE 1")
        drawn.colorbar(shown, ax=axis, label="mm, outward positive")
    save_figure(drawn, path)


def _skin(deviation: DeviationMap, points: Array, fields: dict[str, Array], path: Path) -> None:
    import pyvista as pv

    rows, columns = deviation.values.shape
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    corner = (i * columns + j).ravel()
    quads = np.stack(
        [np.full_like(corner, 4), corner, corner + columns, corner + columns + 1, corner + 1],
        axis=1,
    )
    skin = pv.PolyData(points.reshape(-1, 3), quads.ravel())
    for name, values in fields.items():
        skin.point_data[f"{name}_mm"] = values.ravel()
    skin.save(path)
