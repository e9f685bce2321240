"""From a blade to a folder of files and a report on what was made and how good it is.

The report's figures are measured on the files: STEP files are read again, meshes are checked
as they lie on the disk.  Lengths are metres unless a name says otherwise.
"""

import json
import logging
import platform
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from typing import Any

from bladegen.blade.blade import Blade
from bladegen.cad import exchange, rotor_body, shapes
from bladegen.cad.rotor import ASSEMBLED, Rotor, write_glb, write_step
from bladegen.errors import ExportError, PromiseError
from bladegen.exports import exporters, marks
from bladegen.exports.inventory import REPORT, others
from bladegen.exports.ledger import Ledger
from bladegen.exports.options import Kind, Options
from bladegen.exports.products import Products, require
from bladegen.exports.provenance import Provenance, word
from bladegen.exports.registry import FORMATS, format_of, suffix_of
from bladegen.exports.writers import beams
from bladegen.formats import writing as writers
from bladegen.measures import checks
from bladegen.measures.spanwise import spanwise, write_csv
from bladegen.support.files import alone, folder, replacing, safe_stem
from bladegen.surface import mesh, mesh_files
from bladegen.surface.deviation import Deviation
from bladegen.surface.grids.grid_quality import grid_figures
from bladegen.version import __version__, of_libraries
from bladegen.views.plots import combs

__all__ = ["DEFAULT_FORMATS", "build", "report_path"]

logger = logging.getLogger(__name__)
DEFAULT_FORMATS = ("step", "stl", "glb", "png")
SPANWISE = ".spanwise.csv"
SPANWISE_ROWS = 60  # in the report; the CSV file holds all
FROM_FILE = ("solids", "faces", "valid", "closed", "area_m2", "bounds_m")
_MESHES = (".stl", ".glb", ".ply", ".obj", ".3mf")  # what trimesh reads


