import importlib.util
import os
import subprocess
import sys
from functools import cache
from pathlib import Path

import numba
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba.core.caching import CacheImpl
from numpy.testing import assert_allclose, assert_array_equal

import bladegen as bg
from bladegen.airfoils import characteristics
from bladegen.airfoils.landmarks import landmarks, uniform
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.blade.changes.deformation import AffineChange, Window
from bladegen.blade.edges import MinimumThickness
from bladegen.blade.variants import kernels, nose_measures, section_measures, sizes
from bladegen.blade.variants.batch import SectionBatch
from bladegen.curves import plane_maps, polygons
from bladegen.curves.crossing import crossing_sections
from bladegen.support import compiled
from strategies import airfoils, box, ellipse

COUNT = 101
U = np.linspace(0.0, 1.0, COUNT)
THICK = 0.3
CHORD = np.array([[2.5]])


def loaded(module, **names):
    """Load a module's file once more, with some names of its own replaced."""
    spec = importlib.util.spec_from_file_location(f"plain_{module.__name__}", module.__file__)
    fresh = importlib.util.module_from_spec(spec)
    for name, value in names.items():
        sys.modules[name] = value
    spec.loader.exec_module(fresh)
    return fresh


@cache
def plain():
    """The kernels as plain Python."""
    modules = (compiled, plane_maps, characteristics, section_measures, nose_measures, sizes)
    known = {module.__name__: module for module in modules}
    numba.config.DISABLE_JIT = True
    try:
        decorator = loaded(compiled)
        maps = loaded(plane_maps, **{"bladegen.support.compiled": decorator})
        loaded_looks = loaded(characteristics, **{"bladegen.curves.plane_maps": maps})
        looks = {"bladegen.airfoils.characteristics": loaded_looks}
        measured = loaded(section_measures, **looks)
        measured_by = {"bladegen.blade.variants.section_measures": measured}
        fronts = {"bladegen.blade.variants.nose_measures": loaded(nose_measures, **measured_by)}
        inner = loaded(sizes, **fronts)
        return loaded(kernels, **{"bladegen.blade.variants.sizes": inner})
    finally:
        numba.config.DISABLE_JIT = False
        sys.modules.update(known)


def made(by, values, raw, target, *, edge=0.002, dtype=np.float64):
    """Run kernels on features (k, F, n) and coefficients (k, b, F, 2)."""
    k, b = target.shape
    slopes = np.ascontiguousarray(SectionSplines(U).values(U, 1) @ values.mT)
    own, known = np.empty((k, b)), np.empty((k, b), dtype=np.int64)
    sections, measures = np.empty((b, k, COUNT, 3), dtype=dtype), np.empty((b, k, 7))
    chord = np.broadcast_to(CHORD, (b, k)).copy()
    to_space = np.broadcast_to(np.eye(3), (b, k, 3, 3)).copy()
    still = np.broadcast_to([1.0, 0.0, 0.0, 0.0], (k, b, 4)).copy()
    given = U, values, slopes, raw, target, still, own, known, chord, to_space, sections, measures
    looks = np.empty((b, k, 6))
    by.made(*given, edge / chord, np.ones((k, b)), looks, False, 0, 1)
    return own, known, sections, measures


def as_features(points, target=THICK):
    """Sections (k, n, 2) as features that are the sections themselves."""
    k, n, _ = points.shape
    values = np.ascontiguousarray(np.concatenate([points.mT, np.ones((k, 1, n))], axis=1))
    raw = np.broadcast_to(np.eye(3)[:, :2], (k, 1, 3, 2)).copy()
    return values, raw, np.full((k, 1), target)


