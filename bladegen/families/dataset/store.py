"""A family's store as one dataset: every variable an array with dimensions, units and a name.

In: a folder whose sections and manifest are whole.  Out: `sections.zarr` (Zarr format 3) with what
the manifest holds beside the sections, the split, attributes after CF, and its metadata in one
place, so that ``xarray.open_zarr(folder / "sections.zarr")`` opens it in one read.  Rows are read
and written some thousands at a time.
"""

import warnings
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.errors import ExportError
from bladegen.families.dataset.graphs import edges, triangles
from bladegen.families.dataset.splits import SHARES, SPLITS, split_of
from bladegen.families.dataset.variables import (
    COORDINATES,
    LABELLED,
    Variable,
    parameter,
    variables,
)
from bladegen.families.labels.figures import FIGURES, STORED
from bladegen.families.labels.figures import axes as axes_of_labels
from bladegen.families.storage import places
from bladegen.families.storage.layout import MOST
from bladegen.families.storage.tables import parquet

__all__ = ["add_labels", "column_values", "complete", "is_complete", "opened"]

DIMENSIONS = ("variant", "span", "landmark", "xyz")
CONVENTIONS = "CF-1.11"
CHUNK = 2**17  # numbers in a chunk of an array beside the sections: a megabyte
FIXED = {  # arrays that are there before the first variant is
    "eta": (("span",), "span fraction, root to tip", "1"),
    "u": (("landmark",), "landmark parameter, suction side to pressure side", "1"),
    "xyz": (("xyz",), "axes of the blade frame: to suction, to the trailing edge, to the tip", ""),
}
GRAPH = {
    "normals": {"long_name": "unit normals of the points, outward", "units": "1"},
    "areas": {"long_name": "shares of the skin's area of the points", "units": "m2"},
    "edges": {"long_name": "pairs of neighbours among the points (span * landmarks + landmark)"},
    "triangles": {"long_name": "corners of the skin's triangles"},
}


def opened(store: Path, *, writing: bool = False) -> Any:
    """Return the group of a store, its arrays looked up one by one if it is written to."""
    if writing:
        return places.group(store, "r+", use_consolidated=False)
    return places.group(store, "r")


def is_complete(group: Any) -> bool:
    """Tell whether a store holds the variables of all its variants."""
    return "variant" in group and group.attrs.get("variants") == group["sections"].shape[0]


def complete(
    store: Path, manifest: Path, identity: Mapping[str, Any], about: Mapping[str, Any]
) -> None:
    """Add to a store what the manifest holds, and gather its metadata.

    Parameters
    ----------
    store, manifest : Path
        `sections.zarr` with all sections, and `manifest.parquet`.
    identity : mapping
        What `family.json` holds.
    about : mapping
        Attributes of the dataset: title, source, command and so on.

    Raises
    ------
    ExportError
        If the store cannot be written.
    """
    group = opened(store, writing=True)
    if not is_complete(group):
        _put(store, group, manifest, identity, only=None, about=about)


def add_labels(
    store: Path, manifest: Path, identity: Mapping[str, Any], labels: Sequence[str]
) -> None:
    """Add labels to a complete store whose manifest has come to hold them.

    Parameters
    ----------
    store, manifest : Path
        `sections.zarr` and `manifest.parquet`.
    identity : mapping
        What `family.json` holds by now.
    labels : sequence of str
        Those that are new.

    Raises
    ------
    ExportError
        If the store cannot be written.
    """
    new = {one.name for label in labels for one in FIGURES[label]}
    _put(store, opened(store, writing=True), manifest, identity, only=new, about={})


def _put(
    store: Path,
    group: Any,
    manifest: Path,
    identity: Mapping[str, Any],
    *,
    only: Collection[str] | None,
    about: Mapping[str, Any],
) -> None:
    """Write variables of the manifest, all with the split or only some, and gather metadata."""
    import zarr

    try:
        with parquet(manifest) as file, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # Zarr's, that consolidated metadata may change
            every = variables(file.schema_arrow.names, list(identity["factors"]))
            if only is None:
                _describe(group)
            axes = _axes(group, list(identity.get("labels", ())))
            wanted = [one for one in every if only is None or one.name in only]
            _fill(group, file, wanted, axes, int(identity["seed"]) if only is None else None)
            names = [parameter(factor).name for factor in identity["factors"]]
            told = {**about, **_said(every, names, axes), "variants": file.metadata.num_rows}
            group.attrs.update(told)
            zarr.consolidate_metadata(group.store)
    except OSError as error:
        raise ExportError(f"{store}: cannot be written: {error.strerror or error}") from None


