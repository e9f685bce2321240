"""A family's folder as a value: its arrays by name, its blades by index, its splits.

`load_family` needs Zarr and NumPy alone.  Families of version 1 are read as well: what their store
does not hold comes from the manifest.
"""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, SupportsIndex

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.errors import FamilyError, MissingLibraryError
from bladegen.families.conditions import at_spans, matching, named, numbers, placed
from bladegen.families.dataset.graphs import edges, surface, triangles
from bladegen.families.dataset.reading import batches, place_of
from bladegen.families.dataset.replanning import planned_again
from bladegen.families.dataset.splits import SHARES, SPLITS, split_of
from bladegen.families.dataset.store import column_values, opened
from bladegen.families.dataset.variables import parameter, variables
from bladegen.families.family import Family
from bladegen.families.identity import require_current
from bladegen.families.storage.places import content, in_store, located, told
from bladegen.families.storage.tables import parquet
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arguments import one_of, suggestion, whole
from bladegen.support.arrays import Array, Indices, readonly

__all__ = ["LoadedFamily", "load_family"]

MOST = 2**20  # bytes of family.json
SAME = 1e-6  # of the blade's length: how far a blade may lie from stored sections, float32 or not


@dataclass(frozen=True, eq=False, repr=False)
class LoadedFamily:
    """A family that was written, opened for reading.  `load_family` makes one.

    ``family["chord"]`` is an array of the store, read when it is sliced; ``family[3]`` is a blade.

    Parameters
    ----------
    path : Path
        The folder.
    identity : dict
        What the family is: the content of `family.json`.
    baseline : Blade, optional
        What was perturbed, where it is no bundled blade.
    space : ShapeSpace, optional
        Its modes, where it is not the bundled space.
    """

    path: Path
    identity: dict[str, Any]
    baseline: Blade | None = None
    space: ShapeSpace | None = None

    def __repr__(self) -> str:
        return f"<Family of {self.identity['blade']} in {self.path}: {len(self)} variants>"

    def __len__(self) -> int:
        return int(self.store["sections"].shape[0])

    @cached_property
    def store(self) -> Any:
        """The Zarr group."""
        return opened(self.path / "sections.zarr")

    @cached_property
    def attributes(self) -> dict[str, Any]:
        """What the dataset says of itself: version, command, seed, baseline."""
        return dict(self.store.attrs)

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of all arrays."""
        return tuple(dict.fromkeys([*self.store.array_keys(), *self.columns]))

    @cached_property
    def columns(self) -> dict[str, str]:
        """Columns of the manifest by the names of their arrays."""
        with parquet(self.path / "manifest.parquet") as file:
            columns = file.schema_arrow.names
        return {one.name: one.column for one in variables(columns, self.factors)}

    @cached_property
    def factors(self) -> tuple[str, ...]:
        """Names of what varies, as `bladegen.family` takes them."""
        return tuple(self.identity["factors"])

    @cached_property
    def parameters(self) -> Array:
        """What varies, (variants, factors), in radians or as factors, `factors` in order."""
        columns = []
        for factor in self.factors:
            values = np.asarray(self[parameter(factor).name][:], dtype=np.float64)
            columns.append(np.radians(values) if factor == "twist" else values)
        return readonly(np.stack(columns, axis=-1))

    def __getitem__(self, key: str | SupportsIndex | slice) -> Any:
        """Return an array by name, or the blade of a variant, or a list of blades."""
        if isinstance(key, str):
            return self._array(key)
        if isinstance(key, slice):
            return [self._blade(place) for place in range(*key.indices(len(self)))]
        return self._blade(place_of(key, len(self)))

    def __contains__(self, name: object) -> bool:
        """Tell whether there is an array of this name."""
        return name in self.names

    def _array(self, name: str) -> Any:
        if name in self.store:
            return self.store[name]
        if name in self.columns:
            with parquet(self.path / "manifest.parquet") as file:
                return column_values(file.read([self.columns[name]]).column(0))
        near = suggestion(name, self.names)
        raise FamilyError(f"{self.path}: holds no {name!r}, but {', '.join(self.names)}{near}")

    @cached_property
    def valid(self) -> Any:
        """Which variants are sound, (variants,)."""
        return np.asarray(self["valid"][:])

    def table(self) -> Any:
        """Return the manifest, a row a variant, as a `pyarrow.Table`."""
        with parquet(self.path / "manifest.parquet") as file:
            return file.read()

    @cached_property
    def numbers(self) -> dict[str, Array]:
        """What each variant has one number of: factors, volume, labels; (variants,) by name."""
        return numbers(self.table(), self.columns)

    def where(self, conditions: str) -> Indices:
        """Return the places of the variants that fulfil conditions, in order.

        On `numbers`, and on arrays over span at a place: "thickness@0.7 < 0.24".

        >>> family.where("volume > 600 and thickness_change < 1.02")  # doctest: +SKIP
        """
        eta, wanted = np.asarray(self["eta"][:]), named(conditions)
        of_names = {name.partition("@")[0] for name in wanted} & set(self.names)
        shape = len(self), len(eta)
        spanwise = placed(eta, wanted, [n for n in of_names if self[n].shape == shape])
        known = self.numbers | at_spans(eta, spanwise, lambda n, part: self[n][:, part])
        return np.flatnonzero(matching(known, conditions))

    def split(
        self,
        part: str,
        *,
        seed: int | None = None,
        shares: tuple[float, float, float] = SHARES,
        sound: bool = True,
    ) -> Indices:
        """Return the places of the variants of "train", "validation" or "test", in order.

        Parameters
        ----------
        part : str
            Which.
        seed : int, optional
            Of the split, the family's own if not given, as the variable `split` has it.
        shares : three floats
            Of training, validation and test, met on average.
        sound : bool
            Leave out variants that are not sound.
        """
        one_of(part, SPLITS, "split", FamilyError)
        seed = self.identity["seed"] if seed is None else whole(seed, "seed", FamilyError)
        places = np.arange(len(self))
        parts = split_of(places, seed, shares)
        wanted: Indices = places[(parts == SPLITS.index(part)) & (self.valid | (not sound))]
        return wanted

    def batches(
        self,
        names: Sequence[str] = ("parameters", "sections"),
        size: int = 64,
        *,
        places: Indices | None = None,
        rng: np.random.Generator | int | None = None,
    ) -> Iterator[dict[str, Any]]:
        """Give arrays of some variants after others, by name: what a training loop reads.

        Parameters
        ----------
        names : sequence of str
            Arrays of the store, or "parameters"; one alone may be a text.
        size : int
            Variants at once; the last ones may be fewer.
        places : (b,) array of int, optional
            Which variants, all if not given: `split` gives them; or True and False for each.
        rng : numpy.random.Generator, optional
            Shuffles: shards in any order, and the variants of some shards that lie in memory
            together, so that each shard is read once.
        """
        return batches(self, names, size, places, rng)

    def graph(self, place: int) -> dict[str, Any]:
        """Return a variant as a graph, for learning on geometry, as NumPy arrays.

        ``points`` (n, 3) [m], ``normals`` (n, 3), ``areas`` (n,) [m2], ``edges`` (e, 2) and
        ``triangles`` (f, 3); points in the order of the sections, root to tip.  A family made with
        ``--format graph`` holds them; of others they are computed.
        """
        place = place_of(place, len(self))
        sections = np.asarray(self["sections"][place])
        stored = "normals" in self.store
        made = [self[name][place] for name in ("normals", "areas")] if stored else surface(sections)
        normals, areas = (np.asarray(part, dtype=np.float32) for part in made)
        spans, landmarks = sections.shape[:2]
        return {
            "points": sections.reshape(-1, 3),
            "normals": normals.reshape(-1, 3),
            "areas": areas.reshape(-1),
            "edges": edges(spans, landmarks),
            "triangles": triangles(spans, landmarks),
        }

    def _blade(self, place: int) -> Blade:
        made: Blade = self.planned.variant(place)
        stored = np.asarray(self.store["sections"][place], dtype=np.float64)
        apart = float(np.abs(made.sections(self.planned.eta) - stored).max())
        if not apart <= SAME * made.length:
            raise FamilyError(
                f"{self.path}: variant {place} lies {apart:.2g} m off its stored sections, so the "
                f"baseline or the space is another; load_family(path, blade=..., space=...)"
            )
        return made

    @cached_property
    def planned(self) -> Family:
        """The family as a plan, its variants where the manifest says that they lie."""
        require_current(self.path, self.identity)
        return planned_again(
            self.path,
            {**self.attributes, **self.identity},
            dict(zip(self.factors, self.parameters.T, strict=True)),
            np.asarray(self.store["eta"][:]),
            self.baseline,
            self.space,
        )

    def dataset(self) -> Any:
        """Return the store as an `xarray.Dataset`, where xarray is installed."""
        try:
            import xarray
        except ImportError as error:
            raise MissingLibraryError(error) from None
        store = self.path / "sections.zarr"
        return xarray.open_zarr(str(store) if in_store(store) else store)


def load_family(
    path: str | Path, *, blade: Blade | None = None, space: ShapeSpace | None = None
) -> LoadedFamily:
    """Open a family that `bladegen family` wrote.

    Parameters
    ----------
    path : str or Path
        Its folder, of this machine or of an object store ("s3://bucket/family").
    blade : Blade, optional
        The baseline, for blades by index, where it is no bundled one.
    space : ShapeSpace, optional
        The space of its modes, where the folder does not tell it.

    Raises
    ------
    FamilyError
        If the folder holds no family that is whole.
    """
    folder = located(path)
    folder = folder.parent if folder.name in ("sections.zarr", "manifest.parquet") else folder
    described, manifest = folder / "family.json", folder / "manifest.parquet"
    with told(folder):
        begun, whole_one = described.is_file(), manifest.is_file()
    if not begun:
        raise FamilyError(f"{path}: holds no family; `bladegen family BLADE -o {path}` makes one")
    if not whole_one:
        raise FamilyError(
            f"{path}: its family is not whole; the same command with --resume goes on"
        )
    try:
        identity = json.loads(content(described, MOST))
        factors = dict(identity["factors"])
    except (ValueError, KeyError, TypeError):
        raise FamilyError(f"{described}: says not what the family is") from None
    return LoadedFamily(folder, {**identity, "factors": factors}, blade, space)
