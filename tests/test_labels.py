"""Labels of families, held against the blades that they are of."""

import json
import shutil
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import xarray
import zarr
from numpy.testing import assert_allclose, assert_array_equal
from test_cli import run as command

import bladegen as bg
from bladegen.blade.aero.evaluation import evaluated
from bladegen.blade.aero.kulfan import in_chords
from bladegen.definition.blade_definition import Rotor
from bladegen.errors import FamilyError
from bladegen.families.additions.later_labels import add_labels
from bladegen.families.labels import labelling
from bladegen.families.labels.figures import ALPHA, FIGURES, LABELS, REYNOLDS, STORED, polar_places
from bladegen.families.order import Order
from bladegen.families.run import run
from bladegen.neuralfoil import coefficients

COUNT, SPANS = 4, 12
BOUNDS = {"twist": (-0.02, 0.03), "thickness": (0.95, 1.1)}


@cache
def blade():
    return bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101)


def planned(count=COUNT, made=None, **how):
    return bg.family(
        blade() if made is None else made,
        bg.ShapeSpace.bundled(),
        **({"count": count, "seed": 7, "spans": SPANS, "reach": 0.3, "bounds": BOUNDS} | how),
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    target = tmp_path_factory.mktemp("labels") / "family"
    assert run(Order(planned(), target, labels=LABELS)) == COUNT
    return target


def test_rotor_and_mass_are_those_of_the_blades(folder):
    family = bg.load_family(folder)
    found = evaluated([family.baseline or blade(), *family[0:COUNT]])
    best = found.performance
    for name, wanted in (
        ("rotor_power_coefficient", best.best[1:, 0]),
        ("rotor_thrust_coefficient", best.best[1:, 1]),
        ("rotor_moment_coefficient", best.best[1:, 2]),
        ("rotor_optimum_ratio", best.ratio[1:]),
        ("rotor_optimum_pitch", np.degrees(best.pitch[1:])),
        ("rotor_rated_wind", found.rated_wind[1:]),
        ("rotor_root_moment", found.root_moment[1:]),
        ("rotor_annual_energy", found.energy[1:] / 3.6e12),
        ("rotor_power_curve", best.power[1:]),
        ("mass", [one.layup.mass for one in family[0:COUNT]]),
        ("mass_centre", [one.layup.centre[2] for one in family[0:COUNT]]),
    ):
        assert_allclose(family[name][:], wanted, rtol=1e-6, err_msg=name)
    along = family["mass_per_length"][1]
    assert_allclose(along, family[1].layup.at(family["eta"][:]).mass_per_length, rtol=1e-6)


def test_polars_are_those_of_the_stored_sections(folder):
    family = bg.load_family(folder)
    places = polar_places(SPANS)
    assert_array_equal(family["polar_span"][:], places)
    assert_allclose(family["polar_eta"][:], family["eta"][:][places])
    last = family["sections"][2][places[-1]]  # an airfoil at the tip, in a plane of its own
    flat, _ = in_chords(last[None, :, 1::-1])
    points = np.stack([flat[0].real, flat[0].imag], axis=-1)
    at = np.flatnonzero(np.abs(ALPHA - 4.0) < 1e-9)[0]
    for k, reynolds in enumerate(REYNOLDS):
        wanted = coefficients(points, np.radians(4.0), reynolds).values
        for name, value in zip(("cl", "cd", "cm"), wanted, strict=True):
            assert family[f"polar_{name}"][2, -1, k, at] == pytest.approx(value, rel=1e-3)
    sure = family["polar_confidence"][:]
    assert np.all((sure > 0.0) & (sure <= 1.0))
    round_ = family["polar_cl"][:, 0]  # the root is a cylinder
    assert_allclose(round_, 0.0, atol=1e-6)


def test_a_labelled_family_opens_as_one_dataset(folder):
    with xarray.open_zarr(folder / "sections.zarr") as data:
        assert data["polar_cl"].dims == ("variant", "polar_span", "reynolds", "alpha")
        assert data["rotor_power_curve"].dims == ("variant", "tip_speed_ratio")
        assert {"alpha", "reynolds", "tip_speed_ratio", "polar_eta"} <= set(data.coords)
        curve = data["rotor_power_curve"].sel(tip_speed_ratio=8.0)
        assert np.all(curve <= data["rotor_power_coefficient"] + 1e-4)
    group = zarr.open_group(folder / "sections.zarr", mode="r")
    for name in (one.name for label in LABELS for one in FIGURES[label]):
        assert group[name].attrs["long_name"], name
        assert group[name].attrs["units"], name
    columns = bg.load_family(folder).table().column_names
    assert not set(STORED) & set(columns)
    assert {"rotor_power_coefficient", "mass", "rotor_power_curve"} <= set(columns)
    card = (folder / "CARD.md").read_text(encoding="utf-8")
    for wanted in ("## Labels", "| `mass` | variant | mass of the layers | kg |", "NeuralFoil"):
        assert wanted in card
    assert "`mean_wind_m_s` 10" in card


def test_labels_of_a_family_that_was_added_to_are_those_of_one_run(folder, tmp_path):
    kinds = ("polars", "rotor")
    run(Order(planned(2), tmp_path, labels=kinds))
    assert run(Order(planned(), tmp_path, labels=kinds[::-1]), append=True) == COUNT
    was, new = bg.load_family(folder), bg.load_family(tmp_path)
    for name in (one.name for label in kinds for one in FIGURES[label]):
        assert_array_equal(was[name][:], new[name][:], err_msg=name)
    assert run(Order(planned(), tmp_path, labels=kinds), resume=True) == 0
    with pytest.raises(FamilyError, match=r"with labels; say --label polars,rotor as"):
        run(Order(planned(), tmp_path, labels=("rotor",)), resume=True)


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """The family of `folder` without labels; copied, not written to."""
    target = tmp_path_factory.mktemp("plain") / "family"
    run(Order(planned(), target))
    return target


def same_labelled(one, two):
    """Hold a family that was labelled later against one labelled while it was made."""
    assert json.loads((one / "family.json").read_text()) == json.loads(
        (two / "family.json").read_text()
    )
    was, new = bg.load_family(one), bg.load_family(two)
    assert was.table().schema == new.table().schema
    with xarray.open_zarr(two / "sections.zarr") as a, xarray.open_zarr(one / "sections.zarr") as b:
        # twist is stored in degrees, and comes back to the last digit but one
        xarray.testing.assert_allclose(a, b, rtol=1e-9)
        assert set(a.coords) == set(b.coords)
        assert a.attrs == b.attrs
        assert all(a[name].attrs == b[name].attrs for name in a.variables)
    assert (one / "CARD.md").read_text() == (two / "CARD.md").read_text()
    assert not (two / "labels").exists()


def test_labels_that_are_added_later_are_those_made_with_the_family(folder, plain, tmp_path):
    target = shutil.copytree(plain, tmp_path / "family")
    shown = command("label", target, "mass")
    assert shown.exit_code == 0, shown.output
    assert f"{COUNT}, {COUNT} of them labelled now" in shown.output
    before = (target / "manifest.parquet").read_bytes()
    assert "0 of them labelled now" in command("label", target, "mass").output
    assert (target / "manifest.parquet").read_bytes() == before
    assert command("label", target, "rotor,polars", "mass").exit_code == 0
    same_labelled(folder, target)
    assert run(Order(planned(), target, labels=LABELS), resume=True) == 0
    more = planned(COUNT + 1)
    assert run(Order(more, target, labels=LABELS), append=True) == COUNT + 1
    assert np.isfinite(bg.load_family(target)["polar_cl"][:]).all()


@pytest.mark.parametrize(
    "last",
    [
        *(
            pytest.param(name, marks=pytest.mark.nightly)
            for name in (
                "folder.FamilyFolder.write_block",
                "additions.later_labels._join",
                "additions.later_labels.replacing",
                "additions.later_labels.write_card",
            )
        ),
        "dataset.store._fill",
    ],
)
def test_adding_labels_goes_on_wherever_it_was_killed(plain, tmp_path, monkeypatch, last):
    target = shutil.copytree(plain, tmp_path / "family")
    kinds = ("polars", "mass")

    class KilledError(Exception):
        pass

    def killed(*_, **__):
        raise KilledError

    with monkeypatch.context() as patch:
        patch.setattr(f"bladegen.families.{last}", killed)
        with pytest.raises(KilledError):
            add_labels(bg.load_family(target), kinds)
    assert bg.load_family(target)["volume"][:].shape == (COUNT,)  # can be read all the while
    with pytest.raises(FamilyError, match=r"`bladegen label .* polars mass` goes on"):
        run(Order(planned(), target), resume=True)
    with pytest.raises(FamilyError, match="polars and mass are not finished"):
        add_labels(bg.load_family(target), ("rotor",))
    add_labels(bg.load_family(target), kinds)
    made = tmp_path / "made"
    run(Order(planned(), made, labels=kinds))
    same_labelled(made, target)


@pytest.mark.nightly
def test_a_cluster_adds_the_same_labels(plain, folder, tmp_path):
    distributed = pytest.importorskip("distributed")
    target = tmp_path / "family"
    shutil.copytree(plain, target)
    here = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with (
        distributed.LocalCluster(processes=True, **here) as cluster,
        distributed.Client(cluster) as client,
    ):
        assert add_labels(bg.load_family(target), LABELS, client=client) == COUNT
    same_labelled(folder, target)


@pytest.mark.nightly
def test_threads_add_the_same_labels(plain, tmp_path, monkeypatch):
    from bladegen.families import order

    monkeypatch.setattr(order, "BLOCK", 2)
    run(Order(planned(), tmp_path / "one"))
    shutil.copytree(tmp_path / "one", tmp_path / "two")
    told = []
    add_labels(bg.load_family(tmp_path / "one"), LABELS)
    add_labels(bg.load_family(tmp_path / "two"), LABELS, jobs=2, progress=told.append)
    assert told == [0, 2, 4]
    same_labelled(tmp_path / "one", tmp_path / "two")


def test_labels_that_cannot_be_added_are_refused_in_a_line(folder, plain, tmp_path):
    with pytest.raises(FamilyError, match=r"label: got 'loads'"):
        add_labels(bg.load_family(plain), ("loads",))
    other = bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=101)
    with pytest.raises(FamilyError, match=r"variant 0 lies .* baseline or the space is another"):
        add_labels(bg.load_family(plain, blade=other), ("polars",))
    told = json.loads((folder / "family.json").read_text())
    told["labels"]["polars"]["network"] = "NeuralFoil 0.0 tiny"
    target = shutil.copytree(folder, tmp_path / "family")
    (target / "family.json").write_text(json.dumps(told))
    with pytest.raises(FamilyError, match=r"has polars by other settings .*0\.0 tiny.* there"):
        add_labels(bg.load_family(target), ("polars",))
    with pytest.raises(FamilyError, match=r"without rotor; `bladegen label .* rotor` adds labels"):
        run(Order(planned(COUNT + 1), plain, labels=("rotor",)), append=True)
    with pytest.raises(FamilyError, match=r"holds this family with labels; say --label polars,"):
        run(Order(planned(), folder), resume=True)


