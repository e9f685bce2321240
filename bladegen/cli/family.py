"""The command `bladegen family`: parse, call, print."""

from collections.abc import Iterator
from contextlib import contextmanager
from math import isfinite
from pathlib import Path
from typing import Annotated, Any

import typer

from bladegen.cli.options.common import (
    LANDMARKS,
    MAKING,
    BladeName,
    FamilyTarget,
    Making,
    Mirror,
    suffixes_of,
)
from bladegen.cli.options.groups import grouped
from bladegen.cli.options.perturbing import ChordLine
from bladegen.cli.options.producing import PRODUCING, Producing
from bladegen.cli.terminal import print_table, remark, variants_bar
from bladegen.errors import FamilyError
from bladegen.support.stopping import Stopped

__all__ = ["SHOWN", "cluster", "family", "figure_range"]

SHOWN = {  # labels that the summary has
    "rotor_power_coefficient": "largest power coefficient",
    "rotor_root_moment": "root moment, N m",
    "rotor_annual_energy": "annual energy, GWh",
    "mass": "mass of the layers, kg",
}
GRAPH = "graph"  # a format that is no file of a variant, but arrays of the dataset


Labels = Annotated[
    list[str] | None,
    typer.Option(
        "--label",
        metavar="polars|rotor|mass",
        help="Labels of each sound variant in the dataset: polars of sections, what a rotor does "
        "(both by NeuralFoil, the extra aero), mass of the layers. With commas, or repeated.",
    ),
]
FamilyFormats = Annotated[
    list[str] | None,
    typer.Option(
        "--format",
        help="Files for each variant, as `build` makes them, such as step, stl, glb, yaml; graph: "
        "normals, areas and edges of the points in the dataset. With commas, or repeated.",
    ),
]


@grouped
def family(
    blade: BladeName,
    output: FamilyTarget,
    count: Annotated[int | None, typer.Option(help="How many variants; 100 if not given.")] = None,
    seed: Annotated[int, typer.Option(help="Of the draws; the same seed, the same family.")] = 0,
    design: Annotated[
        str, typer.Option(help="ellipsoid smallest hull mixture normal sobol lhs box sweep.")
    ] = "ellipsoid",
    table: Annotated[
        Path | None,
        typer.Option(help="CSV or Parquet: a row a variant, columns t1.., thickness, twist_deg.."),
    ] = None,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=LOW:HIGH",
            help="Vary t1.., thickness, camber, chord, twist [deg], chord_scale, twist_scale, "
            "prebend_scale; may be repeated.",
        ),
    ] = None,
    reach: Annotated[float, typer.Option(help="Share of the space's bounds that is used.")] = 1.0,
    space: Annotated[
        str | None, typer.Option(help="A space's file, sound, or none; the paper's if not given.")
    ] = None,
    window: Annotated[
        str | None,
        typer.Option(metavar="FROM,TO", help="Where changes fade in; past round roots by default."),
    ] = None,
    chord_line: Annotated[
        ChordLine,
        typer.Option(help="Keep chord line and nose of the baseline, or leave them to the paper."),
    ] = ChordLine.kept,
    spans: Annotated[int, typer.Option(help="Sections a variant.")] = 100,
    allow_extrapolation: Annotated[
        bool, typer.Option("--allow-extrapolation", help="Take sections beyond the space's data.")
    ] = False,
    allow_odd: Annotated[
        bool,
        typer.Option("--allow-odd", help="Take sections with noses, tails or waves of no airfoil."),
    ] = False,
    invalid: Annotated[
        str, typer.Option(help="'redraw' variants that are not sound, or 'keep' and mark them.")
    ] = "redraw",
    tries: Annotated[int, typer.Option(help="Draws of one variant at most.")] = 1000,
    where: Annotated[
        str,
        typer.Option(
            metavar="CONDITIONS",
            help="Draw variants that fulfil them: 'volume > 610 and thickness@0.7 < 0.24'; names "
            "of factors, volume, surface, what is over span.",
        ),
    ] = "",
    double: Annotated[
        bool, typer.Option("--double", help="Store sections as float64, not float32.")
    ] = False,
    formats: FamilyFormats = None,
    label: Labels = None,
    producing: Producing = PRODUCING,
    making: Making = MAKING,
    mirror: Mirror = False,
    jobs: Annotated[
        int, typer.Option(help="Threads, or processes where files are written, at work.")
    ] = 1,
    dask: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="A Dask scheduler instead of --jobs.")
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with what an earlier run left.")
    ] = False,
    append: Annotated[
        bool,
        typer.Option("--append", help="Add to a family: --count is the new number in all."),
    ] = False,
) -> None:
    """Make a family of perturbed blades: sections, a manifest, files and a contact sheet."""
    from bladegen.blade.variants import kernels
    from bladegen.cli.options.parsing import factor_bounds, factor_table, span_window
    from bladegen.families.family import family as plan
    from bladegen.families.order import Order
    from bladegen.families.run import run
    from bladegen.families.storage.places import located
    from bladegen.shapes.shape_space import ShapeSpace
    from bladegen.support.compiled import is_kept

    words = [word for text in formats or [] for word in text.split(",")]
    graph = GRAPH in (word.strip().lower() for word in words)
    suffixes = suffixes_of([word for word in words if word.strip().lower() != GRAPH])
    known = None
    if space is None or space.lower() != "none":
        known = ShapeSpace.bundled() if space is None else ShapeSpace.load(space)
    if table is not None and (count is not None or vary):
        raise FamilyError("table: it says what varies and how often; leave --count and --vary out")
    landmarks = LANDMARKS if known is None else len(known.u)
    baseline = making.blade(blade, landmarks)
    planned = plan(
        baseline.mirror_image() if mirror else baseline,
        known,
        count=100 if count is None else count,
        seed=seed,
        design=design if table is None else factor_table(known, table),
        bounds=factor_bounds(vary or []),
        reach=reach,
        window=None if window is None else span_window(window),
        chord_line=chord_line,
        allow_extrapolation=allow_extrapolation,
        allow_odd=allow_odd,
        spans=spans,
        invalid=invalid,
        tries=tries,
        where=where,
    )
    order = Order(
        planned,
        located(output),
        suffixes,
        "float64" if double else "float32",
        producing.options(suffixes),
        graph,
        tuple(word.strip().lower() for text in label or [] for word in text.split(",")),
    )
    if not is_kept(kernels.made):
        remark("compiling loops, once on this machine: about ten seconds")
    try:
        with cluster(dask) as client, variants_bar(len(planned)) as progress:
            made = run(
                order,
                jobs=jobs,
                client=client,
                resume=resume,
                append=append,
                progress=progress,
                foretold=lambda forecast: (
                    remark(f"still to be made: {forecast}") if forecast.variants else None
                ),
            )
    except Stopped as stop:
        raise stop.saying(f"{output}: the same command with --resume goes on; ") from None
    _summary(order, made)