def build(
    blade: Blade,
    target: Path,
    *,
    formats: Sequence[str] = DEFAULT_FORMATS,
    options: Options | None = None,
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
        Write the whole rotor too, as ``<name>.rotor.step`` and ``<name>.rotor.glb``; one that is
        fused or a sector also as ``<name>.rotor.regions.stl`` (``.sector.`` instead).
    progress : callable
        Told what is being done.

    Returns
    -------
    dict
        The report, as written to ``<name>.report.json``.

    Raises
    ------
    PromiseError
        If the solid misses its tolerance (`ToleranceError`) or its size (`SizeError`); the other
        files and the report are written all the same, and the solid is kept under another name.
    ExportError
        If a format is not known, the folder cannot be written, or another run writes this blade
        there.
    """
    from threadpoolctl import threadpool_limits

    # one thread: the same sums in the same order, whatever the machine
    with alone(folder(target), safe_stem(blade.name)), threadpool_limits(1):
        return _built(blade, target, formats, options, rotor, progress)


def _built(
    blade: Blade,
    target: Path,
    formats: Sequence[str],
    options: Options | None,
    rotor: Rotor | None,
    progress: Callable[[str], None],
) -> dict[str, Any]:
    stem = safe_stem(blade.name)
    paths = [target / f"{stem}.{suffix.lower().lstrip('.')}" for suffix in formats]
    for path in paths:
        if format_of(path).kind is Kind.definition and blade.mirrored:
            raise ExportError(writers.MIRRORED)
        require(blade, format_of(path).kind)
    options = options or Options()
    products = Products(blade, options, progress)
    ledger = Ledger(progress)
    report: dict[str, Any] = {
        "blade": blade.name,
        "source": Path(blade.definition.source).name,
        "bladegen": __version__,
        "versions": {"python": platform.python_version(), **of_libraries()},
        "settings": _settings(blade, options),
        "changes": list(blade.changes),
    }
    progress("measuring the blade")
    with ledger.timed("measuring the blade"):
        report["figures"] = checks.check_blade(blade).figures
        report["airfoils"] = combs.figures(blade)
    miss: PromiseError | None = None
    for path in paths:
        made = path
        with ledger.timed(path.suffix.lstrip(".")):
            progress(f"writing {path.name}")
            try:
                exporters.write(products, path)
            except PromiseError as error:
                miss, made = miss or error, error.kept or path
        kind = format_of(path).kind
        ledger.note(made, products.made_from(kind, suffix_of(path)))
        with ledger.timed("measuring the files"):
            _measure(report, products, kind, made)
    if rotor is not None:
        report["rotor"] = asdict(rotor) | {"mirrored": blade.mirrored != rotor.mirrored}
        miss = _rotor(rotor, products, target / stem, ledger, report["rotor"]) or miss
    if any(path.suffix == ".png" for path in paths):
        by = products.made_from(Kind.picture, ".png")
        with ledger.writing(target / f"{stem}.combs.png", "combs", by) as temporary:
            combs.draw(blade, temporary)
    columns = spanwise(blade, mesh.spans(blade, options.stations))
    by = products.made_from(Kind.table, ".csv")
    with ledger.writing(target / f"{stem}{SPANWISE}", "spanwise", by) as temporary:
        write_csv(columns, temporary)
    some = slice(None, None, max(1, options.stations // SPANWISE_ROWS))
    report["spanwise"] = {name: values[some].tolist() for name, values in columns.items()}
    written = {entry["name"] for entry in ledger.files}
    left, notes = others(target, stem, written, partial(_made_here, products))
    report["files"] = ledger.files + left
    about = [] if rotor is None else [report["rotor"].pop("said")]
    report["remarks"] = [str(remark) for remark in (*products.remarks, *about, *notes)]
    report["seconds"] = {stage: round(spent, 3) for stage, spent in ledger.seconds.items()}
    with replacing(report_path(target, blade.name)) as temporary:
        temporary.write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
    if miss is not None:
        raise miss
    return report


def _rotor(
    rotor: Rotor, products: Products, stem: Path, ledger: Ledger, report: dict[str, Any]
) -> PromiseError | None:
    """Write a rotor's files; return what was asked of its solids and is not so."""
    part = "sector" if rotor.made_as == "sector" else "rotor"
    made, miss = stem.with_name(f"{stem.name}.{part}.step"), None
    told = tuple((f"rotor_{key}", word(value)) for key, value in asdict(rotor).items())

    def by(kind: Kind, suffix: str) -> Provenance:
        plain = products.made_from(kind, suffix)
        return replace(plain, settings=plain.settings + told, id="")

    solid, body = by(Kind.solid, ".step"), None
    options = {"schema": products.options.step_schema, **products.options.told}
    with ledger.timed("rotor"), marks.marked(made, solid) as temporary:
        if rotor.made_as == "assembly":
            report["said"] = ASSEMBLED
            ledger.progress(f"writing {made.name}")
            write_step(rotor, products.solid, temporary, **options)
        else:
            ledger.progress("fusing blades and spinner")
            body = rotor_body.MAKERS[rotor.made_as](rotor, products.solid)
            report |= {"body": body.figures, "said": str(body)}
            body.write_step(temporary, **options)
    try:
        exporters.require_size(products, made)
    except PromiseError as error:
        miss, made = error, error.kept or made
    ledger.note(made, solid)
    if body is not None:
        regions = stem.with_name(f"{stem.name}.{part}.regions.stl")
        with ledger.writing(regions, "rotor", by(Kind.triangles, ".regions.stl")) as temporary:
            body.write_regions(temporary)
    if part == "rotor":
        scene = stem.with_name(f"{stem.name}.rotor.glb")
        with ledger.writing(scene, "rotor", by(Kind.triangles, ".glb")) as temporary:
            write_glb(rotor, products.mesh, temporary)
    return miss


def _made_here(products: Products, path: Path) -> Provenance | None:
    """Return what a file of that name would be made from; None if its format is none of ours."""
    try:
        suffix = suffix_of(path)
    except ExportError:
        return None
    table = path.name.endswith(SPANWISE)
    kind = Kind.table if table else format_of(path).kind
    return products.made_from(kind, suffix)


def _measure(report: dict[str, Any], products: Products, kind: Kind, path: Path) -> None:
    """Add what a file of that kind gives to measure."""
    if kind is Kind.solid and suffix_of(path) in FORMATS:
        products.progress("reading the solid again")
        report["solid"] = _solid(products, path, report["figures"]["volume_m3"])
    elif kind is Kind.grid:
        report.setdefault("grid", grid_figures(products.grid))
    elif kind is Kind.volume:
        products.progress("measuring the volume")
        report["volume"] = products.volume.figures
    elif kind is Kind.shell:
        shell = products.shell
        report["shell"] = {**shell.quality, "mass_kg": shell.mass, "sections": len(shell.sections)}
    elif kind is Kind.structure:
        inside = products.inside
        report["structure"] = {"faces_m2": inside.areas, "inner_surface": inside.wall}
    elif kind is Kind.beam:
        report.setdefault("beam", beams.figures(products))
    elif path.suffix in _MESHES:
        figures = checks.mesh_figures(mesh_files.read(path))
        report.setdefault("meshes", {})[suffix_of(path).lstrip(".")] = figures


def report_path(target: Path, name: str) -> Path:
    """Return where the report on a blade of that name lies."""
    return target / f"{safe_stem(name)}{REPORT}"


def _solid(products: Products, path: Path, wanted: float) -> dict[str, Any]:
    """Measure a STEP file as it lies on the disk, against the solid and the blade."""
    solid = products.solid
    again = checks.solid_figures(exchange.read(path), quick=True)
    before = shapes.quick_volume(solid.shape) / shapes.MILLIMETRES**3
    deviation = solid.deviation
    return {
        **{key: again[key] for key in FROM_FILE},
        "face_names": [name for name, _ in solid.faces],
        "sections": len(solid.net.v),
        "poles": int(solid.net.poles.size // 3),
        "volume_m3": solid.volume,
        "tip_volume_m3": solid.tip_volume,  # of it, beyond the last section
        "volume_against_sections": solid.net.volume() / wanted - 1.0,
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
        "maximum": deviation.maximum * shapes.MILLIMETRES,
        "rms": deviation.rms * shapes.MILLIMETRES,
        "percentile_99": deviation.percentile99 * shapes.MILLIMETRES,
        "at_eta": deviation.eta,
        "at_u": deviation.u,
        "samples": deviation.samples,
    }


def _settings(blade: Blade, options: Options) -> dict[str, Any]:
    return {
        "landmarks": len(blade.u),
        "path": blade.path.__name__,
        "section_planes": blade.planes.__name__,
        "fair_planform": None if blade.fair_planform is None else str(blade.fair_planform),
        "trailing_edge": str(blade.trailing_edge),
        "mirrored": blade.mirrored,
        "tolerance_mm": options.tolerance * shapes.MILLIMETRES,
        "solid_sections": options.sections,
        "mesh_stations": options.stations,
        "tip": options.tip.__name__,
        "mesh_unit": options.unit,
        "grid": asdict(options.spacing),
    }