def test_variants_that_are_not_sound_have_no_labels(tmp_path):
    bounds = {"thickness": (0.95, 1.1), "camber": (0.5, 1.5)}
    made = planned(6, reach=1.0, invalid="keep", bounds=bounds)
    run(Order(made, tmp_path, labels=("rotor", "polars")))
    family = bg.load_family(tmp_path)
    assert 0 < family.valid.sum() < 6
    for name in ("rotor_power_coefficient", "rotor_power_curve", "polar_cd"):
        known = np.isfinite(np.asarray(family[name][:])).reshape(6, -1)
        assert_array_equal(known.all(axis=1), family.valid)
        assert_array_equal(known.any(axis=1), family.valid)


def test_mirror_images_have_the_same_labels(folder, tmp_path):
    mirrored = planned(2, blade().mirror_image())
    run(Order(mirrored, tmp_path, labels=("polars", "rotor")))
    was, new = bg.load_family(folder), bg.load_family(tmp_path)
    for name in ("rotor_power_coefficient", "polar_cl", "polar_cm"):
        assert_allclose(new[name][:], was[name][:2], rtol=1e-5, atol=1e-5)


def test_what_cannot_be_labelled_is_said_in_a_line(monkeypatch, tmp_path):
    with pytest.raises(FamilyError, match=r"label: got 'rotors', .* did you mean rotor\?"):
        Order(planned(), tmp_path, labels=("rotors",))
    bare = replace(bg.read("nrel5mw"), rotor=Rotor(), structure=None)
    made = planned(made=bg.Blade.from_definition(bare, landmarks=101))
    with pytest.raises(FamilyError, match="label: rotor needs a hub radius"):
        Order(made, tmp_path, labels=("rotor",))
    with pytest.raises(FamilyError, match="label: mass needs layers"):
        Order(made, tmp_path, labels=("mass",))
    monkeypatch.setattr(labelling, "available", lambda: False)
    with pytest.raises(FamilyError, match=r"pip install 'bladegen\[aero\]'"):
        Order(planned(), tmp_path, labels=("polars",))


def test_the_command_labels_a_family(tmp_path):
    words = ("family", "nrel5mw", "-o", tmp_path, "--count", "2", "--spans", "12", "--reach", "0.2")
    shown = command(*words, "--label", "rotor,mass")
    assert shown.exit_code == 0, shown.output
    assert "largest power coefficient" in shown.output
    assert "mass of the layers, kg" in shown.output
    told = json.loads((tmp_path / "family.json").read_text())["labels"]
    assert list(told) == ["rotor", "mass"]
    assert told["rotor"]["mean_wind_m_s"] == 10.0
