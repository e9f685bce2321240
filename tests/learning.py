"""The adapters to torch and jax in the real libraries; `test_learning` runs this file.

Not collected by itself: both libraries lie in an environment of their own.
"""

import re
from functools import cache
from pathlib import Path

import jax
import numpy as np
import pytest
import torch
from jax.test_util import check_grads
from numpy.testing import assert_allclose

import bladegen as bg
import bladegen.jax
import bladegen.torch
from bladegen.errors import FamilyError, PerturbationError

EVERY = ("sections", "volume", "section_area")
ADAPTERS = {"torch": bladegen.torch.BladeFunction, "jax": bladegen.jax.BladeFunction}
jax.config.update("jax_enable_x64", True)


@cache
def model():
    blade = bg.Blade.from_definition(bg.read("iea15mw"), landmarks=101)
    parameters = (("pga", (0.5, 0.9)), ("chord", (0.5, 0.9)), "twist", "thickness")
    eta, u = np.linspace(0.5, 1.0, 3), np.linspace(0.0, 1.0, 9)
    return bg.ParametricBlade(blade, bg.ShapeSpace.bundled(), parameters, eta, u)


def vectors(*lead):
    rng = np.random.default_rng(5)
    return model().baseline + 0.02 * rng.normal(size=(*lead, len(model().names)))


def exact(name, x):
    return model().jacobian(x) if name == "sections" else model().quantities(x).jacobian(name)


@pytest.mark.parametrize("lead", [(), (4,), (2, 3)])
@pytest.mark.parametrize("library", ADAPTERS)
def test_values_are_those_of_the_model(library, lead):
    x = vectors(*lead)
    found = ADAPTERS[library](model(), EVERY)(torch.tensor(x) if library == "torch" else x)
    assert list(found) == list(EVERY)
    quantities = model().quantities(x)
    for name, value in found.items():
        wanted = model().sections(x) if name == "sections" else quantities[name]
        assert value.shape == wanted.shape
        assert_allclose(np.asarray(value), wanted, rtol=0, atol=1e-12)


def test_torch_finds_gradients_right_forward_and_back():
    function = bladegen.torch.BladeFunction(model(), EVERY)
    x = torch.tensor(vectors(2), requires_grad=True)
    assert torch.autograd.gradcheck(
        lambda x: tuple(function(x).values()), x, eps=1e-5, atol=1e-5, check_forward_ad=True
    )


@pytest.mark.parametrize("name", EVERY)
def test_functions_of_torch_and_jax_give_the_models_jacobian(name):
    x = vectors()
    by_torch = bladegen.torch.BladeFunction(model(), (name,))
    by_jax = bladegen.jax.BladeFunction(model(), (name,))
    wanted = exact(name, x)
    close = {"rtol": 0, "atol": 1e-11 * np.abs(wanted).max()}
    for jacobian in (torch.func.jacrev, torch.func.jacfwd):
        assert_allclose(jacobian(lambda x: by_torch(x)[name])(torch.tensor(x)), wanted, **close)
    for jacobian in (jax.jacrev, jax.jacfwd):
        assert_allclose(jax.jit(jacobian(lambda x: by_jax(x)[name]))(x), wanted, **close)


def test_batches_are_mapped():
    x = vectors(4)
    wanted = exact("volume", x)
    by_torch = bladegen.torch.BladeFunction(model(), ("volume",))
    by_jax = bladegen.jax.BladeFunction(model(), ("volume",))
    mapped = torch.func.vmap(torch.func.grad(lambda x: by_torch(x)["volume"]))
    assert_allclose(mapped(torch.tensor(x)), wanted, rtol=1e-12)
    mapped = jax.jit(jax.vmap(jax.grad(lambda x: by_jax(x)["volume"])))
    assert_allclose(mapped(x), wanted, rtol=1e-12)
    ways = vectors(4) - model().baseline
    along = torch.func.vmap(
        lambda x, dx: torch.func.jvp(lambda x: by_torch(x)["volume"], (x,), (dx,))[1]
    )
    assert_allclose(along(torch.tensor(x), torch.tensor(ways)), (wanted * ways).sum(1), rtol=1e-11)


def test_a_loss_goes_through_several_outputs_in_jax():
    function = bladegen.jax.BladeFunction(model(), EVERY)
    check_grads(lambda x: tuple(function(x).values()), (vectors(2),), 1, eps=1e-5)


ORDERS = {
    "torch": (torch.func.jacrev, torch.func.jacfwd, torch.func.grad),
    "jax": (jax.jacrev, jax.jacfwd, jax.grad),
}


@pytest.mark.parametrize("inner", range(3))
@pytest.mark.parametrize("outer", range(2))
@pytest.mark.parametrize("library", ADAPTERS)
def test_second_derivatives_end_in_one_line_of_ours(library, outer, inner):
    """Six of twelve ways to a Hessian ended in what the libraries say of custom functions."""
    function = ADAPTERS[library](model(), "volume")
    first = ORDERS[library][inner](lambda x: function(x)["volume"])
    x = torch.tensor(vectors()) if library == "torch" else vectors()
    with pytest.raises(PerturbationError, match=r"knows first derivatives only.*differences"):
        ORDERS[library][outer](first)(x)


