import meshing
import numpy as np
import pytest
from numpy.testing import assert_allclose

from bladegen.blade.blade import Blade
from bladegen.cad import exchange, shapes, solids
from bladegen.cad.triangles import triangulated
from bladegen.errors import CadError
from bladegen.formats.reading import read
from bladegen.measures import checks
from bladegen.surface import mesh_files


@pytest.fixture(scope="module")
def solid():
    return solids.solid(Blade.from_definition(read("dtu10mw"), landmarks=101), sections=60)


WRITERS = {
    ".step": exchange.write_step,
    ".iges": exchange.write_iges,
    ".brep": exchange.write_brep,
}
BOTH = pytest.mark.parametrize("suffix", WRITERS)


@BOTH
def test_solids_are_read_again_whole(solid, tmp_path, suffix):
    path = tmp_path / f"blade{suffix}"
    WRITERS[suffix](solid, path)
    shape = exchange.read(path)
    figures = checks.solid_figures(shape, quick=True)
    assert figures["valid"]
    assert figures["closed"]
    assert figures["one_solid"]
    again = shapes.quick_volume(shape)
    assert_allclose(again, shapes.quick_volume(solid.shape), rtol=1e-6)


@BOTH
def test_gmsh_reads_them_as_one_volume_in_millimetres(solid, tmp_path, suffix):
    path = tmp_path / f"blade{suffix}"
    WRITERS[suffix](solid, path)
    found = meshing.found(path)
    assert found.volumes == 1
    assert_allclose(found.box[5], 1000 * solid.net.poles[..., 2].max(), rtol=1e-3)


def test_the_schema_is_what_was_asked_for(solid, tmp_path):
    for schema, name in (("ap242", "AP242_MANAGED_MODEL"), ("ap214", "AUTOMOTIVE_DESIGN")):
        path = tmp_path / f"{schema}.step"
        exchange.write_step(solid, path, schema=schema)
        assert name in path.read_text()[:2000]
        assert checks.solid_figures(exchange.read(path), quick=True)["valid"]


def test_triangles_of_a_shape_lie_on_it(solid):
    triangles = triangulated(solid.shape, 0.002)
    welded = mesh_files.to_trimesh(triangles)
    welded.merge_vertices()
    assert_allclose(welded.volume, solid.net.volume(), rtol=1e-3)
    low, high = triangles.vertices.min(axis=0), triangles.vertices.max(axis=0)
    assert_allclose(high[2], solid.net.poles[..., 2].max(), atol=1e-4)
    assert np.all(low < high)


@BOTH
def test_other_files_are_refused(tmp_path, suffix):
    path = tmp_path / f"no{suffix}"
    path.write_text("nothing of the kind\n")
    with pytest.raises(CadError, match="OCCT can read"):
        exchange.read(path)


def test_times_that_are_none_are_refused(solid, tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "9" * 30)
    for write in (exchange.write_step, exchange.write_iges):
        with pytest.raises(CadError, match="SOURCE_DATE_EPOCH: got 999"):
            write(solid, tmp_path / "a")
    assert list(tmp_path.iterdir()) == []
