"""What scenes are held against does the same job, and a scene's arrays are counted once."""

import numpy as np
import pytest

from continuum_sph.benchmarks.minimal_sph import PlainColumn
from continuum_sph.benchmarks.overhead import scene, started
from porescale.benchmarks.minimal_dem import PlainDiscs
from porescale.benchmarks.minimal_lbm import PlainWater
from porescale.benchmarks.minimal_psm import PlainWet
from porescale.common.evidence.overhead import SMALLEST, BuiltScene, SceneKind, SceneKinds, bytes_of, markdown, measure
from porescale.dem.contact.linear import Linear
from porescale.lbm.fluid import Fluid
from porescale.validation.coupling.setups import immersed
from porescale.validation.dem.sleep import heap

ROUGH = Linear(5e5, 2.0, 1.25e5, 1.0, 0.5)
SMOOTH = Linear(5e5, 2.0)


def test_the_smallest_lattice_does_what_the_fluid_does():
    fluid = Fluid(12, 9, 0.8)
    rng = np.random.default_rng(3)
    fluid.set_flow(*(0.05 * rng.normal(size=(2, 9, 12))), density=1 + 0.01 * rng.normal(size=(9, 12)))
    plain_water = PlainWater(fluid.populations, 0.8)
    steps = 20
    for _ in range(steps):
        fluid.advance()
    plain_water.advance(steps)
    # Two ways to write one sum: some ten roundings of populations below 0.1 a step.
    assert np.abs(plain_water.populations - fluid.populations)[:, 1:-1, 1:-1].max() < steps * 10 * 2.2e-16 * 0.1


@pytest.mark.slow
@pytest.mark.parametrize("law", [ROUGH, SMOOTH], ids=["friction", "none"])
def test_the_smallest_discs_do_what_grains_do(law):
    grains, weights = heap()
    grains.set_law(law)
    grains.discs.velocity[:] = 0.02 * np.random.default_rng(1).normal(size=grains.discs.velocity.shape)
    dt, steps = 1e-5, 60
    twin = PlainDiscs(grains, weights, dt)
    start = grains.discs.position.copy()
    twin.advance(steps)
    grains.step(dt, weights, count=steps)
    assert np.abs(grains.discs.position - start).max() > 1e-6
    # Forces are sums of terms k x that cancel: eps k x/m dt² a step, 2e-16 5e5 1e-2/8e-3 1e-10, and twice summed.
    allowed = 2.2e-16 * 5e5 * 1e-2 / grains.discs.mass.min() * dt**2 * steps**2
    assert np.abs(twin.discs["position"] - grains.discs.position).max() < allowed


def falling():
    """A dozen discs that fall through each other onto the floor of a closed box, in water they stir."""
    radius = np.array([4.0, 3.5, 4.5, 3.8, 4.9, 4.2] * 2)
    places = [(8.0 + 11.0 * (n % 6) + 1.3 * (n // 6), 4.8 + 9.6 * (n // 6) + 0.2 * (n % 3)) for n in range(12)]
    velocity = [(0.004 * (-1) ** n, -0.006) for n in range(12)]
    return immersed(
        (76, 40), places, radius, 3.0, velocity, spin=0.001, relaxation_time=0.8, sides=("wall", "wall"), ratio=0.8,
        acceleration=(0.0, -2e-5),
    )  # fmt: skip


@pytest.mark.slow
def test_the_smallest_kernels_do_what_moving_discs_in_water_do():
    coupled = falling()
    for _ in range(2):
        coupled.advance()
    twin, other = PlainWet(coupled), PlainWet(coupled)
    other.water.even *= 1.0 + 1e-9  # the twin that must fail
    start, steps, touched = coupled.grains.discs.position.copy(), 40, 0
    for _ in range(steps):
        coupled.advance()
        touched += int(np.count_nonzero(coupled.contact_load()))
    twin.advance(steps)
    other.advance(steps)
    assert touched > 0
    assert np.abs(coupled.grains.discs.position - start).max() > 0.1
    found = coupled.fluid.populations[:, 1:-1, 1:-1]
    # A cell makes some twenty roundings of terms below 0.02 a step.  Loads are sums over a hundred cells, but of discs
    # with masses above a hundred: velocities err no more, and positions by that times the steps and their own rounding.
    allowed = steps * 20 * 2.2e-16 * 0.02
    assert np.abs(found).max() > 1e-3
    assert np.abs(twin.water.populations[:, 1:-1, 1:-1] - found).max() < allowed
    assert np.abs(twin.dry.discs["velocity"] - coupled.grains.discs.velocity).max() < allowed
    assert np.abs(twin.dry.discs["position"] - coupled.grains.discs.position).max() < steps * allowed + 64 * 2.2e-16
    assert np.abs(twin.dry.discs["spin"] - coupled.grains.discs.spin).max() < allowed
    assert np.abs(other.water.populations[:, 1:-1, 1:-1] - found).max() > allowed


@pytest.mark.slow
@pytest.mark.parametrize("numerics", [{}, {"xsph": 0.5}])
def test_the_smallest_water_does_what_smoothed_particles_do(numerics):
    whole = started(scene(numerics))
    plain, layer, steps = PlainColumn(whole.flow), whole.flow.layer, 20
    start = layer.x.copy()
    plain.advance(steps)
    whole.advance(steps)
    assert np.abs(layer.x - start).max() > 1e-3
    assert plain.next_step == pytest.approx(whole.step_seconds, rel=1e-12)
    # A row is some 30 terms of ten roundings, none more than c²/h = 40²/0.04 m/s² or ρ v/h = 1e5 kg/(m³ s), here for
    # 20 steps of 1 ms at most: 300 eps of what they bring.
    allowed = 300 * 2.2e-16 * steps * 1e-3
    assert np.abs(plain.v - layer.v).max() < allowed * 40**2 / 0.04
    assert np.abs(plain.density - layer.density).max() < allowed * 1e5
    other = PlainColumn(whole.flow)
    other.mass = other.mass * (1.0 + 1e-9)  # the twin that must fail
    whole.advance(steps)
    other.advance(steps)
    assert np.abs(other.density - layer.density).max() > allowed * 1e5


def test_arrays_are_counted_once_however_they_are_named():
    class Model:
        """Of no package of ours."""

    Model.__module__ = "porescale.test"
    model = Model()
    model.own = np.zeros(10)
    model.view = model.own[3:]
    model.more = {"a": [np.zeros(5)], "b": (model.own,)}
    model.me = model
    assert bytes_of(model) == 15 * 8


def test_a_kind_is_timed_beside_its_other_and_told_in_its_table():
    done = {"steps": 0, "other": 0}

    def count(name):
        def steps(number):
            done[name] += number

        return steps

    built = BuiltScene([np.zeros(4)], ("fluid",), 4, count("steps"), count("other"))
    kinds = SceneKinds(
        [
            SceneKind("thing", "cell", SMALLEST, lambda: built, steps=5),
            SceneKind("more", "cell", "thing", lambda: built),
        ]
    )
    rows = [measure(kind, rounds=3) for kind in kinds.chosen()]
    assert rows[0].bytes == 8.0
    assert done["steps"] == done["other"] == 4 * 5 + 4 * 50
    told = markdown({"command": "x"}, rows)
    assert "| thing (4 cells) | fluid | 8 a cell |" in told
    assert "| thing | " in told.split("What a part adds")[1]