@cache
def task(name="iea15mw"):
    """Features and coefficients of a real family, strongly deformed."""
    blade = bg.Blade.from_definition(bg.read(name))
    space = bg.ShapeSpace.bundled()
    eta = np.array([0.0, 0.05, 0.12, 0.16, 0.2, 0.6, 1.0])
    batch = SectionBatch(blade, space, Window.beyond_circles(blade.definition.stations), eta)
    t = 0.9 * space.sample(8, np.random.default_rng(8))
    few = blade.u[:: (len(blade.u) - 1) // (COUNT - 1)]
    assert len(few) == COUNT
    values = np.ascontiguousarray(batch.features[..., :: (len(blade.u) - 1) // (COUNT - 1)])
    return values, batch.coefficients(t), batch.target(AffineChange(), 8)


@given(airfoils(), st.floats(0.0, 0.02))
@settings(deadline=None)
def test_kernels_do_what_numpys_laws_say(xy, edge):
    points = landmarks(xy, COUNT)[None]
    own, known, sections, measures = made(kernels, *as_features(points), edge=edge)
    splines = SectionSplines(U)
    A, c = splines.normalising(points, np.array([THICK]))
    finished = MinimumThickness(edge)(points @ A + c[:, None], CHORD[0])
    assert_allclose(own[0], splines.fit(points).relative_thickness, rtol=0, atol=1e-10)
    assert_allclose(sections[0, ..., :2], finished, rtol=0, atol=1e-9)
    assert_array_equal(sections[..., 2], 1.0)
    assert_allclose(measures[0], polygons.measure(2.5 * finished), rtol=1e-7, atol=1e-9)
    assert not crossing_sections(points) or known[0, 0] != kernels.SOUND


@given(airfoils(), st.integers(0, 2**32 - 1), st.floats(0, 0.1))
@settings(deadline=None)
def test_what_kernels_know_of_crossings_is_so(xy, seed, size):
    bumps = np.random.default_rng(seed).normal(size=(20, 4, 2)) * size
    waves = np.stack([np.sin((k + 1) * np.pi * U) for k in range(4)], axis=-1)
    contours = landmarks(xy, COUNT) + waves @ bumps
    known = made(kernels, *as_features(contours))[1][:, 0]
    crossing = np.isin(np.arange(20), crossing_sections(contours))
    assert not np.any(crossing[known == kernels.SOUND])
    assert np.all(crossing[known == kernels.CROSSING])


def test_compiled_and_plain_kernels_agree():
    values, raw, target = task()
    for one, other in zip(
        made(kernels, values, raw, target), made(plain(), values, raw, target), strict=True
    ):
        assert_allclose(one, other, rtol=1e-9, atol=1e-11)


def test_all_answers_about_crossings_occur_and_are_the_same_in_plain_code():
    t = np.linspace(0.0, 2.0 * np.pi, COUNT)
    lens = np.stack([0.5 + 0.5 * np.cos(t), 0.1 * np.sin(t)], axis=-1)
    twisted = lens * [1.0, -1.0]
    banana = lens + np.stack([0.0 * t, 2.0 * (lens[:, 0] - 0.5) ** 2], axis=-1)
    upright = lens @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    eight = np.stack([0.5 + 0.5 * np.cos(t), 0.1 * np.sin(2.0 * t)], axis=-1)
    wild = lens + 0.2 * np.stack([np.sin(9.0 * t), np.sin(7.0 * t)], axis=-1)
    given_ = np.stack([lens, twisted, banana, upright, eight, wild])
    for by in (kernels, plain()):
        works = np.empty((2, COUNT))
        answers = [by.compared(np.ascontiguousarray(points.T), works) for points in given_]
        exact = set(crossing_sections(given_))
        for i, answer in enumerate(answers):
            assert answer == kernels.OPEN or (answer == kernels.CROSSING) == (i in exact)
        assert set(answers) == {kernels.SOUND, kernels.CROSSING, kernels.OPEN}


@pytest.mark.parametrize("target", [0.9, 1.2])
def test_noses_that_share_the_leading_edge_are_followed_as_by_numpy(target):
    boxes = box(COUNT, np.array([0.0, 1e-6, -4e-6, 1e-5, 1e-3, 4e-3]))
    ovals = [landmarks(ellipse(t), COUNT, spacing=uniform) for t in (0.4, 1.165, 1.3)]
    points = np.concatenate([boxes, ovals])
    splines = SectionSplines(U)
    shares = splines.fit(points).shares
    assert shares[0] == 1.0
    assert shares[-3] == 0.0 < shares[-2] < 1.0
    A, c = splines.normalising(points, np.full(9, target))
    finished = MinimumThickness(0.002)(points @ A + c[:, None], np.full(9, CHORD[0, 0]))
    for by in (kernels, plain()):
        _, _, sections, _ = made(by, *as_features(points, target))
        assert_allclose(sections[0, ..., :2], finished, rtol=0, atol=1e-9)


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_sections_do_not_know_of_each_other(dtype):
    values, raw, target = task()
    whole = made(kernels, values, raw, target, dtype=dtype)
    for i in (0, 5):
        part = made(
            kernels, values, raw[:, i : i + 1].copy(), target[:, i : i + 1].copy(), dtype=dtype
        )
        assert_array_equal(part[0][:, 0], whole[0][:, i])
        assert_array_equal(part[1][:, 0], whole[1][:, i])
        assert_array_equal(part[2][0], whole[2][i])
        assert_array_equal(part[3][0], whole[3][i])


def test_what_is_not_a_number_ends_and_stays_so():
    values, raw, target = task()
    broken = raw[:, :1].copy()
    broken[2] = np.nan
    own, known, sections, _ = made(kernels, values, broken, target[:, :1].copy())
    assert np.isnan(own[2])
    assert np.isnan(sections[0, 2]).all()
    assert known[2, 0] == kernels.OPEN
    assert np.isfinite(sections[0, [0, 1, 3, 4, 5, 6]]).all()


def test_without_a_folder_to_write_nothing_is_kept_and_all_works(monkeypatch):
    monkeypatch.setattr(CacheImpl, "_locator_classes", [])
    twice = compiled.compiled(_twice)
    assert twice(2.0) == 4.0
    assert not twice.stats.cache_path


def _twice(x):
    return 2.0 * x


def test_a_package_that_may_not_be_written_keeps_its_kernels_with_the_user(tmp_path):
    code = "from bladegen.blade.variants import kernels; print(kernels.made.stats.cache_path)"
    run = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert Path(run.stdout.strip()).is_relative_to(tmp_path)


def test_what_is_compiled_already_is_known(tmp_path):
    code = (
        "from bladegen.support.compiled import is_kept;"
        "from bladegen.curves import plane_maps as p;"
        "print(is_kept(p.distance)); p.distance((0.0, 0.0), (3.0, 4.0)); print(is_kept(p.distance))"
    )
    run = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stdout.split() == ["False", "True"]
