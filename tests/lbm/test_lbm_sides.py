"""Velocity and pressure sides: what streams in place is the twin's, with neighbours of any kind, and they balance."""

import itertools

import numpy as np
import pytest

from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from tests.lbm.beside_twin import ROUND_OFF, go, same, start
from tests.reference.lbm import lbm as twin

EPS = np.finfo(float).eps
NX, NY = 7, 6
FORCE = (2e-4, -1e-4)
KINDS = ["wall", "slip", "velocity", "pressure"]
KEY = {"wall": "speed", "velocity": "velocity", "pressure": "density"}


def profile(n, seed):
    return 0.02 * np.random.default_rng(seed).uniform(-1, 1, (n, 2))


def number(name, kind):
    """A number for a side of that kind; each side its own, some of one velocity and some of one for each cell."""
    k = ["left", "right", "bottom", "top"].index(name)
    given = {"left": profile(NY, 1), "right": (0.01, -0.02), "bottom": profile(NX, 2), "top": (0.0, 0.02)}
    return {"wall": 0.01 * (k + 1), "velocity": given[name], "pressure": 1 + 0.002 * (k - 1)}.get(kind, 0.0)


def pair(left, right, bottom, top, *, nx=NX, ny=NY, seed=1):
    kinds = {"left": left, "right": right, "bottom": bottom, "top": top}
    numbers = {name: number(name, kind) for name, kind in kinds.items()}
    given = {f"{name}_{KEY[kind]}": numbers[name] for name, kind in kinds.items() if kind in KEY}
    fluid = Fluid(nx, ny, 0.7, force=FORCE, sides=Sides(**kinds, **given))
    other = twin.Lattice(nx, ny, 0.7, 3 / 16, FORCE, {name: (kinds[name], numbers[name]) for name in kinds})
    return start(fluid, other, seed)


@pytest.mark.parametrize(("left", "bottom"), list(itertools.product(KINDS, [*KINDS, "periodic"])))
@pytest.mark.parametrize("open_kind", ["velocity", "pressure"])
def test_open_sides_in_place_are_open_sides_between_two_arrays(left, bottom, open_kind):
    top = "periodic" if bottom == "periodic" else open_kind if left == "slip" else "wall"
    go(*pair(left, open_kind, bottom, top))


@pytest.mark.parametrize(("nx", "ny"), [(1, NY), (NX, 1), (2, 2)])
def test_boxes_one_cell_wide_have_open_sides_alike(nx, ny):
    for left, right in itertools.product(["velocity", "pressure"], repeat=2):
        kinds = {"left": left, "right": right}
        numbers = {"left": (0.01, 0.005), "right": (-0.01, 0.02)}
        numbers = {name: numbers[name] if kind == "velocity" else 1.002 for name, kind in kinds.items()}
        given = {f"{name}_{KEY[kind]}": numbers[name] for name, kind in kinds.items()}
        fluid = Fluid(nx, ny, 0.7, force=FORCE, sides=Sides(**kinds, **given))
        other = twin.Lattice(nx, ny, 0.7, 3 / 16, FORCE, {name: (kinds[name], numbers[name]) for name in kinds})
        go(fluid, other)


@pytest.mark.parametrize("side", ["left", "right", "bottom", "top"])
@pytest.mark.parametrize("kind", ["velocity", "pressure"])
def test_a_slightly_different_side_is_told_apart(side, kind):
    kinds = {name: kind if name == side else "wall" for name in ("left", "right", "bottom", "top")}
    fluid, other = pair(**kinds)
    changed = np.asarray(number(side, kind)) + 1e-6
    other.sides[side] = (kind, tuple(changed) if changed.shape == (2,) else changed)
    fluid.advance()
    other.step()
    with pytest.raises(AssertionError):
        same(fluid, other, 1)


@pytest.mark.parametrize("start", [2, 3])
def test_a_side_that_changes_acts_from_the_next_step_on(start):
    fluid, other = pair("velocity", "pressure", "velocity", "wall")
    go(fluid, other, start)
    before = fluid.fields()
    ramp = profile(NY, 5)
    fluid.set_side_velocity("left", ramp)
    fluid.set_side_density("right", 1.004)
    for ours, theirs in zip(fluid.fields(), before, strict=True):
        np.testing.assert_array_equal(ours, theirs)
    other.sides = other.sides | {"left": ("velocity", ramp), "right": ("pressure", 1.004)}
    for step in range(3):
        fluid.advance()
        other.step()
        same(fluid, other, start + 1 + step)


def test_what_flows_in_and_out_is_the_sum_of_the_velocities():
    fluid, _ = pair("velocity", "velocity", "wall", "slip")
    before = fluid.mass_excess()
    steps = 20
    for _ in range(steps):
        fluid.advance()
    expected = steps * (profile(NY, 1)[:, 0].sum() - NY * 0.01)
    # 42 cells, nine populations of size 0.05, ten roundings a step, all one way.
    assert abs(fluid.mass_excess() - before - expected) < NX * NY * 9 * 0.05 * 10 * steps * EPS


