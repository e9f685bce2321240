"""A family's folder: what is in it, and how it comes to be there whole.

    family.json        what the family is (`identity`) and how its files are made
    manifest.parquet   one row a variant: factors, validity, volume, properties over span, files
    sections.zarr      the dataset (`dataset`): sections (count, spans, landmarks, 3) [m], `eta`,
                       `u`, and once the manifest is whole, what that holds
    CARD.md            the dataset's card; space.npz its space where it is not the bundled one
    blades/            files of each variant in the formats asked for
    parts/             while a run goes on: one Parquet file a finished block
    labels/            while labels are added: the same of labels, and which they are

A block is written in this order: sections and blades first, its part last, under a temporary
name that is changed when it is whole.  So a part says that its block is whole, and what a killed
run leaves without its part is written again.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from bladegen.errors import ExportError, FamilyError
from bladegen.families.family import BLOCK
from bladegen.families.forecasts import NoRoomError
from bladegen.families.identity import require_same
from bladegen.families.storage import places
from bladegen.families.storage.places import flush, folder, in_store, replacing
from bladegen.families.storage.tables import columns_of, parquet, write_table

__all__ = ["GRAPH", "FamilyFolder", "read_manifest"]

ZARR = "sections.zarr"
FLOAT_TYPES = {"float32": np.float32, "float64": np.float64}
GRAPH = {"normals": 4, "areas": 3}  # arrays beside the sections, and how many dimensions they have


@dataclass(frozen=True)
class FamilyFolder:
    """A folder that holds a family, or shall, in blocks of so many variants.

    Of this machine, or of an object store (`storage.places.located`).
    """

    path: Path
    block: int = BLOCK

    @property
    def manifest(self) -> Path:
        """The manifest of a finished family."""
        return self.path / "manifest.parquet"

    @property
    def description(self) -> Path:
        """What the family is."""
        return self.path / "family.json"

    @property
    def blades(self) -> Path:
        """Where the variants' own files lie."""
        return self.path / "blades"

    @property
    def parts(self) -> Path:
        """Where finished blocks are noted while a run goes on."""
        return self.path / "parts"

    @property
    def labels(self) -> Path:
        """Where finished blocks of labels are noted while they are added."""
        return self.path / "labels"

    def part(self, number: int) -> Path:
        """Return the file that says that a block is whole."""
        return self.parts / f"part-{number:06d}.parquet"

    def begin(self, wanted: dict[str, Any], *, resume: bool) -> None:
        """Make the folder a family's, or see that it is this family's.

        Raises
        ------
        FamilyError
            If the folder holds another family, or this one and nobody asked to go on.
        """
        folder(self.path)
        wanted = json.loads(json.dumps(wanted))
        if self.description.exists():
            try:
                found = json.loads(self.description.read_text(encoding="utf-8"))
            except (OSError, ValueError):
                found = {}
            require_same(self.path, wanted, found if isinstance(found, dict) else {})
            if not resume:
                raise FamilyError(
                    f"{self.path}: holds this family already, whole or in part; --resume goes on"
                )
        elif self.manifest.exists() or (self.store).exists():
            raise FamilyError(f"{self.path}: holds data without family.json; take another folder")
        else:
            with replacing(self.description) as temporary:
                temporary.write_text(json.dumps(wanted, indent=2) + "\n", encoding="utf-8")
        folder(self.parts)

    def alone(self) -> AbstractContextManager[None]:
        """Hold the folder, so that no second run writes into it.

        Raises
        ------
        ExportError
            If another run holds it, or it cannot be written.
        """
        return places.alone(self.path, "family")

    @contextmanager
    def undone_if_refused(self) -> Iterator[None]:
        """Take away what was begun for a family that is refused, unless it was there before."""
        fresh = not self.path.exists() or not any(
            entry.exists() for entry in (self.description, self.manifest, self.store)
        )
        try:
            yield
        except NoRoomError:
            if fresh:
                for entry in (self.store, self.blades, self.parts):
                    places.removed(entry)
                self.description.unlink(missing_ok=True)
            raise

    def bytes_of(self, number: int, stems: Sequence[Path]) -> int:
        """Return the size of a whole block's part, and of files that begin with some stems."""
        files = [self.part(number)]
        for stem in stems:
            for found in stem.parent.glob(f"{stem.name}[._-]*"):
                files += (
                    [found] if found.is_file() else [p for p in found.rglob("*") if p.is_file()]
                )
        return sum(file.stat().st_size for file in files)

    def open_blocks(self, count: int) -> list[int]:
        """Return the numbers of the blocks that are not whole yet."""
        if self.manifest.exists():
            return []
        there = {path.name for path in self.parts.glob("part-*.parquet")}
        return [i for i in range(-(-count // self.block)) if self.part(i).name not in there]

    def make_sections(
        self,
        eta: Any,
        u: Any,
        count: int,
        dtype: str,
        beside: Mapping[str, tuple[tuple[str, ...], tuple[int, ...]]] = MappingProxyType({}),
    ) -> None:
        """Make the empty store of sections, and of arrays `beside` them, if it is not there."""
        own = {"sections": (("span", "landmark", "xyz"), (len(eta), len(u), 3))}
        try:
            group = places.group(self.store, "a", zarr_format=3, use_consolidated=False)
            group.attrs.update({"unit": "m", "axes": "variant, span, landmark, xyz"})
            self._require(group, count, own, dtype)
            self._require(group, count, beside)
            for name, dimension, values in (("eta", "span", eta), ("u", "landmark", u)):
                if name not in group:
                    group.create_array(name, data=np.array(values), dimension_names=(dimension,))
        except OSError as error:
            raise self._unwritten(error) from None

    def _unwritten(self, error: OSError) -> ExportError:
        return ExportError(f"{self.store}: cannot be written: {error.strerror or error}")

    def make_beside(
        self, count: int, beside: Mapping[str, tuple[tuple[str, ...], tuple[int, ...]]]
    ) -> None:
        """Make empty arrays in a store that is there, if they are not."""
        try:
            self._require(self._arrays, count, beside)
        except OSError as error:
            raise self._unwritten(error) from None

    def _require(
        self,
        group: Any,
        count: int,
        arrays: Mapping[str, tuple[tuple[str, ...], tuple[int, ...]]],
        dtype: str = "float32",
    ) -> None:
        for name, (dimensions, lengths) in arrays.items():
            group.require_array(
                name,
                shape=(count, *lengths),
                dtype=dtype,
                chunks=(1, *lengths),
                shards=(self.block, *lengths),
                compressors=None,
                dimension_names=("variant", *dimensions),
            )

    @property
    def sections(self) -> Any:
        """The Zarr array of sections."""
        return self._arrays["sections"]

    @property
    def _arrays(self) -> Any:
        return places.group(self.store, "r+", use_consolidated=False)

    def stored_block(self) -> int | None:
        """Return how many variants a shard of the store holds; None without one."""
        if not (self.store / "sections" / "zarr.json").is_file():
            return None
        return int(self._arrays["sections"].shards[0])

    def write_block(
        self, number: int, arrays: Mapping[str, Any], rows: Mapping[str, Any], part: Path
    ) -> None:
        """Write a block's arrays of the store, then its part: rows of the manifest."""
        start, group = number * self.block, self._arrays
        try:
            for name, values in arrays.items():
                group[name][start : start + len(values)] = values
                if not in_store(self.store):
                    flush(self.store / name / "c" / str(number))
        except OSError as error:
            raise self._unwritten(error) from None
        write_table(part, rows)

    @property
    def store(self) -> Path:
        """The store of sections."""
        return self.path / ZARR

    def finish(self, count: int) -> None:
        """Join the parts to the manifest, and tidy up."""
        import pyarrow.parquet as pq

        numbers = range(-(-count // self.block))
        if not self.manifest.exists():
            with replacing(self.manifest) as temporary:
                with parquet(self.part(0)) as first:
                    schema = first.schema_arrow
                with pq.ParquetWriter(temporary, schema, compression="zstd") as writer:
                    for number in numbers:
                        with parquet(self.part(number)) as part:
                            writer.write_table(part.read())
                flush(temporary)
        places.removed(self.parts)
        if in_store(self.path):
            return  # objects are whole
        for left in [*self.path.glob(f"{ZARR}/**/*.partial"), *self.blades.glob("**/.*")]:
            left.unlink(missing_ok=True)  # what killed runs were writing


def read_manifest(place: FamilyFolder, columns: Sequence[str]) -> dict[str, Any]:
    """Return columns of a manifest: texts as lists, numbers as arrays."""
    return columns_of(place.manifest, columns)
