"""Collision operators: each is its dense-matrix twin, keeps mass and momentum, and knows no direction."""

import importlib
import itertools

import numpy as np
import pytest

from porescale.lbm.boundary.sides import Sides
from porescale.lbm.collision.choose import OPERATORS, choose
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import CX, CY, OPPOSITE
from tests.reference.lbm import lbm as twin
from tests.reference.lbm import lbm_operators as dense

ORDER = [twin.C.index((int(cx), int(cy))) for cx, cy in zip(CX, CY, strict=True)]
WEIGHTS = np.array(twin.W)[ORDER][:, None, None]
PERIODIC = Sides("periodic", "periodic", "periodic", "periodic")
FORCE = (2e-3, -1e-3)
EDDIES = [0.0, 0.2]


def collided(operator, f, *, tau=0.7, magic=0.2, smagorinsky=0.0, force=FORCE, dtype=np.float64, sweep=None):
    """Whole populations (9, ny, nx), in the twin's order, after the collision of one (even) step."""
    ny, nx = f.shape[1:]
    fluid = Fluid(
        nx, ny, tau, operator=operator, magic=magic, smagorinsky=smagorinsky, force=force, sides=PERIODIC, dtype=dtype
    )
    fluid.populations[:, 1:-1, 1:-1] = f[ORDER] - WEIGHTS
    fluid.advance(*([sweep] if sweep else []))
    out = np.empty(f.shape)
    out[ORDER] = fluid.populations[OPPOSITE, 1:-1, 1:-1].astype(float) + WEIGHTS
    return out


def round_off(dtype):
    # Some 60 operations on shifted populations and moments of size 0.1 at most, and the weights of 4/9 the twin adds.
    return 60 * (0.1 * np.finfo(dtype).eps + np.finfo(float).eps)


@pytest.mark.parametrize(
    ("operator", "smagorinsky", "dtype"),
    [*itertools.product(OPERATORS, EDDIES, [np.float64]), *itertools.product(OPERATORS, [0.0], [np.float32]),
     ("trt", 0.2, np.float32)],
)  # fmt: skip
def test_an_operator_is_its_dense_matrix(operator, smagorinsky, dtype):
    f = dense.random_populations(4, 37)  # vectors and the rest of a row
    expected = dense.collided(operator, f, 0.7, FORCE, 0.2, smagorinsky)
    found = collided(operator, f, smagorinsky=smagorinsky, dtype=dtype)
    np.testing.assert_allclose(found, expected, rtol=0, atol=round_off(dtype))


@pytest.mark.parametrize("smagorinsky", EDDIES)
@pytest.mark.parametrize("operator", OPERATORS)
@pytest.mark.parametrize("wrong", ["tau", "force", "smagorinsky", "operator"])
def test_another_operator_rate_or_force_is_told_apart(operator, smagorinsky, wrong):
    f = dense.random_populations(4, 8)
    values = {"operator": operator, "tau": 0.7, "force": FORCE, "smagorinsky": smagorinsky}
    others = {"tau": 0.7001, "force": (2.01e-3, -1e-3), "smagorinsky": smagorinsky + 0.01}
    others["operator"] = "mrt" if operator == "trt" else "trt"
    values[wrong] = others[wrong]
    expected = dense.collided(values["operator"], f, values["tau"], values["force"], 0.2, values["smagorinsky"])
    found = collided(operator, f, smagorinsky=smagorinsky)
    assert np.abs(found - expected).max() > 1e4 * round_off(np.float64)


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_fluid_that_nothing_drives_computes_no_force_and_has_the_same_bits(dtype):
    from porescale.lbm.collision.choose import without_force
    from porescale.lbm.collision.trt import Trt, TrtWithoutForce
    from porescale.lbm.stream import sweep

    law = choose("trt", 0.7, (0.0, 0.0), dtype)
    assert (type(law), type(without_force(law))) == (Trt, TrtWithoutForce)
    driven = choose("trt", 0.7, (0.0, 1e-9), dtype)
    assert without_force(driven) is driven
    start = (dense.random_populations(6, 37)[ORDER] - WEIGHTS).astype(dtype)
    found = []
    for one in (law, without_force(law)):
        f = np.zeros((9, 8, 39), dtype)
        f[:, 1:-1, 1:-1] = start
        sweep(f, 0, 37, one)
        found.append(f + dtype(0.0))  # -0 is 0
    assert found[0].tobytes() == found[1].tobytes()
    sweep(f, 0, 37, driven._replace(fy=dtype(1e-3)))  # the twin: a force is seen
    assert f.tobytes() != found[0].tobytes()