def figure_range(values: Any) -> str:
    """Return the least and the largest of figures, those that are none left out."""
    known = [value for value in values.tolist() if isfinite(value)]
    return f"{min(known):.5g} to {max(known):.5g}" if known else "none"


@contextmanager
def cluster(address: str | None) -> Iterator[Any]:
    """Connect to a Dask scheduler; None without an address."""
    if address is None:
        yield None
        return
    try:
        from distributed import Client
    except ImportError:
        raise FamilyError(
            "dask: distributed is not installed; pip install 'bladegen[dask]' adds it"
        ) from None
    try:
        client = Client(address, timeout="10s")
    except (OSError, ValueError) as error:
        raise FamilyError(f"dask: {address}: no scheduler answers ({error})") from None
    with client:
        yield client


def _summary(order: Any, made: int) -> None:
    """Draw the contact sheet and say what the folder holds."""
    from bladegen.families.dataset.writing import CARD
    from bladegen.families.folder import read_manifest
    from bladegen.families.storage.places import bytes_in, replacing
    from bladegen.views.contact_sheet import contact_sheet
    from bladegen.views.tables import digits, megabytes

    columns = ["name", "valid", "attempts", "volume_m3", "reason"]
    shown = [one for one in SHOWN if one in {figure.name for figure in order.labelling.figures}]
    manifest = read_manifest(order.place, [*columns, *shown])
    sheet = order.target / "contact.png"
    family = order.family
    drawn = manifest["name"], manifest["valid"], family.blade, family.eta
    with replacing(sheet) as temporary:
        remark = contact_sheet(order.place.sections, *drawn, temporary)
    valid = manifest["valid"]
    volume = manifest["volume_m3"][valid]
    smallest, largest = (digits(v, 1) for v in (min(volume, default=0), max(volume, default=0)))
    size = bytes_in(order.target)
    rows = [
        ["variants", f"{len(valid)}, {made} of them made now"],
        ["sound", f"{int(valid.sum())} of {len(valid)}"],
        ["draws", f"{int(manifest['attempts'].sum())}"],
        ["volume", f"{smallest} to {largest} m3" if len(volume) else "none"],
        ["sections", f"{len(family.eta)} of {len(family.blade.u)} landmarks, {order.dtype}"],
        *([SHOWN[name], figure_range(manifest[name][valid])] for name in shown),
        ["size", megabytes(size)],
        ["overlay", remark],
    ]
    print_table(["figure", "value"], rows, title=f"family of {family.blade.name}")
    files = [
        [str(order.place.manifest), "a row a variant: factors, validity, properties over span"],
        [str(order.place.store), "the dataset: xarray.open_zarr, bladegen.load_family"],
        [str(order.target / CARD), "its card: what it is, splits, licence, how to cite"],
        [str(sheet), "the family at a glance"],
    ]
    if order.suffixes:
        files.insert(2, [str(order.place.blades), f"files: {' '.join(order.suffixes)}"])
    print_table(["file", "holds"], files)
    wrong = [reason for reason in manifest["reason"] if reason]
    if wrong:
        typer.echo(f"note: {len(wrong)} variants are not sound, such as: {wrong[0]}")
    if len(valid) and not valid.any() and family.invalid == "redraw":
        raise FamilyError(
            f"{order.target}: none of {len(valid)} variants is sound, in all draws; give a smaller "
            "--reach, another --space, or --invalid keep to have them as they are"
        )
