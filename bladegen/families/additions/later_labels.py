"""Labels of a family that is whole: beside what its folder holds, as if made with it.

Each block's sections are those of the store, its parameters those of the manifest.  While it goes
on, the folder `labels` notes which labels they are and, one Parquet file a block, what is whole;
readers see the family as it was.  Then the manifest, `family.json`, the store's variables and the
card follow in this order, each whole or not there, and `labels` goes last: a run that was killed
anywhere goes on.
"""

import json
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.blade.variants.members import Batch
from bladegen.errors import FamilyError
from bladegen.families.additions.unfinished import note, unfinished
from bladegen.families.block import Block
from bladegen.families.dataset import store
from bladegen.families.dataset.loading import LoadedFamily
from bladegen.families.dataset.writing import write_card
from bladegen.families.folder import FamilyFolder
from bladegen.families.identity import require_current
from bladegen.families.labels.figures import FIGURES, LABELS
from bladegen.families.labels.labelling import Labelling, checked
from bladegen.families.processes import in_threads, on_cluster
from bladegen.families.storage.places import removed, replacing, told
from bladegen.families.storage.tables import parquet
from bladegen.support.arguments import whole
from bladegen.support.threads import one_thread

__all__ = ["add_labels"]


def add_labels(
    family: LoadedFamily,
    labels: Sequence[str],
    *,
    jobs: int = 1,
    client: Any = None,
    progress: Callable[[int], None] = lambda _: None,
) -> int:
    """Add labels to a family that was written; return of how many variants some were computed now.

    Load the family again to see them.  Called again after it was stopped, it goes on; labels that
    the family has are left as they are.

    Parameters
    ----------
    family : LoadedFamily
        From `load_family`, with the baseline where it is no bundled blade.
    labels : sequence of str
        Of "polars", "rotor" and "mass".
    jobs : int
        Threads.
    client : dask.distributed.Client, optional
        A cluster instead, whose workers see the folder under the same name.
    progress : callable
        Told how many variants are whole, each time some are.

    Raises
    ------
    FamilyError
        If a label is not known or cannot be computed of this family, the baseline is another one,
        or the family has the label by other settings.
    ExportError
        If something cannot be written, or another run writes into the folder.
    """
    if whole(jobs, "jobs", FamilyError) < 1:
        raise FamilyError(f"jobs: got {jobs}, must be at least 1")
    require_current(family.path, family.identity)
    if not store.is_complete(family.store):
        raise FamilyError(
            f"{family.path}: its store is not a whole dataset; the command that made it, with "
            "--resume, completes it"
        )
    wanted = checked(labels, family.planned)
    _ = family[int(np.argmax(family.valid))]  # is held against its stored sections
    place = FamilyFolder(family.path, family["sections"].shards[0])
    with told(place.path), place.alone():
        added = _begun(family, place, wanted)
        if not added:
            return 0
        addition = Addition(family, place, Labelling(family.planned, added))
        return addition.made(jobs, progress, client)


