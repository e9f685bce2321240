"""Labels of families, held against the blades that they are of."""

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import xarray
import zarr
from numpy.testing import assert_allclose, assert_array_equal
from test_cli import run as command

import bladegen as bg
from bladegen.aero.evaluation import evaluated
from bladegen.aero.kulfan import in_chords
from bladegen.definition.blade_definition import Rotor
from bladegen.errors import FamilyError
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
    with pytest.raises(FamilyError, match=r"holds another family .*labels: "):
        run(Order(planned(), tmp_path, labels=("rotor",)), resume=True)


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