def test_fluid_that_nothing_drives_as_plain_python(monkeypatch):
    from porescale.lbm.collision import law as shared
    from porescale.lbm.collision import trt

    for module, name in ((trt, "symmetric_equilibrium"), (trt, "relax_by"), (trt, "magic_rate"),
                         (shared, "cut"), (shared, "collide_cells"), (shared, "collide"), (shared, "half_force"),
                         (shared, "shear_rate"),
                         (shared, "moments")):  # fmt: skip
        monkeypatch.setattr(module, name, getattr(module, name).py_func)
    f = dense.random_populations(1, 5)
    rows = tuple((f[ORDER] - WEIGHTS)[:, 0])
    shared.collide_row.py_func(rows, 0, 5, trt.TrtWithoutForce(1 / 0.7, 0.0, 0.0, 0.2))
    out = np.empty(f.shape)
    out[ORDER] = np.array(rows)[OPPOSITE][:, None] + WEIGHTS
    expected = dense.collided("trt", f, 0.7, (0.0, 0.0), 0.2, 0.0)
    np.testing.assert_allclose(out, expected, rtol=0, atol=round_off(np.float64))


@pytest.mark.parametrize("operator", OPERATORS)
def test_a_collision_keeps_mass_and_adds_the_force_to_momentum(operator):
    f = dense.random_populations(4, 8)
    gained = collided(operator, f) - f
    for weight, expected in ((np.ones(9), 0.0), (dense.CX, FORCE[0]), (dense.CY, FORCE[1])):
        np.testing.assert_allclose(np.tensordot(weight, gained, 1), expected, rtol=0, atol=9 * round_off(np.float64))


@pytest.mark.parametrize("operator", OPERATORS)
def test_water_at_rest_stays_at_rest_to_the_bit(operator):
    fluid = Fluid(8, 5, 0.51, operator=operator, smagorinsky=0.1 * (operator == "trt"), dtype=np.float32)
    for _ in range(3):
        fluid.advance()
    assert not fluid.populations.any()


@pytest.mark.parametrize("operator", OPERATORS)
def test_small_disturbances_keep_their_digits_in_single_precision(operator):
    # Shifted populations: round-off is that of the disturbance, 1e-6, not of the weights.
    small = 1e-6 * (dense.random_populations(4, 8) - np.array(twin.W)[:, None, None])
    one, two = (Fluid(8, 4, 0.7, operator=operator, sides=PERIODIC, dtype=dtype) for dtype in (np.float32, np.float64))
    for fluid in (one, two):
        fluid.populations[:, 1:-1, 1:-1] = small[ORDER]
        fluid.advance()
    # 60 operations on numbers of 1e-6 * 0.05; the density's own digits are those of 1 + d, which enter products only.
    assert np.abs(one.populations - two.populations).max() < 60 * np.finfo(np.float32).eps * 5e-8


@pytest.mark.parametrize("operator", OPERATORS)
def test_eddies_without_strain_are_none(operator):
    f = twin.equilibrium(np.full((3, 4), 1.01), 0.03, -0.02)
    np.testing.assert_allclose(
        collided(operator, f, smagorinsky=0.2, force=(0, 0)),
        collided(operator, f, force=(0, 0)),
        rtol=0,
        atol=round_off(np.float64),
    )


@pytest.mark.parametrize("smagorinsky", EDDIES)
@pytest.mark.parametrize("operator", OPERATORS)
def test_an_operator_of_plain_python_is_the_compiled_one(operator, smagorinsky, monkeypatch):
    from porescale.lbm import stream
    from porescale.lbm.collision import law

    f = dense.random_populations(2, 3)
    compiled = collided(operator, f, smagorinsky=smagorinsky)
    body = importlib.import_module(f"porescale.lbm.collision.{operator}")
    patches = [
        (stream, "collide_row"),
        (stream, "even_slots"),
        (stream, "slots"),
        (law, "collide_cells"),
        (law, "cut"),
        (law, "moments"),
        (law, "shear_rate"),
        (law, "collide"),
    ]
    patches += [
        (body, name)
        for name in ("relax_halves", "relax_by", "symmetric_gain", "magic_rate", "relax_moments")
        if hasattr(body, name)
    ]
    patches += [(importlib.import_module("porescale.lbm.collision.smagorinsky"), "stress")]
    for module, name in patches:
        monkeypatch.setattr(module, name, getattr(module, name).py_func)
    plain = collided(operator, f, smagorinsky=smagorinsky, sweep=stream.sweep.py_func)
    np.testing.assert_allclose(plain, compiled, rtol=0, atol=round_off(np.float64))


def test_an_unknown_operator_is_refused_with_those_that_are_known():
    with pytest.raises(ValueError, match=r"'tr': choose from trt, mrt, central, bgk"):
        choose("tr", 0.7, (0.0, 0.0), np.float64)
