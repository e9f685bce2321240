import pickle
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import bladegen as bg
from bladegen.blade.variants.designs import tabulated
from bladegen.curves import polygons
from bladegen.errors import BladegenError, FamilyError

SPACE = bg.ShapeSpace.bundled()


@cache
def blade(name="nrel5mw"):
    return bg.Blade.from_definition(bg.read(name))


def test_blades_of_a_family_have_the_sections_of_its_blocks():
    family = bg.family(
        blade(), SPACE, count=4, seed=7, spans=40, bounds={"twist": (-0.1, 0.1)}, reach=0.5
    )
    block = family.block(np.arange(4))
    assert block.valid.all()
    for variant, sections in zip(family, block.batch.sections, strict=True):
        assert_allclose(variant.sections(family.eta), sections, rtol=0, atol=2e-9)
    assert len(family) == 4
    assert family.variant(2).name == "nrel5mw-00002"


def test_variants_depend_on_seed_and_place_alone():
    many = bg.family(blade(), SPACE, count=30, seed=7, spans=40)
    few = bg.family(blade(), SPACE, count=3, seed=7, spans=40)
    other = bg.family(blade(), SPACE, count=3, seed=8, spans=40)
    values = many.block(np.array([2, 0, 1])).values
    assert_array_equal(values[[1, 2, 0]], few.block(np.arange(3)).values)
    assert not np.allclose(values[1], other.block(np.arange(3)).values[0])


def test_variants_that_are_not_sound_are_drawn_again_or_kept_and_marked():
    asked = {"count": 24, "seed": 1, "spans": 60, "allow_extrapolation": True, "allow_odd": True}
    kept = bg.family(blade(), SPACE, **asked, invalid="keep").block(np.arange(24))
    redrawn = bg.family(blade(), SPACE, **asked).block(np.arange(24))
    assert 0 < kept.valid.sum() < 24
    assert redrawn.valid.all()
    assert_array_equal(kept.attempts, 1)
    assert_array_equal(redrawn.attempts > 1, ~kept.valid)
    same = kept.valid
    assert_array_equal(kept.values[same], redrawn.values[same])
    assert_allclose(kept.batch.sections[same], redrawn.batch.sections[same], rtol=0, atol=1e-9)
    assert any("crosses itself at eta" in reason for reason in kept.reasons)


@pytest.mark.parametrize("name", ["iea15mw", "dtu10mw"])
def test_variants_of_a_default_family_are_what_perturbed_takes(name):
    family = bg.family(blade(name), SPACE, count=8, seed=3, spans=40)
    block = family.block(np.arange(8))
    assert block.valid.all()
    assert any("arrives at" in reason for reason in block.refused)
    for t in block.values[:2]:
        assert blade(name).perturbed(SPACE, t).findings == blade(name).findings
    odd = bg.family(blade(name), SPACE, count=8, seed=3, spans=40, allow_extrapolation=True)
    kinds = {reason.split(":")[0] for reason in odd.block(np.arange(8)).refused}
    assert kinds & {"has a concave nose", "has a drooped tail", "has a pinched nose"}


@pytest.mark.parametrize("tries", [1, 2, 9, 1000])
def test_each_variant_is_its_first_draw_that_is_sound(tries):
    family = bg.family(blade(), SPACE, count=3, seed=5, spans=40, tries=tries)
    index = np.arange(3)
    values, attempts, reasons = family.settled(index)
    for place in index:
        one = index[place : place + 1]
        draws = [family.design.at(one)]
        draws += [family.design.redrawn(one, k) for k in range(1, attempts[place])]
        said = [family._rules.tested(draw)[0] for draw in draws]
        assert all(said[:-1])
        assert said[-1] == reasons[place]
        assert not said[-1] or attempts[place] == tries
        assert_array_equal(draws[-1][0], values[place])


def test_tries_are_limited():
    hopeless = {"t1": (5.0, 6.0)}
    family = bg.family(blade(), SPACE, count=2, tries=3, bounds=hopeless, spans=40)
    block = family.block(np.arange(2))
    assert not block.valid.any()
    assert_array_equal(block.attempts, 3)


def test_variants_are_drawn_until_they_fulfil_conditions():
    """The same draws as without, of which those are left out that do not fulfil them."""
    asked = {"count": 12, "seed": 7, "spans": 30, "reach": 0.4, "bounds": {"twist": (-0.05, 0.05)}}
    free = bg.family(blade(), SPACE, **asked).block(np.arange(12))
    volume = np.array([polygons.volume_and_area(one)[0] for one in free.batch.sections])
    middle = float(np.median(volume))
    where = f"volume > {middle:.6f} and twist_change < 0"
    block = bg.family(blade(), SPACE, **asked, where=where).block(np.arange(12))
    assert block.valid.all()
    assert np.all(block.values[:, -1] < 0.0)
    made = np.array([polygons.volume_and_area(one)[0] for one in block.batch.sections])
    assert np.all(made > middle)
    held = (volume > middle) & (free.values[:, -1] < 0.0)
    assert 0 < held.sum() < 12
    assert_array_equal(block.values[held], free.values[held])
    assert np.all(block.attempts[~held] > free.attempts[~held])
    never = bg.family(blade(), SPACE, **asked, where="twist_change < -9", tries=5)
    block = never.block(np.arange(12))
    assert not block.valid.any()
    assert_array_equal(block.attempts, 5)
    assert "does not fulfil twist_change < -9" in block.reasons
    assert never.table()["valid"].to_pylist() == [False] * 12