def test_gradients_of_products_with_derivatives_are_products():
    """What is linear in a direction can be derived along it, and turned round."""
    function = bladegen.jax.BladeFunction(model(), EVERY)
    x, way = vectors(), vectors() - model().baseline

    def along(way):
        return jax.jvp(function, (x,), (way,))[1]["volume"]

    assert_allclose(jax.grad(along)(way), exact("volume", x), rtol=1e-12)
    assert_allclose(jax.jvp(along, (way,), (way,))[1], exact("volume", x) @ way, rtol=1e-11)
    _, back = jax.vjp(lambda x: function(x)["volume"], x)
    assert_allclose(jax.grad(lambda g: back(g)[0] @ way)(1.0), exact("volume", x) @ way, rtol=1e-11)


def test_torch_compiles_what_goes_through_a_blade():
    function = bladegen.torch.BladeFunction(model(), "volume")

    baseline = torch.tensor(model().baseline)

    def loss(z):
        return function(baseline + 0.02 * torch.sin(z))["volume"] ** 2

    z = torch.tensor(vectors() - model().baseline, requires_grad=True)
    plain = torch.autograd.grad(loss(z), z)[0]
    assert_allclose(
        torch.autograd.grad(torch.compile(loss, backend="eager")(z), z)[0], plain, rtol=1e-12
    )


def test_what_is_not_there_is_said():
    function = bladegen.torch.BladeFunction(model(), "volume")
    x = torch.tensor(vectors(), requires_grad=True)
    with pytest.raises(PerturbationError, match=r"got torch.float32, .*\.double\(\) makes one"):
        function(x.float())
    with pytest.raises(PerturbationError, match="got ndarray, must be a tensor"):
        function(vectors())
    slope = torch.autograd.grad(function(x)["volume"], x, create_graph=True)[0]
    with pytest.raises(PerturbationError, match="first derivatives only"):
        slope.sum().backward()
    by_jax = bladegen.jax.BladeFunction(model(), "volume")
    with pytest.raises(PerturbationError, match=r"x: got an array of shape \(3,\), must be"):
        jax.jit(by_jax)(np.zeros(3))
    with pytest.raises(PerturbationError, match="x: must be finite"):
        by_jax(np.full(len(model().names), np.nan))
    for adapter in ADAPTERS.values():
        with pytest.raises(PerturbationError, match="did you mean volume"):
            adapter(model(), ("volum",))
    with jax.enable_x64(False), pytest.raises(PerturbationError, match="double precision is off"):
        bladegen.jax.BladeFunction(model())(vectors())


def test_what_the_page_on_optimising_shows_runs():
    page = Path(bg.__file__).parent.parent / "docs" / "optimise.md"
    blocks = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    names: dict = {}
    exec("\n".join(blocks), names)  # one after the other, as they are read
    assert len(names["x"].grad) == len(names["model"].names)
    assert names["slope"](names["model"].baseline).shape == (len(names["model"].names),)


@pytest.fixture(scope="module")
def family(tmp_path_factory):
    from bladegen.families.order import Order
    from bladegen.families.run import run

    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=61)
    made = bg.family(blade, count=70, spans=16, bounds={"chord": (0.9, 1.1)}, design="box")
    target = tmp_path_factory.mktemp("family")
    run(Order(made, target))
    return bg.load_family(target)


def test_torch_loads_a_family_in_batches(family):
    names = ("variant", "parameters", "sections")
    data = bladegen.torch.FamilyDataset(family, names, family.split("train"))
    assert len(data) == len(family.split("train"))
    loader = torch.utils.data.DataLoader(data, batch_size=16, shuffle=True)
    seen = []
    for part in loader:
        assert part["sections"].dtype == torch.float32
        places = part["variant"].numpy().astype(int)
        assert_allclose(part["sections"], family["sections"][:][places])
        assert_allclose(part["parameters"], family.parameters[places], rtol=1e-6)
        seen += places.tolist()
    assert sorted(seen) == family.split("train").tolist()
    with pytest.raises(IndexError):
        data[len(data)]
    for given, said in (
        ((family, ("reason",)), "'reason' holds texts"),
        ((family, "volum"), "did you mean volume"),
        ((family, ("volume",), [9999]), "places: got 9999, allowed is 0 to 69"),
        (("family", ("volume",)), "must be a LoadedFamily; bladegen.load_family"),
    ):
        with pytest.raises(FamilyError, match=said):
            bladegen.torch.FamilyDataset(*given)
    with pytest.raises(FamilyError, match=r"dtype: got 'float32', must be a torch\.dtype"):
        bladegen.torch.FamilyDataset(family, dtype="float32")
    mask = np.arange(len(family)) < 5
    assert len(bladegen.torch.FamilyDataset(family, "volume", mask)) == 5


def test_jax_is_given_a_familys_batches(family):
    parts = list(bladegen.jax.batches(family, ("sections", "chord"), 32))
    assert [len(part["chord"]) for part in parts] == [32, 32, 6]
    assert all(isinstance(value, jax.Array) for part in parts for value in part.values())
    assert_allclose(np.concatenate([part["chord"] for part in parts]), family["chord"][:])
    for given, said in (((family, "name"), "'name' holds texts"), (("fam",), "must be a Loaded")):
        with pytest.raises(FamilyError, match=said):
            bladegen.jax.batches(*given)
