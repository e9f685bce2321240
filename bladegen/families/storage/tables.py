"""Tables as Parquet files, in folders and object stores: a row a variant."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.families.storage.places import flush, in_store, replacing

__all__ = ["columns_of", "parquet", "write_table"]


@contextmanager
def parquet(path: Path) -> Iterator[Any]:
    """Open a Parquet file for reading (`pyarrow.parquet.ParquetFile`)."""
    import pyarrow.parquet as pq

    if not in_store(path):
        with pq.ParquetFile(path) as file:
            yield file
        return
    with path.open("rb") as stream, pq.ParquetFile(stream) as file:
        yield file


def columns_of(path: Path, columns: Sequence[str]) -> dict[str, Any]:
    """Return columns of a Parquet file: texts as lists, numbers as arrays."""
    with parquet(path) as file:  # `read_table` would load pandas
        table = file.read(columns=list(columns))
    listed = {name: table.column(name).to_pylist() for name in columns}
    return {
        name: values if table.schema.field(name).type == "string" else np.array(values)
        for name, values in listed.items()
    }


def write_table(path: Path, rows: Mapping[str, Any]) -> None:
    """Write columns as a Parquet file that is whole or not there."""
    import pyarrow.parquet as pq

    with replacing(path) as temporary:
        pq.write_table(_table(rows), temporary, compression="zstd")
        flush(temporary)


def _table(rows: Mapping[str, Any]) -> Any:
    """Return columns as an Arrow table; matrices become lists of fixed length."""
    import pyarrow as pa

    columns = {}
    for name, values in rows.items():
        column = np.asarray(values)
        columns[name] = _column(column.reshape(-1))
        if column.ndim == 2:
            columns[name] = pa.FixedSizeListArray.from_arrays(columns[name], column.shape[1])
    return pa.table(columns)


def _column(values: Any) -> Any:
    """Return an Arrow array (n,) of numbers or texts; `pyarrow.array` would load pandas."""
    import pyarrow as pa

    if values.dtype.kind in "US":
        texts = [text.encode() for text in values.tolist()]
        offsets = np.cumsum([0, *map(len, texts)], dtype=np.int32)
        parts = pa.py_buffer(offsets), pa.py_buffer(b"".join(texts))
        return pa.StringArray.from_buffers(len(texts), *parts)
    data = np.packbits(values, bitorder="little") if values.dtype == bool else values
    kind = pa.from_numpy_dtype(values.dtype)
    return pa.Array.from_buffers(
        kind, len(values), [None, pa.py_buffer(np.ascontiguousarray(data))]
    )