def volumes_of(block):
    each = block.batch.sections.astype(np.float64)
    return np.array([polygons.volume_and_area(one)[0] for one in each])


@pytest.mark.parametrize("place", [0, 3, 7])
def test_conditions_hold_of_what_is_stored_in_either_precision(place):
    """A variant within rounding of its bound passed the one test and failed the other, for good."""
    asked = {"count": 12, "seed": 7, "spans": 30, "reach": 0.4}
    free = bg.family(blade(), SPACE, **asked)
    index = np.arange(12)
    kinds = np.float32, np.float64
    near = [volumes_of(free.block(index, dtype=kind))[place] for kind in kinds]
    family = bg.family(blade(), SPACE, **asked, where=f"volume > {float(np.mean(near))!r}")
    for kind in kinds:
        block = family.block(index, dtype=kind)
        assert block.valid.all()
        assert np.all(volumes_of(block) > np.mean(near))
        assert_array_equal(block.values, family.block(index).values)


def test_thin_and_outlying_variants_say_so():
    table = tabulated(SPACE, {"t1": [0.0, 9.0, 0.0], "thickness": [1.0, 1.0, 0.25]})
    block = bg.family(blade(), SPACE, design=table, spans=40).block(np.arange(3))
    assert block.reasons[0] == ""
    assert block.reasons[1].startswith("t1 = 9 is outside")
    assert "is below 0.05" in block.reasons[2]
    assert_array_equal(block.attempts, 1)


def test_families_and_their_blades_can_be_sent_to_other_processes():
    family = bg.family(blade(), SPACE, count=2, seed=1, spans=40, reach=0.3)
    sections = family.block(np.arange(2)).batch.sections
    again = pickle.loads(pickle.dumps(family))
    assert_array_equal(again.block(np.arange(2)).batch.sections, sections)
    variant = family.variant(1)
    before = variant.sections([0.5])
    assert_array_equal(pickle.loads(pickle.dumps(variant)).sections([0.5]), before)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"invalid": "drop"}, "allowed are redraw, keep"),
        ({"tries": 0}, "tries: got 0"),
        ({"spans": 1}, "stations: got 1"),
        ({"design": "grid"}, "design: got 'grid'"),
    ],
)
def test_what_cannot_be_is_refused(asked, said):
    with pytest.raises(BladegenError, match=said):
        bg.family(blade(), SPACE, **asked)


def test_a_smooth_space_serves_other_landmarks():
    coarse = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101)
    assert len(bg.family(coarse, SPACE).space.u) == 101


def test_a_variant_beyond_the_family_is_refused():
    with pytest.raises(BladegenError, match="allowed is 0 to 1"):
        bg.family(blade(), SPACE, count=2).variant(2)


def test_a_family_is_a_sequence_of_what_iterating_gives():
    family = bg.family(blade(), SPACE, count=5, seed=3, spans=40, bounds={"twist": (-0.1, 0.1)})
    variants = list(family)
    assert [one.name for one in family[1:4]] == [one.name for one in variants[1:4]]
    for place in (0, 3, -1, np.int64(2)):
        assert_array_equal(family[place].sections([0.7]), variants[place].sections([0.7]))
    assert family[-1].name == "nrel5mw-00004"
    for place in (5, -6):
        with pytest.raises(IndexError, match="allowed is 0 to 4"):
            family[place]
        with pytest.raises(FamilyError):
            family[place]
    with pytest.raises(FamilyError, match="must be a whole number"):
        family["first"]
    assert family[7:] == []


def test_a_familys_table_holds_what_its_blocks_do():
    family = bg.family(blade(), SPACE, count=70, seed=3, spans=40, bounds={"twist": (-0.1, 0.1)})
    table, block = family.table(), family.block(np.arange(70))
    assert table.column_names[:5] == ["index", "name", "valid", "reason", "attempts"]
    assert tuple(table.column_names[5:]) == family.design.what.names
    values = np.stack([table[name].to_numpy() for name in family.design.what.names], axis=-1)
    assert_array_equal(values, block.values)
    assert_array_equal(table["attempts"].to_numpy(), block.attempts)
    assert table["reason"].to_pylist() == list(block.reasons)
    assert table["name"].to_pylist()[69] == family.name(69)