def _said(wanted: list[Variable], parameters: list[str], axes: Mapping[str, int]) -> dict[str, Any]:
    names = [one.name for one in wanted if one.name in COORDINATES and one.name != "variant"]
    names += [name for name in COORDINATES if name in FIXED]
    return {
        "Conventions": CONVENTIONS,
        "parameters": parameters,
        "coordinates": " ".join([*names, *axes]),
    }


def _describe(group: Any) -> None:
    """Say what the sections and their axes are."""
    group["sections"].attrs.update(
        {"long_name": "points of the sections, blade frame", "units": "m"}
    )
    axes = np.array(["x", "y", "z"], dtype=np.dtypes.StringDType())
    group.create_array("xyz", data=axes, dimension_names=("xyz",), overwrite=True)
    if "normals" in group:
        spans, landmarks = group["sections"].shape[1:3]
        for name, values, each in (("edges", edges, "end"), ("triangles", triangles, "corner")):
            made = values(spans, landmarks).astype(np.int32)
            axes_of = (name[:-1], each)
            group.create_array(name, data=made, dimension_names=axes_of, overwrite=True)
        for name, said in GRAPH.items():
            group[name].attrs.update(said)
    for name, (dims, long_name, units) in FIXED.items():
        if group[name].metadata.dimension_names is None:  # of families before version 2
            values = group[name][:]
            group.create_array(name, data=values, dimension_names=dims, overwrite=True)
        group[name].attrs.update({"long_name": long_name} | ({"units": units} if units else {}))


def _axes(group: Any, labels: Sequence[str]) -> dict[str, int]:
    """Write the axes of labels, and what arrays of theirs hold; return the lengths of axes."""
    found = axes_of_labels(labels, group["eta"][:])
    for name, (dimension, values, long_name, units) in found.items():
        group.create_array(
            name,
            data=values,
            dimension_names=(dimension,),
            attributes={"long_name": long_name, "units": units},
            overwrite=True,
        )
    for one in LABELLED:
        if one.name in STORED and one.name in group:
            group[one.name].attrs.update(one.attributes)
    return {name: len(values) for name, (_, values, _, _) in found.items()}


def _fill(
    group: Any, file: Any, wanted: list[Variable], axes: Mapping[str, int], seed: int | None
) -> None:
    """Write variables, and the split by a seed if there is one, some rows at a time."""
    count, arrays = file.metadata.num_rows, {}
    lengths = {"variant": count, "span": group["sections"].shape[1], **axes}
    rows = max(1, CHUNK // lengths["span"], -(-count // MOST))
    split = Variable("split", "", ("variant",), f"{', '.join(SPLITS)}: {SHARES} on average")
    kinds = {
        one.name: column_values(file.schema_arrow.empty_table()[one.column]).dtype for one in wanted
    }
    for one in wanted if seed is None else [*wanted, split]:
        kind = kinds.get(one.name, np.dtypes.StringDType())
        shape = tuple(lengths[name] for name in one.dims)
        arrays[one.name] = group.create_array(
            one.name,
            shape=shape,
            dtype="str" if isinstance(kind, np.dtypes.StringDType) else kind,
            chunks=(min(max(rows, 1 if len(shape) > 1 else CHUNK), count), *shape[1:]),
            dimension_names=one.dims,
            attributes=one.attributes,
            overwrite=True,
        )
    for start, table in _tables(file, rows):
        end = start + len(table)
        for one in wanted:
            arrays[one.name][start:end] = column_values(table[one.column])
        if seed is not None:
            parts = split_of(np.arange(start, end), seed)
            arrays["split"][start:end] = np.array(SPLITS, dtype=np.dtypes.StringDType())[parts]


def _tables(file: Any, rows: int) -> Iterator[tuple[int, Any]]:
    """Read a manifest's row groups in turn, joined to at least so many rows: where, and they."""
    import pyarrow as pa

    start, held = 0, []
    for number in range(file.num_row_groups):
        held.append(file.read_row_group(number))
        if sum(map(len, held)) >= rows or number == file.num_row_groups - 1:
            joined = pa.concat_tables(held)
            yield start, joined
            start, held = start + len(joined), []


def column_values(column: Any) -> Any:
    """Return a manifest's column as an array: numbers, flags, matrices or texts."""
    import pyarrow as pa

    kind = column.type
    if pa.types.is_string(kind):
        return np.array(column.to_pylist(), dtype=np.dtypes.StringDType())
    whole = column.combine_chunks()
    if pa.types.is_fixed_size_list(kind):
        flat = whole.flatten().to_numpy(zero_copy_only=False)
        return flat.reshape(-1, kind.list_size)
    return whole.to_numpy(zero_copy_only=False)
