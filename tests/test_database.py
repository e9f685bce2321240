import numpy as np
import pytest
from numpy.testing import assert_allclose

from bladegen.airfoils.landmarks import landmarks
from bladegen.errors import FileError
from bladegen.formats.airfoils.reading import airfoil_folder, read_airfoil, read_folder
from bladegen.formats.baselines import baselines
from bladegen.formats.bundled import bundled
from bladegen.formats.reading import read
from bladegen.shapes.database import build_space
from bladegen.shapes.shape_space import ShapeSpace
from strategies import naca


def test_there_are_sixteen_baselines_and_the_seventeenth_is_one_of_them():
    found = baselines()
    assert len(found) == 16
    stations = {s.airfoil.name: s.airfoil.coordinates for s in read("dtu10mw").stations}
    assert_allclose(stations["ffaw3480"], stations["ffaw3360"] * [1.0, 4.0 / 3.0], atol=1e-6)
    lifting = {s.airfoil.name for n in bundled() for s in read(n).stations}
    taken = {name.split()[1] for name in found}
    assert {n for n in lifting - taken if "ylinder" not in n and "circ" not in n} == {"ffaw3480"}


def test_the_bundled_space_is_built_by_its_seed():
    few = dict(list(baselines().items())[:3])
    first, residuals = build_space(few, seed=3, count=20, modes=2, n=101)
    second, _ = build_space(few, seed=3, count=20, modes=2, n=101)
    assert np.array_equal(first.coordinates, second.coordinates)
    other, _ = build_space(few, seed=4, count=20, modes=2, n=101)
    assert not np.array_equal(first.coordinates, other.coordinates)
    assert set(residuals) == set(few)
    assert max(residuals.values()) < 1e-3
    assert "3 airfoils, 20 CST perturbations" in first.about


@pytest.mark.nightly
def test_the_bundled_space_can_be_built_again():
    space, residuals = build_space(baselines(), seed=2022, count=1000)
    bundled = ShapeSpace.bundled()
    assert_allclose(space.variances[:8], bundled.variances[:8], rtol=1e-6)
    assert_allclose(space.coordinates, bundled.coordinates, atol=1e-7)
    assert max(residuals.values()) < 1.2e-3


def test_without_perturbations_the_airfoils_themselves_are_taken():
    space, residuals = build_space(baselines(), seed=0, count=0, modes=3, n=101)
    assert residuals == {}
    assert len(space.coordinates) == 16


def selig(path, xy, title="A TITLE"):
    path.write_text(title + "\n" + "\n".join(f"{x:.6f}  {y:.6f}" for x, y in xy) + "\n")


def lednicer(path, xy):
    nose = len(xy) // 2
    sides = xy[nose::-1], xy[nose:]
    text = ["NAME 12", f" {len(sides[0])}.  {len(sides[1])}.", ""]
    for side in sides:
        text += [f"{x:.6f} {y:.6f}" for x, y in side] + [""]
    path.write_text("\n".join(text))


def test_selig_and_lednicer_files_are_told_apart_and_agree(tmp_path):
    xy = naca(0.18, 0.02, 0.004, 41)
    selig(tmp_path / "a.dat", xy)
    lednicer(tmp_path / "b.dat", xy)
    selig(tmp_path / "c.txt", xy[::-1], title="")
    wanted = landmarks(np.round(xy, 6), 51)
    for name in ("a.dat", "b.dat", "c.txt"):
        assert_allclose(landmarks(read_airfoil(tmp_path / name), 51), wanted, atol=1e-9)


def test_unusable_files_are_listed_with_the_reason(tmp_path):
    selig(tmp_path / "good.dat", naca(0.18, 0.02, 0.004, 41))
    crossed = naca(0.18, 0.0, 0.0, 41)
    crossed[10, 1] = -0.3
    selig(tmp_path / "crossed.dat", crossed)
    (tmp_path / "empty.dat").write_text("nothing\n")
    (tmp_path / "nan.dat").write_text("t\n" + "nan 0\n" * 20)
    selig(tmp_path / "half.dat", naca(0.18, 0.0, 0.0, 41)[:41])
    (tmp_path / "huge.dat").write_text("x" * 1_000_001)
    (tmp_path / "picture.png").write_bytes(b"x")
    airfoils, unusable = read_folder(tmp_path)
    assert list(airfoils) == ["good"]
    assert set(unusable) == {"crossed.dat", "empty.dat", "nan.dat", "half.dat", "huge.dat"}
    assert "crosses itself" in unusable["crossed.dat"]
    assert "0 points" in unusable["empty.dat"]
    assert "finite" in unusable["nan.dat"]
    assert "trailing edge to trailing edge" in unusable["half.dat"]
    (tmp_path / "polar.dat").write_text("alpha cl cd\n-10 -0.5 0.02\n0 0.4 0.01\n10 1.2 0.02\n")
    assert "polar.dat" not in read_folder(tmp_path)[1]
    said = [str(one) for one in airfoil_folder(tmp_path).said]
    assert said == ["polar.dat: holds polars, not a shape; passed over"]
    with pytest.raises(FileError, match="is no folder"):
        read_folder(tmp_path / "nowhere")
    with pytest.raises(FileError, match="cannot be read"):
        read_airfoil(tmp_path / "nowhere.dat")
