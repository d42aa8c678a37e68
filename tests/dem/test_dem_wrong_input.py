"""Wrong numbers from Python below the scenes of grains: each is refused by name."""

import math

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.common.neighbors.placement import place, square_lattice, triangular_lattice
from porescale.dem import Box, Grains, Hertz, Linear, make_discs, polygon
from porescale.dem.contact.materials import Materials

LAW = Linear(1e5, friction=0.5)
UNIT = Box((0.0, 0.0), (1.0, 1.0))


def two(law=LAW, **options):
    """Two discs that do not touch."""
    return Grains(make_discs([[0.2, 0.2], [0.6, 0.6]], 0.1, 1000.0), law, UNIT, **options)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"dt": math.nan}, "step.dt = nan s: is not finite"),
        ({"dt": -1e-5}, "step.dt = -1e-05 s: is out of range .allowed: > 0 s"),
        ({"dt": 0.0}, "step.dt"),
        ({"count": 2.0}, "step.count = 2.0: is no whole number"),
        ({"count": -1}, "step.count"),
        ({"drag": math.nan}, "step.drag"),
        ({"drag": -1.0}, "step.drag"),
        ({"external_force": np.zeros((3, 2))}, r"step.external_force: has the shape \(3, 2\)"),
        ({"external_torque": np.zeros(3)}, "step.external_torque"),
    ],
)
@pytest.mark.parametrize("later", [False, True])
def test_a_step_takes_numbers_that_a_step_can_have(given, said, later):
    grains = two()
    good = {"dt": 1e-5, "external_force": np.zeros((2, 2)), "external_torque": np.zeros(2), "count": 2, "drag": 0.5}
    if later:  # what was checked in an earlier call does not hide what is wrong in this one
        grains.step(**good)
    before = grains.discs.state()
    with pytest.raises(InputError, match=said):
        grains.step(**{**good, **given})
    assert all(np.array_equal(before[name], now) for name, now in grains.discs.state().items())
    grains.step(**good)


def test_loads_are_those_of_each_call():
    grains, force = two(), np.zeros((2, 2))
    grains.step(1e-5, force)
    force[:] = 3.0
    grains.step(1e-5, force)
    assert np.all(grains.external_force == 3.0)
    grains.step(1e-5)
    assert np.all(grains.external_force == 0.0)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: two().add_wall("slope", (math.nan, 0.0), (0.0, 1.0)), "wall.point = nan m"),
        (lambda: two().add_wall("slope", 0.5, (0.0, 1.0)), r"wall.point: has the shape \(\)"),
        (lambda: two().add_wall("slope", (0.0, 0.0), (math.inf, 1.0)), "wall.normal"),
        (lambda: two().add_wall("slope", (0.0, 0.0), (0.0, 1.0), friction=-1.0), "wall.friction"),
        (lambda: two().stable_step(safety=-1.0), "stable_step.safety = -1.0: is out of range .allowed: > 0"),
        (lambda: two().stable_step(steps_per_contact=math.nan), "stable_step.steps_per_contact"),
        (lambda: two(material=[5]), "material = 5.0: of grain 0 is out of range .allowed: >= 0 and <= 0"),
        (lambda: two(material=[0, 0, 0]), r"material: has the shape \(3,\)"),
        (lambda: two(Materials({"a": LAW, "b": LAW}), material=[0, 2]), "material = 2.0: of grain 1"),
        (lambda: two(Materials({"a": LAW, "b": LAW}), material=[0, 0.5]), "of grain 1 is no whole number"),
        (lambda: Linear.from_restitution(0.5, -1.0, 1e5), "contact.mass = -1.0 kg/m"),
        (lambda: Linear.from_restitution(0.5, 1.0, math.nan), "contact.stiffness = nan N/m"),
        (lambda: Linear.from_restitution(math.nan, 1.0, 1e5), "contact.restitution"),
        (lambda: Linear("stiff"), "contact.stiffness = 'stiff': is no number"),
        (lambda: Linear(1e5, tangential_stiffness=-1.0), "contact.tangential_stiffness = -1.0 N/m"),
        (lambda: Hertz(1e5, shear_modulus=-1.0), "contact.shear_modulus = -1.0 Pa"),
        (lambda: Hertz.of(1e7, 0.6), "contact.poisson"),
        (lambda: Hertz.of(-1e7, 0.3), "contact.young = -10000000.0 Pa"),
        (lambda: Box(0, 1), r"box.lower: has the shape \(\)"),
        (lambda: Box((0.0, 0.0), (1.0, math.nan)), "box.upper = nan m"),
        (lambda: square_lattice((0.0, 0.0), (1.0, 1.0), 0.0), "lattice.spacing = 0.0 m"),
        (lambda: square_lattice((0.0, 0.0), (1.0, 1.0), -0.1), "lattice.spacing = -0.1 m"),
        (lambda: triangular_lattice((0.0, 0.0), (1.0, 1.0), 0.0), "lattice.spacing"),
        (lambda: square_lattice((0.0, math.inf), (1.0, 1.0), 0.1), "lattice.lower"),
        (lambda: place((0.0, 0.0), (1.0, 1.0), radii=np.array([0.1]), seed=-1), "place.seed = -1: is out of range"),
        (lambda: place((0.0, 0.0), (1.0, 1.0), radii=np.array([0.1]), seed=1.5), "place.seed = 1.5: is no whole"),
        (lambda: place((0.0, 0.0), (0.0, 1.0), radii=np.array([0.1])), "upper = '.0.0, 1.0.': must lie right"),
    ],
)
def test_a_wrong_number_is_refused_by_name(make, said):
    with pytest.raises(InputError, match=said):
        make()


def test_what_physics_allows_passes():
    assert Linear.from_restitution(1.0, 1.0, 1e5).damping == 0.0
    assert Linear.from_restitution(0.0, 1.0, 1e5, release="overlap").damping > 0.0
    assert Hertz.of(1e7, 0.5).modulus > 0.0
    assert Hertz.of(1e7, -0.9).modulus > 0.0
    assert two(material=[0, 0]).material is None
    assert two().stable_step(safety=2.0) > 0.0
    two().step(np.float64(1e-5), count=np.int64(2))
    two().step(1e-5, [0.0, -9.8])


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda grains: grains.hold(2), "disc = 2: no such disc .allowed: 0 to 1"),
        (lambda grains: grains.hold(-3), "disc = -3: no such disc"),
        (lambda grains: grains.steering.servo_wall("top", stress=1.0, speed=1.0, length=-1.0), "top.servo.length = -1"),
        (lambda grains: grains.steering.servo_wall("top", stress=1.0, speed=1.0, length=math.nan), "top.servo.length"),
        (lambda _: polygon([(0.0, 0.0), (1.0, 0.0)], 0.1, 10.0), "a polygon has three corners at least"),
    ],
)
def test_what_holds_and_moves_bodies_is_refused_by_name(call, said):
    with pytest.raises(InputError, match=said):
        call(two())
    two().hold(1)
    two().steering.servo_wall("top", stress=1.0, speed=1.0, length=1.0)
    assert polygon([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)], 0.1, 10.0).closed