def test_a_uniform_flow_through_open_sides_stays_as_it_is():
    # Both kinds of side are exact for it: the equilibrium at density 1 solves bounce-back and anti-bounce-back.
    u = (0.05, 0.02)
    given = dict.fromkeys(("left_velocity", "bottom_velocity", "top_velocity"), u)
    fluid = Fluid(9, 8, 0.6, sides=Sides("velocity", "pressure", "velocity", "velocity", **given))
    fluid.set_flow(*u)
    steps = 20
    for _ in range(steps):
        fluid.advance()
    for field, exact in zip(fluid.fields(), (1.0, *u), strict=True):
        assert np.abs(field - exact).max() < ROUND_OFF * steps


@pytest.mark.parametrize("steps", [4, 5])
def test_a_restored_fluid_with_open_sides_goes_on_bit_for_bit(steps):
    def go_on(fluid, count):
        for _ in range(count):
            fluid.advance()

    fluid, _ = pair("velocity", "pressure", "wall", "pressure")
    fluid.set_side_velocity("left", (0.03, 0.01))
    fluid.set_side_density("top", 1.003)
    go_on(fluid, steps)
    state = fluid.state()
    rim = {key: value.copy() for key, value in state["rim"].items()}
    kept = state | {"populations": state["populations"].copy(), "rim": rim}
    go_on(fluid, 5)
    again, _ = pair("velocity", "pressure", "wall", "pressure")
    again.restore(kept)
    go_on(again, 5)
    np.testing.assert_array_equal(fluid.populations, again.populations)
    twin_that_fails, _ = pair("velocity", "pressure", "wall", "pressure")
    twin_that_fails.restore({key: value for key, value in kept.items() if key != "rim"})
    go_on(twin_that_fails, 5)
    assert np.abs(twin_that_fails.populations - fluid.populations).max() > 1e-4


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_open_sides_stay_in_the_dtype_of_the_populations(dtype):
    from porescale.lbm.boundary.pressure import OpenLinks
    from porescale.lbm.boundary.sides import Bounds

    links = OpenLinks(Bounds(4, 3, Sides("pressure", "pressure")), dtype)
    assert {a.dtype for a in (links.along, links.weight, links.excess)} == {np.dtype(dtype)}


def test_a_step_with_open_sides_of_plain_python_is_the_compiled_one(monkeypatch):
    from porescale.lbm.boundary import links as rim
    from porescale.lbm.boundary import pressure as open_links
    from porescale.lbm.boundary import velocity as velocity_links

    compiled, _ = pair("velocity", "pressure", "pressure", "wall", nx=NX, ny=NY)
    names = [(rim, "pass_on"), (rim, "pass_one"), (open_links, "let_in")]
    names += [(velocity_links, "_add"), (open_links, "moments")]
    for module, name in names:
        monkeypatch.setattr(module, name, getattr(module, name).py_func)
    plain, _ = pair("velocity", "pressure", "pressure", "wall", nx=NX, ny=NY)
    for _ in range(2):
        plain.advance()
    monkeypatch.undo()
    for _ in range(2):
        compiled.advance()
    np.testing.assert_allclose(plain.populations, compiled.populations, rtol=0, atol=2 * ROUND_OFF)


def test_wrong_sides_are_refused_with_the_reason():
    fluid, _ = pair("velocity", "pressure", "wall", "wall")
    with pytest.raises(ValueError, match="right side is of kind pressure, not velocity"):
        fluid.set_side_velocity("right", (0.0, 0.0))
    with pytest.raises(ValueError, match=r"shape \(3, 2\), not \(2,\) or \(6, 2\)"):
        fluid.set_side_velocity("left", np.zeros((3, 2)))
    with pytest.raises(ValueError, match="left side is of kind velocity, not pressure"):
        fluid.set_side_density("left", 1.0)
    with pytest.raises(ValueError, match="not positive"):
        fluid.set_side_density("right", 0.0)


def test_a_plate_keeps_away_from_pressure_sides_and_stands_with_velocity_sides():
    with pytest.raises(ValueError, match="pressure does not"):
        pair("wall", "wall", "wall", "pressure")[0].add_plate(3)
    with pytest.raises(ValueError, match="two cells"):
        pair("pressure", "wall", "wall", "wall")[0].add_plate(1)
    with pytest.raises(ValueError, match="two cells"):
        pair("wall", "pressure", "wall", "wall")[0].add_plate(NX - 1)
    for kinds in (("pressure", "pressure", "wall", "wall"), ("velocity", "wall", "velocity", "wall")):
        fluid, other = pair(*kinds)
        fluid.add_plate(2).speed = 0.03
        other.plate, other.plate_speed = 2, 0.03
        go(fluid, other, 6)