@dataclass(frozen=True, eq=False)
class Addition:
    """Labels that are added to a family.

    Parameters
    ----------
    family : LoadedFamily
        As it is before.
    place : FamilyFolder
        Its folder.
    labelling : Labelling
        What computes them.
    """

    family: LoadedFamily
    place: FamilyFolder
    labelling: Labelling

    @cached_property
    def rows(self) -> dict[str, Any]:
        """What the manifest says of soundness and draws."""
        return {name: self.family[name][:] for name in ("reason", "attempts")}

    def made(self, jobs: int, progress: Callable[[int], None], client: Any = None) -> int:
        """Compute what is not whole, and finish; return of how many variants."""
        count, size = len(self.family), self.place.block
        self.place.make_beside(count, self.labelling.arrays())
        left = [i for i in range(-(-count // size)) if not self._part(i).exists()]
        before = done = count - sum(min(size, count - i * size) for i in left)
        progress(done)
        made: Generator[int]
        if left and client is not None:
            plain = replace(self, family=replace(self.family), labelling=replace(self.labelling))
            made = on_cluster(Addition.block, plain, left, client, self.place.path)
        elif left and jobs > 1:
            _ = self.rows, self.labelling.settings  # threads share them
            made = in_threads(self.block, left, min(jobs, len(left)))
        else:
            made = (self.block(number) for number in left)
        with closing(made):
            for variants in made:
                done += variants
                progress(done)
        self._finish()
        return done - before

    def _part(self, number: int) -> Path:
        return self.place.labels / self.place.part(number).name

    def block(self, number: int) -> int:
        """Compute one block, whole; return how many variants it has."""
        size = self.place.block
        index = np.arange(number * size, min((number + 1) * size, len(self.family)))
        with one_thread():  # the same sums in the same order, whatever the machine
            block = self._block(index)
            labels = self.labelling.computed(block)
        stored = {name: labels.pop(name) for name in self.labelling.arrays()}
        rows = {"index": index} | labels
        self.place.write_block(number, stored, rows, self._part(number))
        return len(index)

    def _block(self, index: Any) -> Block:
        """Return some variants as they are stored."""
        family, here = self.family, slice(int(index[0]), int(index[-1]) + 1)
        sections = np.asarray(family["sections"][here])
        reasons, attempts = (self.rows[name][here] for name in self.rows)
        b, k = sections.shape[:2]
        nothing = np.zeros((b, k))
        batch = Batch(
            sections, nothing, nothing, nothing, nothing.astype(np.int64), np.zeros((b, k, 0))
        )
        values = family.planned.design.at(index)
        reasons = tuple(map(str, reasons))
        return Block(index, values, np.asarray(attempts), reasons, reasons, batch)

    def _finish(self) -> None:
        """Put the labels into manifest, description, dataset and card."""
        place, family = self.place, self.family
        _join(place, self._part)
        found = json.loads(place.description.read_text(encoding="utf-8"))
        labels = found.get("labels", {}) | self.labelling.settings
        found["labels"] = {label: labels[label] for label in LABELS if label in labels}
        with replacing(place.description) as temporary:
            temporary.write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
        store.add_labels(place.store, place.manifest, found, self.labelling.labels)
        write_card(place, found, family.attributes)
        removed(place.labels)


def _begun(family: LoadedFamily, place: FamilyFolder, wanted: Sequence[str]) -> tuple[str, ...]:
    """Return the labels that are to be added, noted in the folder; none if all are there."""
    there = {**family.identity.get("labels", {})}
    asked = _plain(Labelling(family.planned, tuple(wanted)).settings)
    begun = unfinished(place)
    for label, settings in asked.items():
        known = there.get(label, begun.get(label, settings))
        if known != settings:
            raise FamilyError(
                f"{family.path}: has {label} by other settings ({json.dumps(known)} there, "
                f"{json.dumps(settings)} now); make the family anew, with --label {label}"
            )
    added = {k: v for k, v in asked.items() if k in begun or k not in there}
    if begun and added != begun:
        raise FamilyError(
            f"{family.path}: {' and '.join(begun)} are not finished; "
            f"`bladegen label {family.path} {' '.join(begun)}` goes on"
        )
    if added and not begun:
        note(place, added)
    return tuple(added)


def _plain(settings: Any) -> Any:
    return json.loads(json.dumps(settings))


def _join(place: FamilyFolder, part: Callable[[int], Path]) -> None:
    """Put the columns of labels into the manifest, in the order of labels made with a family."""
    import pyarrow.parquet as pq

    names = [one.name for label in LABELS for one in FIGURES[label]]
    with parquet(place.manifest) as file:
        with parquet(part(0)) as first:
            if set(first.schema_arrow.names) <= set(file.schema_arrow.names):
                return
        with replacing(place.manifest) as temporary:
            writer = None
            for number in range(file.num_row_groups):
                table = file.read_row_group(number)
                with parquet(part(number)) as added:
                    for field, column in zip(added.schema_arrow, added.read().columns, strict=True):
                        if field.name != "index":
                            table = table.append_column(field, column)
                own = [name for name in table.column_names if name not in names]
                table = table.select(
                    [*own, *(name for name in names if name in table.column_names)]
                )
                writer = writer or pq.ParquetWriter(temporary, table.schema, compression="zstd")
                writer.write_table(table)
            assert writer is not None  # a family has a variant
            writer.close()
