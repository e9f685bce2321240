"""A family's folder as one dataset, held against xarray and the family that it was made from."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
import trimesh
import xarray
import zarr
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cli import commands
from bladegen.errors import FamilyError, PlaceError
from bladegen.families.dataset import graphs
from bladegen.families.dataset.splits import SHARES, SPLITS, split_of
from bladegen.families.identity import require_same
from bladegen.families.order import Order
from bladegen.families.run import run
from strategies import by_day

OLD = Path(__file__).parent / "version_1_family"  # by bladegen 1.0.0 itself, nrel5mw
COUNT, SPANS = 70, 16  # more than a shard
NIGHT = pytest.mark.nightly
BOUNDS = {"twist": (-0.02, 0.03), "thickness": (0.9, 1.1)}


@pytest.fixture(scope="module")
def planned():
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101)
    how = {"count": COUNT, "seed": 7, "spans": SPANS, "reach": 0.3, "bounds": BOUNDS}
    return bg.family(blade, bg.ShapeSpace.bundled(), **how)


@pytest.fixture(scope="module")
def folder(planned, tmp_path_factory):
    target = tmp_path_factory.mktemp("dataset") / "family"
    assert run(Order(planned, target)) == COUNT
    return target


def test_xarray_opens_a_family_as_one_dataset(folder, planned):
    with xarray.open_zarr(folder / "sections.zarr", consolidated=True) as data:
        assert dict(data.sizes) == {"variant": COUNT, "span": SPANS, "landmark": 101, "xyz": 3}
        assert data["sections"].dims == ("variant", "span", "landmark", "xyz")
        assert set(data.coords) == {"variant", "name", "eta", "u", "xyz"}
        assert data["xyz"].values.tolist() == ["x", "y", "z"]
        assert data.attrs["parameters"] == [
            "t1",
            "t2",
            "t3",
            "t4",
            "thickness_change",
            "twist_change",
        ]
        block = planned.block(np.arange(5), dtype=np.float32, measured=True)
        assert_array_equal(data["sections"][:5], block.batch.sections)
        assert_array_equal(data["chord"][:5], block.batch.chord)
        assert_allclose(np.radians(data["twist"][:5]), block.batch.twist, rtol=0, atol=1e-15)
        assert_array_equal(data["thickness"][:5], block.batch.relative_thickness)
        assert_array_equal(data["area"][:5], block.batch.measures[..., 0])
        values = planned.block(np.arange(COUNT)).values
        for name, column in zip(data.attrs["parameters"][:5], values.T, strict=False):
            assert_array_equal(data[name], column)
        near = data.set_xindex("eta").sel(eta=0.5, method="nearest")
        assert abs(float(near["eta"]) - 0.5) < 1.0 / SPANS


def test_every_variable_says_what_it_is(folder):
    group = zarr.open_group(folder / "sections.zarr", mode="r")
    for name, array in group.arrays():
        assert array.metadata.dimension_names is not None, name
        assert array.attrs["long_name"], name
        numeric = np.issubdtype(array.dtype, np.floating)
        assert not numeric or array.attrs["units"], name
    said = group.attrs
    assert said["seed"] == 7
    assert said["baseline"] == "nrel5mw"
    assert said["bladegen_version"] == bg.__version__
    assert "made_from" in said
    assert group.metadata.consolidated_metadata is not None


def test_a_manifests_columns_are_in_the_dataset(folder):
    table = pq.read_table(folder / "manifest.parquet")
    family = bg.load_family(folder)
    assert family.table().equals(table)
    assert set(family.columns.values()) == set(table.column_names) - {"seed"}
    for name, column in family.columns.items():
        stored, wanted = np.asarray(family[name][:]), table[column].to_pylist()
        assert stored.tolist() == wanted, name


def test_a_loaded_family_gives_blades_by_index(folder, planned):
    family = bg.load_family(folder)
    assert len(family) == COUNT
    assert_allclose(family.parameters, planned.block(np.arange(COUNT)).values, rtol=0, atol=1e-15)
    for place in (3, -1):
        assert family[place].name == planned[place].name
        apart = family[place].sections(planned.eta) - family["sections"][place]
        assert np.abs(apart).max() < 1e-5
    assert [one.name for one in family[1:3]] == ["nrel5mw-00001", "nrel5mw-00002"]
    assert "nrel5mw" in repr(family)
    assert family.dataset().sizes["variant"] == COUNT
    assert len(bg.load_family(folder / "sections.zarr")) == COUNT


def test_a_blade_that_does_not_lie_on_its_stored_sections_is_refused(folder, planned):
    other = bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=101)
    with pytest.raises(FamilyError, match="off its stored sections"):
        bg.load_family(folder, blade=other)[0]
    assert bg.load_family(folder, blade=planned.blade, space=planned.space)[0].name


def test_baselines_and_spaces_of_ones_own(tmp_path):
    plain = bg.ShapeSpace.bundled()
    own = replace(plain, modes=plain.modes[:2], coordinates=plain.coordinates[:, :2])
    definition = replace(bg.read("nrel5mw"), name="mine")
    mirrored = bg.Blade.from_definition(definition, path="geodesic").mirror_image()
    made = bg.family(mirrored, own, count=2, spans=12, reach=0.2)
    run(Order(made, tmp_path))
    with pytest.raises(
        FamilyError, match=r"'mine' is no bundled blade; load_family\(path, blade=\.\.\.\)"
    ):
        bg.load_family(tmp_path)[0]
    family = bg.load_family(tmp_path, blade=mirrored)
    assert_allclose(family[1].sections([0.7]), made[1].sections([0.7]), rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", by_day("nrel5mw"))
def test_settings_of_a_bundled_baseline_are_found_again(name, tmp_path):
    blade = bg.Blade.from_definition(bg.read(name), landmarks=61, path="geodesic").mirror_image()
    made = bg.family(blade, count=1, spans=16, bounds={"chord": (0.95, 1.0)}, design="box")
    run(Order(made, tmp_path))
    assert bg.load_family(tmp_path)[0].name == made[0].name


def test_what_version_1_wrote_itself_is_read(tmp_path):
    family = bg.load_family(OLD)
    assert family.identity["bladegen"] == "1.0.0"
    assert family["sections"].shape == (3, 9, 401, 3)
    assert np.ptp(family.parameters, axis=0).min() > 0
    told = CliRunner().invoke(commands.app, ["info", str(OLD)])
    assert told.exit_code == 0
    assert "bladegen 1.0.0" in told.output
    with pytest.raises(FamilyError, match=r"made by bladegen 1\.0\.0, whose blades lie elsewhere"):
        family[0]
    shutil.copytree(OLD, tmp_path / "old")
    for words in (
        ["label", str(tmp_path / "old"), "mass"],
        ["family", "nrel5mw", "-o", str(tmp_path / "old"), "--count", "3", "--resume"],
        ["family", "nrel5mw", "-o", str(tmp_path / "old"), "--count", "5", "--append"],
    ):
        refused = CliRunner().invoke(commands.app, words)
        assert isinstance(refused.exception, FamilyError)
        assert "made by bladegen 1.0.0" in str(refused.exception)


def test_families_without_a_dataset_are_read(folder, tmp_path):
    old = tmp_path / "old"
    shutil.copytree(folder, old)
    (old / "CARD.md").unlink()
    shutil.rmtree(old / "sections.zarr")
    store = zarr.open_group(old / "sections.zarr", mode="w", zarr_format=3)
    now = zarr.open_group(folder / "sections.zarr", mode="r")
    store.attrs.update({"unit": "m", "axes": "variant, span, landmark, xyz"})
    for array in ("sections", "eta", "u"):
        store.create_array(array, data=now[array][:])
    new, was = bg.load_family(folder), bg.load_family(old)
    assert set(was.names) == set(new.names) - {"split", "xyz"}
    for name in was.names:
        assert_array_equal(np.asarray(was[name][:]), np.asarray(new[name][:]))
    assert was[2].name == new[2].name
    assert_array_equal(was.split("test"), new.split("test"))


def test_a_whole_family_without_a_dataset_gets_one_when_it_is_resumed(folder, planned, tmp_path):
    old = tmp_path / "old"
    shutil.copytree(folder, old)
    store = zarr.open_group(old / "sections.zarr", mode="r+", use_consolidated=False)
    for name in [n for n in store.array_keys() if n not in ("sections", "eta", "u")]:
        del store[name]
    store.attrs.put({"unit": "m", "axes": "variant, span, landmark, xyz"})
    for name in ("eta", "u"):
        store.create_array(name, data=store[name][:], overwrite=True)
    assert run(Order(planned, old), resume=True) == 0
    with (
        xarray.open_zarr(old / "sections.zarr") as was,
        xarray.open_zarr(folder / "sections.zarr") as new,
    ):
        assert was.identical(new)


@given(st.integers(0, 2**70), st.lists(st.integers(0, 10**7), min_size=1, max_size=20))
def test_a_variants_split_depends_on_its_place_and_the_seed_alone(seed, places):
    together = split_of(np.array(places), seed)
    assert_array_equal(together, [split_of(np.array([one]), seed)[0] for one in places])
    assert set(together.tolist()) <= set(range(len(SPLITS)))


@given(st.integers(0, 2**40))
def test_splits_have_their_shares(seed):
    count = 4000
    found = np.bincount(split_of(np.arange(count), seed), minlength=3) / count
    assert_allclose(found, SHARES, atol=6 * np.sqrt(0.25 / count))
    neighbour = split_of(np.arange(count), seed + 1)
    alike = np.mean(neighbour == split_of(np.arange(count), seed))
    assert abs(alike - sum(share**2 for share in SHARES)) < 0.06


def test_splits_part_a_family(folder):
    family = bg.load_family(folder)
    parts = [family.split(name) for name in SPLITS]
    assert_array_equal(np.sort(np.concatenate(parts)), np.arange(COUNT))
    for name, places in zip(SPLITS, parts, strict=True):
        assert set(family["split"][:][places].tolist()) == {name}
    other = family.split("train", seed=8, shares=(0.5, 0.25, 0.25))
    assert not np.array_equal(other, parts[0])
    with pytest.raises(FamilyError, match="must be three that sum to 1"):
        family.split("train", shares=(0.5, 0.5, 0.5))
    with pytest.raises(FamilyError, match="allowed are train, validation, test"):
        family.split("dev")


@given(st.integers(1, 90), st.integers(0, 5), st.booleans())
def test_batches_give_each_variant_once(folder, size, seed, shuffled):
    family = bg.load_family(folder)
    places = np.random.default_rng(seed).permutation(COUNT)[: 20 + 10 * seed]
    rng = np.random.default_rng(seed) if shuffled else None
    parts = list(family.batches(("variant", "parameters", "chord"), size, places=places, rng=rng))
    sizes = [len(part["variant"]) for part in parts]
    assert sizes[:-1] == [size] * (len(sizes) - 1)
    assert 0 < sizes[-1] <= size
    seen = np.concatenate([part["variant"] for part in parts])
    assert_array_equal(np.sort(seen), np.sort(places))
    together = np.concatenate([part["parameters"] for part in parts])
    assert_array_equal(together, family.parameters[seen])
    assert_array_equal(np.concatenate([part["chord"] for part in parts]), family["chord"][:][seen])


def test_batches_are_the_same_for_the_same_generator_and_refuse_what_is_not_there(folder):
    family = bg.load_family(folder)
    one, two, three = (
        np.concatenate(
            [
                part["variant"]
                for part in family.batches(("variant",), 8, rng=np.random.default_rng(s))
            ]
        )
        for s in (1, 1, 2)
    )
    assert_array_equal(one, two)
    assert not np.array_equal(one, three)
    with pytest.raises(FamilyError, match="size: got 0"):
        next(family.batches(size=0))
    with pytest.raises(FamilyError, match=r"holds no 'cord', but .* did you mean chord"):
        next(family.batches(("cord",)))


def test_the_card_says_what_a_reader_needs(folder):
    text = (folder / "CARD.md").read_text(encoding="utf-8")
    for wanted in (
        "# 70 variants of nrel5mw",
        "xarray.open_zarr",
        "bg.load_family",
        "seed 7",
        "## Licence and citation",
        "## Splits",
        f"{COUNT} of {COUNT} are sound",
    ):
        assert wanted in text, wanted
    family = bg.load_family(folder)
    for name in ("t1", "thickness_change"):  # what the variants hold, not what was asked for
        low, high = family[name][:].min(), family[name][:].max()
        assert f"| `{name}` | {low:.6g} | {high:.6g} | " in text


def test_places_and_names_are_what_they_are_taken_for(folder):
    """A mask of variants was taken for the places 0 and 1, a name for its letters."""
    family = bg.load_family(folder)
    mask = np.asarray(family["volume"][:]) > np.median(family["volume"][:])
    read = next(family.batches("volume", 1000, places=mask))
    assert_array_equal(read["volume"], family["volume"][:][mask])
    assert "volume" in family
    assert "volumes" not in family
    assert_array_equal(family.graph(-1)["points"], family.graph(len(family) - 1)["points"])
    with pytest.raises(PlaceError, match="variant: got 5000, allowed is 0 to"):
        family.graph(5000)
    for places, said in (
        ([5000], "places: got 5000, allowed is 0 to"),
        ([-1], "places: got -1, allowed is 0 to"),
        ([0.5], "places: got an array of float64 of shape .1,., must be whole numbers"),
        (mask[:-1], "or 70 of True and False"),
    ):
        with pytest.raises(FamilyError, match=said):
            next(family.batches("volume", places=places))
    assert len(next(family.batches("volume", 8.0))["volume"]) == 8
    with pytest.raises(FamilyError, match="where: got 3, must be a text, such as 'volume > 600"):
        family.where(3)
    with pytest.raises(FamilyError, match=r"shares: got \{.* must be three that sum to 1"):
        family.split("train", shares={"train": 0.8, "validation": 0.1, "test": 0.1})
    assert len(bg.load_family(folder / "manifest.parquet")) == len(family)
    with pytest.raises(FamilyError, match=r"rng: got 'a', must be a numpy\.random\.Generator"):
        next(family.batches("volume", rng="a"))
    with pytest.raises(FamilyError, match="names: got none"):
        next(family.batches(()))


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_what_is_drawn_by_conditions_fulfils_them_as_it_is_stored(dtype, tmp_path):
    """Conditions on what is over span were known of families that were made, and not before."""
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=61)
    asked = {"count": 12, "spans": 16, "design": "box"}
    asked["bounds"] = {"chord": (0.9, 1.1), "twist": (-0.05, 0.05), "thickness": (0.9, 1.1)}

    def made(name, **more):
        run(Order(bg.family(blade, **asked, **more), tmp_path / name, (), dtype))
        return bg.load_family(tmp_path / name)

    free, eta = made("free"), 0.7
    middle = {}
    for name in ("chord", "twist", "thickness", "area", "inertia_yy", "perimeter"):
        at = [np.interp(eta, free["eta"][:], row) for row in free[name][:]]
        middle[f"{name}@{eta}"] = float(np.sort(at)[3])  # true of eight in twelve
    conditions = [f"{name} > {value!r}" for name, value in middle.items()]
    assert [len(free.where(text)) for text in conditions] == [8] * 6
    text = " and ".join([*conditions[1:4], "volume > 0", "twist_change < 2"])
    drawn = made("drawn", where=text)
    assert drawn.valid.all()
    assert_array_equal(drawn.where(text), np.arange(12))
    assert 0 < len(free.where(text)) < 12
    for place in free.where(text):
        assert_array_equal(drawn.parameters[place], free.parameters[place])
    for wrong, said in (
        ("thickness < 0.3", r"'thickness' has to say where on the span, 0 to 1, such as"),
        ("area@1.5 < 0.3", r"'area@1.5' has to say where"),
        ("mass < 3", r"'mass' is not known while variants are drawn, .*bladegen info FOLDER"),
    ):
        with pytest.raises(FamilyError, match=said):
            bg.family(blade, **asked, where=wrong)


def test_conditions_on_arrays_over_span_say_where(folder):
    """A plain "thickness < 0.3" had no answer but that there is no such name."""
    family = bg.load_family(folder)
    eta, chord = family["eta"][:], family["chord"][:]
    for at in (float(eta[0]), 0.43, float(eta[-1])):
        values = np.array([np.interp(at, eta, row) for row in chord])
        middle = float(np.median(values)) + 1e-9
        held = family.where(f"chord@{at!r} > {middle!r} and valid == true")
        assert_array_equal(held, np.flatnonzero((values > middle) & family.valid))
    for text, said in (
        (
            "thickness < 0.3",
            r"'thickness' has to say where on the span, 0 to 1, such as 'thickness@0.7'",
        ),
        ("chord@1.2 > 3", r"'chord@1.2' has to say where"),
        ("chord@0..7 > 3", r"'chord@0..7' has to say where"),
        ("cord@0.7 > 3", r"there is no 'cord@0.7' of a variant"),
        ("volume@0.7 > 3", r"there is no 'volume@0.7' of a variant"),
    ):
        with pytest.raises(FamilyError, match=said):
            family.where(text)


@pytest.mark.parametrize(("near", "runs"), [(16, 3), (2**20, 1)])
def test_rows_are_read_in_runs_and_come_in_the_order_asked_for(monkeypatch, near, runs):
    """Variants that lie apart were read one by one, and numbers of 8 bytes each in a read."""
    from bladegen.families.dataset import reading

    asked = []
    monkeypatch.setattr(reading, "NEAR", near)  # bytes between two rows

    class Store:
        dtype, shape = np.dtype(np.float64), (1000,)

        def __getitem__(self, rows):
            asked.append((rows.start, rows.stop))
            return np.arange(1000.0)[rows]

    rng = np.random.default_rng(3)
    places = rng.permutation(np.concatenate([np.arange(64), np.arange(700, 764), [999, 999]]))
    assert_array_equal(reading.arrays_at({"x": Store()}, ("x",), places)["x"], places)
    assert asked == ([(0, 64), (700, 764), (999, 1000)] if runs == 3 else [(0, 1000)])


def test_what_a_dataset_says_of_itself_fits_into_netcdf(folder):
    for name, value in bg.load_family(folder).attributes.items():
        assert isinstance(value, str | int | float | list), name


def test_the_surface_of_a_variant_is_its_skin_and_both_ends(folder):
    family = bg.load_family(folder)
    skin = float(family.graph(3)["areas"].sum(dtype=np.float64))
    ends = 0.0
    for ring in np.asarray(family["sections"][3], dtype=np.float64)[[0, -1]]:
        away = ring - ring.mean(axis=0)
        ends += 0.5 * np.linalg.norm(np.cross(away, np.roll(away, -1, axis=0)).sum(axis=0))
    assert float(family["surface"][3]) == pytest.approx(skin + ends, rel=2e-3)
    assert ends > 0.01 * skin


@pytest.mark.parametrize(
    ("broken", "said"),
    [
        ("family.json", "holds no family; `bladegen family"),
        ("manifest.parquet", "its family is not whole; the same command with --resume"),
    ],
)
def test_folders_that_hold_no_whole_family_say_so(folder, tmp_path, broken, said):
    shutil.copytree(folder, tmp_path / "part", ignore=shutil.ignore_patterns(broken))
    with pytest.raises(FamilyError, match=said):
        bg.load_family(tmp_path / "part")


@pytest.mark.parametrize("text", ["{", "[]", '{"seed": 1}', '{"factors": 3}'])
def test_a_damaged_description_is_refused(folder, tmp_path, text):
    (tmp_path / "family.json").write_text(text)
    (tmp_path / "manifest.parquet").write_bytes(b"")
    with pytest.raises(FamilyError, match="says not what the family is"):
        bg.load_family(tmp_path)


def test_what_a_family_does_not_hold_is_refused(folder):
    family = bg.load_family(folder)
    with pytest.raises(IndexError, match="allowed is 0 to 69"):
        family[COUNT]
    with pytest.raises(FamilyError, match="must be a whole number or a name"):
        family[1.5]


def test_the_command_is_told_in_the_dataset(tmp_path):
    words = ["family", "nrel5mw", "-o", str(tmp_path / "f"), "--count", "2", "--spans", "12"]
    result = CliRunner().invoke(commands.app, [*words, "--reach", "0.2"])
    assert result.exit_code == 0, result.output
    with xarray.open_zarr(tmp_path / "f" / "sections.zarr") as data:
        assert data.attrs["command"] == "bladegen family nrel5mw --count 2 --reach 0.2 --spans 12"
    assert "seed" in json.loads((tmp_path / "f" / "family.json").read_text())


def grown(planned, target, *counts, **how):
    """A folder that a family was added to, again and again."""
    for count in counts:
        design = replace(planned.design, count=count)
        run(Order(replace(planned, design=design), target), append=count != counts[0], **how)
    return target


def same_families(one, two):
    assert (one / "manifest.parquet").read_bytes() == (two / "manifest.parquet").read_bytes()
    assert (one / "CARD.md").read_bytes() == (two / "CARD.md").read_bytes()
    assert json.loads((one / "family.json").read_text()) == json.loads(
        (two / "family.json").read_text()
    )
    with (
        xarray.open_zarr(one / "sections.zarr") as a,
        xarray.open_zarr(two / "sections.zarr") as b,
    ):
        assert a.identical(b)


@pytest.mark.parametrize(
    "counts",
    [pytest.param((5, COUNT), marks=NIGHT), pytest.param((64, COUNT), marks=NIGHT), (1, 66, COUNT)],
)
def test_a_family_that_is_added_to_is_the_one_made_at_once(folder, planned, tmp_path, counts):
    same_families(grown(planned, tmp_path / "grown", *counts), folder)


@pytest.mark.parametrize(
    "last",
    ["replacing", *(pytest.param(n, marks=NIGHT) for n in ("_keep_parts", "settle", "resize"))],
)
def test_adding_goes_on_wherever_it_was_killed(folder, planned, tmp_path, monkeypatch, last):
    target = grown(planned, tmp_path / "killed", 66)

    class KilledError(Exception):
        pass

    def killed(*_, **__):
        raise KilledError

    home = {"settle": "bladegen.families.run", "resize": "zarr.Array"}
    where = home.get(last, "bladegen.families.additions.growth")
    with monkeypatch.context() as patch:
        patch.setattr(f"{where}.{last}", killed)
        with pytest.raises(KilledError):
            run(Order(planned, target), append=True)
    run(Order(planned, target), append=True)
    same_families(target, folder)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"count": COUNT - 1}, "holds 70 variants, 69 are asked for"),
        ({"count": 2 * COUNT, "seed": 8}, "holds another family .seed: 7 there, 8 asked for"),
        ({"count": 2 * COUNT, "kind": "lhs"}, "depend on how many there are"),
        ({"count": 10**6}, "names of more digits"),
    ],
)
def test_what_cannot_be_added_is_refused(folder, planned, change, said):
    before = (folder / "family.json").read_bytes()
    other = replace(planned, design=replace(planned.design, **change))
    with pytest.raises(FamilyError, match=said):
        run(Order(other, folder), append=True)
    assert (folder / "family.json").read_bytes() == before


def test_other_bounds_are_told_in_a_line(folder, planned):
    there = bg.load_family(folder).identity
    other = {name: (low / 2.0, high) for name, (low, high) in there["factors"].items()}
    with pytest.raises(FamilyError) as caught:
        require_same(folder, {**there, "factors": other}, there)
    said = str(caught.value)
    assert "thickness 0.9:1.1, " in said
    assert "--reach, --vary and --space say what varies" in said
    assert "0000" not in said


def test_nothing_to_add_to_is_refused(planned, tmp_path):
    with pytest.raises(FamilyError, match="holds no family to add to"):
        run(Order(planned, tmp_path), append=True)


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("iea15mw"), landmarks=201)


@pytest.mark.parametrize("mirrored", [False, True])
def test_graphs_are_the_skin_as_trimesh_sees_it(blade, mirrored):
    sections = (blade.mirror_image() if mirrored else blade).sections(blade.stations(60))
    normals, areas = graphs.surface(sections)
    corners = graphs.triangles(*sections.shape[:2])
    skin = trimesh.Trimesh(sections.reshape(-1, 3), corners, process=False)
    assert_allclose(areas.sum(), skin.area, rtol=2e-4)
    assert skin.volume > 0  # so its normals point outward
    inner = normals[5:-5].reshape(-1, 3)
    alike = np.sum(
        inner * skin.vertex_normals.reshape(*sections.shape)[5:-5].reshape(-1, 3), axis=1
    )
    assert np.quantile(alike, 0.01) > 0.99
    assert_allclose(np.linalg.norm(normals, axis=-1), 1.0, atol=1e-12)


def test_graphs_of_a_cylinder_are_exact():
    angle = np.linspace(0.0, 2 * np.pi, 100, endpoint=False)
    ring = np.stack([2 * np.sin(angle), 2 * np.cos(angle), 0 * angle], axis=-1)
    cylinder = ring + np.linspace(0.0, 3.0, 7)[:, None, None] * np.array([0.0, 0.0, 1.0])
    normals, areas = graphs.surface(np.stack([cylinder, 2 * cylinder]))
    assert_allclose(normals[0], (ring / 2)[None].repeat(7, axis=0), atol=1e-12)
    side = 2 * 100 * 2 * np.sin(np.pi / 100) * 3
    assert_allclose(areas.sum(axis=(1, 2)), [side, 4 * side])
    pairs = graphs.edges(7, 100)
    assert len(np.unique(np.sort(pairs, axis=1), axis=0)) == len(pairs) == 7 * 100 + 6 * 100
    flat = cylinder.reshape(-1, 3)
    length = np.linalg.norm(flat[pairs[:, 0]] - flat[pairs[:, 1]], axis=1)
    assert_allclose(np.unique(length.round(9)), [round(4 * np.sin(np.pi / 100), 9), 0.5])


def test_a_family_with_its_graph(planned, tmp_path):
    fewer = replace(planned, design=replace(planned.design, count=3))
    run(Order(fewer, tmp_path / "plain"))
    run(Order(fewer, tmp_path / "graph", graph=True))
    plain, family = bg.load_family(tmp_path / "plain"), bg.load_family(tmp_path / "graph")
    assert set(family.names) - set(plain.names) == {"normals", "areas", "edges", "triangles"}
    for name, values in family.graph(2).items():
        assert_allclose(values, plain.graph(2)[name], rtol=1e-6)
    skin = family["areas"][:].sum(axis=(1, 2)) + family["area"][:][:, [0, -1]].sum(axis=1)
    assert_allclose(family["surface"][:], skin, rtol=1e-3)
    with xarray.open_zarr(tmp_path / "graph" / "sections.zarr") as data:
        assert data["normals"].dims == data["sections"].dims
        assert data["edges"].dims == ("edge", "end")
    same = replace(planned, design=replace(planned.design, count=5))
    with pytest.raises(FamilyError, match=r"another family .graph: null there"):
        run(Order(same, tmp_path / "plain", graph=True), append=True)
    run(Order(same, tmp_path / "graph", graph=True), append=True)
    assert bg.load_family(tmp_path / "graph")["normals"].shape[0] == 5


def test_conditions_choose_the_variants_that_fulfil_them(folder):
    family = bg.load_family(folder)
    volume, t1 = family["volume"][:], family["t1"][:]
    middle = float(np.median(volume))
    found = family.where(f"volume > {middle!r} and t1 <= 0.01")
    assert_array_equal(found, np.flatnonzero((volume > middle) & (t1 <= 0.01)))
    assert_array_equal(family.where("valid == true"), np.flatnonzero(family.valid))
    assert_array_equal(family.where("volume<0"), [])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("volme > 3", "no 'volme' of a variant, but .* did you mean volume"),
        ("volume", "got 'volume', must be NAME, one of"),
        ("volume > big", "and a number, such as"),
        ("__import__('os') > 3", "must be NAME"),
        ("", "got '', must be NAME"),
    ],
)
def test_what_is_no_condition_is_a_line(text, said, folder):
    with pytest.raises(FamilyError, match=said):
        bg.load_family(folder).where(text)


def test_info_of_a_folder_says_what_is_in_it(folder):
    result = CliRunner().invoke(
        commands.app, ["info", str(folder), "--where", "volume > 0", "--json"]
    )
    assert result.exit_code == 0, result.output
    told, family = json.loads(result.output), bg.load_family(folder)
    assert [told[key] for key in ("blade", "variants")] == ["nrel5mw", COUNT]
    assert told["sound"] == int(family.valid.sum())
    assert sum(told["splits"].values()) == COUNT
    volume = told["ranges"]["volume"]
    assert volume["unit"] == "m3"
    own = family["volume"][:][family.valid]
    found = [volume[key] for key in ("least", "mean", "largest", "deviation")]
    assert_allclose(found, [own.min(), own.mean(), own.max(), own.std()])
    assert told["fulfilled_by"] == family.where("volume > 0").tolist()
    result = CliRunner().invoke(commands.app, ["info", str(folder), "--where", "volume > 0"])
    assert f"{len(told['fulfilled_by'])} of {COUNT}: volume > 0" in result.output
    result = CliRunner().invoke(commands.app, ["info", "nrel5mw", "--where", "volume > 0"])
    assert "is for a family's folder, which nrel5mw is not" in str(result.exception)
