"""From a blade to a folder of files and a report on what was made and how good it is.

The report's figures are measured on the files: STEP files are read again, meshes are checked
as they lie on the disk.  Lengths are metres unless a name says otherwise.
"""

import json
import platform
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from bladegen import __version__, cad, cad_files, checks, combs, exporters, mesh
from bladegen.blade import Blade
from bladegen.errors import ToleranceError
from bladegen.files import folder, replacing, safe_stem
from bladegen.net import Deviation
from bladegen.rotor import Rotor, write_glb, write_step
from bladegen.spanwise import spanwise, write_csv

__all__ = ["DEFAULT_FORMATS", "build", "report_path"]

DEFAULT_FORMATS = ("step", "stl", "glb", "png")
LIBRARIES = ("numpy", "scipy", "cadquery", "cadquery-ocp", "trimesh", "pyvista", "vtk")
SPANWISE_ROWS = 60  # in the report; the CSV file holds all
FROM_FILE = ("solids", "faces", "valid", "closed", "area_m2", "bounds_m")
_SOLIDS, _MESHES = tuple(cad_files.READERS), (".stl", ".glb", ".ply", ".obj", ".3mf")


def build(
    blade: Blade,
    target: Path,
    *,
    formats: Sequence[str] = DEFAULT_FORMATS,
    options: exporters.Options | None = None,
    rotor: Rotor | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> dict[str, Any]:
    """Write a blade's files and its report into a folder.

    Parameters
    ----------
    blade : Blade
        What to build.
    target : Path
        The folder; made if it is not there.
    formats : sequence of str
        Suffixes, with or without their dot; with "png" come curvature combs of the airfoils,
        ``<name>.combs.png``.
    options : Options, optional
        How products are made.
    rotor : Rotor, optional
        Write the whole rotor too, as ``<name>.rotor.step`` and ``<name>.rotor.glb``.
    progress : callable
        Told what is being done.

    Returns
    -------
    dict
        The report, as written to ``<name>.report.json``.

    Raises
    ------
    ToleranceError
        If the solid misses its tolerance; the other files and the report are written all the
        same, and the solid is kept under another name.
    """
    stem = safe_stem(blade.name)
    paths = [folder(target) / f"{stem}.{suffix.lower().lstrip('.')}" for suffix in formats]
    for path in paths:
        exporters.format_of(path)
    options = options or exporters.Options()
    products = exporters.Products(blade, options, progress)
    seconds: dict[str, float] = {}
    report: dict[str, Any] = {
        "blade": blade.name,
        "source": Path(blade.definition.source).name,
        "bladegen": __version__,
        "versions": {"python": platform.python_version(), **_versions()},
        "settings": _settings(blade, options),
        "changes": list(blade.changes),
    }
    progress("measuring the blade")
    with _timed(seconds, "measuring the blade"):
        report["figures"] = checks.check_blade(blade).figures
        report["airfoils"] = combs.figures(blade)
    files, miss = [], None
    for path in paths:
        progress(f"writing {path.name}")
        made = path
        with _timed(seconds, path.suffix.lstrip(".")):
            try:
                exporters.write(products, path)
            except ToleranceError as error:
                miss, made = error, exporters.aside(path)
        files.append({"name": made.name, "bytes": made.stat().st_size})
        with _timed(seconds, "measuring the files"):
            if path.suffix in _SOLIDS:
                progress("reading the solid again")
                report["solid"] = _solid(products, made, report["figures"]["volume_m3"])
            elif path.suffix in _MESHES:
                report.setdefault("meshes", {})[path.suffix.lstrip(".")] = checks.mesh_figures(
                    mesh.read(made)
                )
    if rotor is not None:
        report["rotor"] = asdict(rotor)
        for path, make, product in (
            (target / f"{stem}.rotor.step", write_step, "solid"),
            (target / f"{stem}.rotor.glb", write_glb, "mesh"),
        ):
            progress(f"writing {path.name}")
            with _timed(seconds, "rotor"), replacing(path) as temporary:
                make(rotor, getattr(products, product), temporary)
            files.append({"name": path.name, "bytes": path.stat().st_size})
    if any(path.suffix == ".png" for path in paths):
        progress("drawing curvature combs")
        with _timed(seconds, "combs"):
            files.append(_combs(blade, target / f"{stem}.combs.png"))
    table = target / f"{stem}.spanwise.csv"
    columns = spanwise(blade, blade.stations(options.stations))
    with replacing(table) as temporary:
        write_csv(columns, temporary)
    files.append({"name": table.name, "bytes": table.stat().st_size})
    some = slice(None, None, max(1, options.stations // SPANWISE_ROWS))
    report["spanwise"] = {name: values[some].tolist() for name, values in columns.items()}
    report["files"] = files
    report["seconds"] = {stage: round(spent, 3) for stage, spent in seconds.items()}
    with replacing(report_path(target, blade.name)) as temporary:
        temporary.write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
    if miss is not None:
        raise miss
    return report


def _combs(blade: Blade, path: Path) -> dict[str, Any]:
    """Draw the airfoils' curvature combs and return the file's row in the report."""
    with replacing(path) as temporary:
        combs.draw(blade, temporary)
    return {"name": path.name, "bytes": path.stat().st_size}


def report_path(target: Path, name: str) -> Path:
    """Return where the report on a blade of that name lies."""
    return target / f"{safe_stem(name)}.report.json"


def _solid(products: exporters.Products, path: Path, wanted: float) -> dict[str, Any]:
    """Measure a STEP file as it lies on the disk, against the solid and the blade."""
    solid = products.solid
    again = checks.solid_figures(cad_files.read(path), quick=True)
    before = cad.volume(solid.shape, cad.COARSE_VOLUME) / cad.MILLIMETRES**3
    volume = solid.net.volume()
    deviation = solid.deviation
    return {
        **{key: again[key] for key in FROM_FILE},
        "face_names": [name for name, _ in solid.faces],
        "sections": len(solid.net.v),
        "poles": int(solid.net.poles.size // 3),
        "volume_m3": volume,
        "volume_against_sections": volume / wanted - 1.0,
        "volume_change_on_reading": again["volume_m3"] / before - 1.0,
        "deviation_mm": {
            **_deviation(deviation),
            "on_face": deviation.face,
            "faces": {face: _deviation(part) for face, part in deviation.faces.items()},
        },
    }


def _deviation(deviation: Deviation) -> dict[str, Any]:
    """Return a deviation's figures [mm] and where the largest is."""
    return {
        "maximum": deviation.maximum * cad.MILLIMETRES,
        "rms": deviation.rms * cad.MILLIMETRES,
        "percentile_99": deviation.percentile99 * cad.MILLIMETRES,
        "at_eta": deviation.eta,
        "at_u": deviation.u,
        "samples": deviation.samples,
    }


def _settings(blade: Blade, options: exporters.Options) -> dict[str, Any]:
    return {
        "landmarks": len(blade.u),
        "path": blade.path.__name__,
        "section_planes": blade.planes.__name__,
        "trailing_edge": repr(blade.trailing_edge),
        "tolerance_mm": options.tolerance * cad.MILLIMETRES,
        "solid_sections": options.sections,
        "mesh_stations": options.stations,
        "tip": options.tip.__name__,
        "mesh_unit": options.unit,
    }


def _versions() -> dict[str, str]:
    found = {}
    for library in LIBRARIES:
        try:
            found[library] = version(library)
        except PackageNotFoundError:
            continue
    return found


@contextmanager
def _timed(seconds: dict[str, float], stage: str) -> Iterator[None]:
    start = time.perf_counter()
    try:
        yield
    finally:
        seconds[stage] = seconds.get(stage, 0.0) + time.perf_counter() - start
