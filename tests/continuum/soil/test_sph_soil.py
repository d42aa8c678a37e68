"""Soil: gradients, turning, yielding, walls and the model of a scene."""

import math

import numpy as np
import pytest

from continuum_sph.builders.parts.soil import geostatic, soil_law
from continuum_sph.builders.report import report
from continuum_sph.builders.reports.soil_report import soil_report
from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from continuum_sph.scene.soil import Body
from continuum_sph.soil import Material, porosity
from continuum_sph.soil import gradient as soil_gradient
from continuum_sph.soil import material as soil_material
from continuum_sph.soil import momentum as soil_momentum
from continuum_sph.soil import plasticity as soil_plasticity
from continuum_sph.soil import stress as soil_stress
from continuum_sph.soil.gradient import FULL, NONE, velocity_gradients
from continuum_sph.soil.momentum import Choices, accelerate
from continuum_sph.soil.plasticity import returned, strength
from continuum_sph.soil.state import MASS, VOLUME, X
from continuum_sph.soil.stress import XX, YY, Straining, deform
from continuum_sph.soil.tension import repel_under_tension
from continuum_sph.validation.soil.element import Element
from continuum_sph.validation.soil.setups import body, in_tank
from continuum_sph.validation.tanks import level_ground, tank_scene
from continuum_sph.water import bundles, smoothing
from continuum_sph.water.bundles import Neighbours
from continuum_sph.water.kernel_correction import inverse
from porescale.common.compiled.jit import set_threads
from porescale.common.core.errors import InputError, Unstable
from porescale.common.neighbors import square_lattice
from porescale.common.record.checkpoint import read_checkpoint, write_checkpoint
from porescale.common.record.model import Model
from porescale.common.schema.sections import validate
from tests.reference.continuum.uncompiled import uncompile
from tests.reference.memory import growth

ELASTIC = Material(1e7, 1600.0, yields=False)
SAND = Material(1e6, 1600.0)


def scene(**soil):
    ground = {"stiffness": 1e6, "body": [level_ground(0.4, 0.4)]}
    return tank_scene(1.0, 0.6, 0.05, 0.2, every=0.1, lid=False, soil=ground | soil)


def block():
    return body(square_lattice((-0.5, -0.3), (0.5, 0.3), 0.1), 0.1, ELASTIC, (3e3, 1e4, 2e3, 4e3))


def bits(model):
    soil = model.flow.soil
    return [soil.x.tobytes(), soil.v.tobytes(), soil.stress.tobytes(), soil.density.tobytes(), model.time]


def test_gradients_of_linear_fields_are_exact_where_neighbours_are_enough():
    flow = block()
    soil = flow.soil
    wanted = np.array([0.1, 0.4, -0.3, 0.2])
    soil.v[:] = soil.x @ wanted.reshape(2, 2).T
    soil.acceleration[:] = 0.0
    flow.begin(0.0)
    flow.strain(0.0)
    inside = np.abs(soil.x).max(axis=1) < 0.44
    # 60 particles, sums of 20 terms of order 1/spacing
    assert np.abs(soil.gradient[inside] - wanted).max() < 20 * 10 * np.finfo(float).eps


def test_plain_gradients_miss_linear_fields_at_surfaces():  # the twin that must fail
    flow = body(square_lattice((-0.5, -0.3), (0.5, 0.3), 0.1), 0.1, ELASTIC, (0.0, 0.0, 0.0, 0.0), corrected=False)
    soil = flow.soil
    soil.v[:, 0] = soil.x[:, 0]
    flow.begin(0.0)
    flow.strain(0.0)
    assert np.abs(soil.gradient[:, 0] - 1.0).max() > 0.3


def test_kernels_run_as_plain_python(monkeypatch):
    flow = block()
    soil, law = flow.soil, flow.law
    soil.v[:] = 0.01 * np.sin(soil.x)
    flow.begin(1e-4)
    kernels = velocity_gradients, deform, accelerate
    arrays = ("record", "matrix", "density", "stress", "separation_strain", "plastic_shear", "acceleration", "spread")
    first = {name: getattr(soil, name).copy() for name in arrays}
    made = (soil.force, soil.stress, soil.acceleration, soil.spread, soil.drift)
    choices = Choices(0.0, -9.8, 1.0, False, 100.0, 0.0, 4.0, np.inf, law.spacing, False)

    def found(gradients, strain, push):
        """Records after gradients, and accelerations after all three, from the same start."""
        for name, values in first.items():
            getattr(soil, name)[:] = values
        gradients(soil.soil, soil.record, soil.facing, soil.matrix, flow.near, True, 1e-4)
        record = soil.record.copy()
        strain(
            soil.density, soil.stress, soil.material, flow.table, soil.matrix, soil.spread, soil.separation_strain,
            soil.plastic_shear, np.zeros(0), soil.swelling, soil.record,
            Straining(1e-4, 1e-4, 1.0, law.most, 0.0, law.even, False, law.bearing),
        )  # fmt: skip
        push(soil.soil, soil.record, soil.facing, *made, flow.near, choices)
        return record, soil.acceleration.copy()

    record, pushed = found(*kernels)
    uncompile(
        monkeypatch, bundles, smoothing, soil_gradient, soil_material, soil_momentum, soil_plasticity, soil_stress
    )
    slow, slowly = found(*(it.py_func for it in kernels))
    # Rates of 0.1 1/s; the compiler may add in another order
    np.testing.assert_allclose(record, slow, rtol=0, atol=1e-12)
    np.testing.assert_allclose(pushed, slowly, rtol=1e-12, atol=1e-9)


def test_the_correction_is_the_inverse_where_moments_are_good_and_none_where_they_are_not():
    xx, xy, yy, rest = inverse.py_func(0.9, 0.1, 0.8, NONE, FULL)
    np.testing.assert_allclose(np.array([[xx, xy], [xy, yy]]) @ [[0.9, 0.1], [0.1, 0.8]], np.eye(2), atol=1e-14)
    assert rest == 0.0
    assert inverse.py_func(0.2, 0.0, 0.9, NONE, FULL) == (1.0, 0.0, 1.0, 1.0)


@pytest.mark.parametrize(
    ("p", "r"), [(1e4, 9e3), (1e4, 3e4), (-1e3, 2e3), (-5e3, 100.0), (-1e3, 0.0), (500.0, 900.0), (1e4, 1e3)]
)
@pytest.mark.parametrize(
    "soil", [{}, {"cohesion_intercept": 1e3}, {"cohesion_intercept": 1e3, "tension": 800.0}, {"sin_dilatancy": 0.5}]
)
@pytest.mark.parametrize("excess", [0.0, 2e3, -2e3, -2e4])
def test_stress_brought_back_lies_on_yield_or_where_it_was(p, r, soil, excess):
    material = Material(1e6, 1600.0, **soil)
    row = material.row()
    area, shear = material.area_modulus * 1e6, material.shear_modulus * 1e6
    q, s, flow, opened = returned.py_func(p, r, excess, (area, shear), 1e-4, strength(0.0, row), row)
    slack = 1e-9 * (abs(p) + r)
    more = material.sin_friction * max(excess, -max(p, 0.0))  # the mean of the surroundings pulls where p does, too
    assert 0.0 <= s <= material.sin_friction * q + material.cohesion_intercept + more + slack
    assert q - s >= -material.tension - slack
    assert flow >= 0.0
    assert opened >= 0.0
    if r <= material.sin_friction * p + material.cohesion_intercept + more and p - r >= -material.tension:
        assert (q, s, flow, opened) == (p, r, 0.0, 0.0)


def test_soil_that_came_apart_bears_nothing_until_it_has_closed():
    element = Element(SAND, (1e3, 1e3, 0.0, 600.0))
    element.take(-0.01, -0.01)
    assert element.stress[:3] == pytest.approx((0.0, 0.0, 0.0))
    opened = element.opening
    element.take(0.4 * opened, 0.4 * opened)
    assert element.stress[:3] == pytest.approx((0.0, 0.0, 0.0))
    element.take(0.2 * opened, 0.2 * opened)
    assert element.opening == 0.0
    # What is left of closing is strain: (0.8 + 0.4 - 1) of the opening
    assert element.stress[XX] == pytest.approx(SAND.area_modulus * 1e6 * 0.2 * opened, rel=1e-9)


def test_stiffness_grows_with_the_power_of_pressure():
    material = Material(1e7, 1600.0, exponent=0.5, yields=False)
    element = Element(material, (1e5, 1e5, 0.0, 6e4))
    steps, strain = 2000, 0.004
    for _ in range(steps):
        element.take(strain / steps, strain / steps)
    # dp = B0 (p/p0)^0.5 2 dε: √p grows evenly; midpoints miss the third order of a step
    exact = (math.sqrt(1e5) + 0.5 * material.area_modulus * 1e7 / math.sqrt(1e5) * 2.0 * strain) ** 2
    assert element.stress[XX] == pytest.approx(exact, rel=1.0 / steps**2)
    even = 1e5 + material.area_modulus * 1e7 * 2.0 * strain
    assert abs(even / exact - 1.0) > 10.0 / steps  # the twin that must fail: constant stiffness


def test_out_of_plane_stress_is_that_of_plane_strain():
    element = Element(SAND, (1e3, 2e3, 0.0, 900.0))
    element.take(1e-4, 3e-4, 2e-4)
    assert element.stress[3] == pytest.approx(0.6 * 0.5 * (element.stress[XX] + element.stress[YY]))


def test_grains_keep_their_volume():
    rows = np.array([Material(1e6, 1590.0, porosity=0.4).row()])
    denser = np.array([1590.0, 1590.0 * 1.1])
    assert porosity(denser, np.zeros(2, np.int64), rows) == pytest.approx([0.4, 1.0 - 0.66])


def test_walls_bear_the_weight_of_the_soil():
    x = square_lattice((0.0, 0.0), (0.5, 0.5), 0.05)
    flow = in_tank(x, geostatic(0.5 - x[:, 1], SAND), (0.5, 0.6), 0.05, SAND)
    soil, n = flow.soil, flow.soil.soil
    below = (soil.x[n:, 1] < 0.0) & (soil.x[n:, 1] > -0.05) & (np.abs(soil.x[n:, 0] - 0.25) < 0.2)
    exact = geostatic(0.5 - soil.x[n:, 1][below], SAND)
    # σ_yy by a kernel average of a linear field taken on by its weight: exact; σ_xx with the K0 of elastic soil
    np.testing.assert_allclose(soil.stress[n:][below][:, :2], exact[:, :2], rtol=1e-9)


def test_forces_of_other_layers_move_the_soil():
    flow = block()

    def lift(moving):
        moving.soil.force[:] = [0.0, 9.8] * moving.soil.mass[:, None]

    still = flow.soil.acceleration.copy()
    flow.before_force = lift
    flow.push()
    np.testing.assert_allclose(flow.soil.acceleration - still, np.tile([0.0, 9.8], (60, 1)), atol=1e-10)


def test_is_a_model():
    model = Simulation(scene())
    assert isinstance(model, Model)
    row, shot = model.series(), model.snapshot()
    assert row["mass (kg/m)"] == pytest.approx(0.16 * 1590.0)
    assert row["stress upright over weight ()"] == pytest.approx(1.0, abs=1.0 / 8**2)  # midpoints of 8 rows
    assert {"mean_stress", "plastic_strain", "displacement"} <= shot.clouds["particles"].data.keys()


@pytest.mark.parametrize("choice", [{}, {"gradient": "plain", "damping_of": "approach", "settle": 0.02}])
def test_restored_soil_goes_on_bit_for_bit(tmp_path, choice):
    straight = Simulation(scene(numerics=choice))
    straight.advance(150)
    write_checkpoint(tmp_path / "c.h5", straight.state())
    straight.advance(150)
    resumed = Simulation(scene(numerics=choice))
    resumed.restore(read_checkpoint(tmp_path / "c.h5"))
    resumed.advance(150)
    assert bits(straight) == bits(resumed)
    assert straight.flow.pairs.builds > 1


def test_one_thread_and_many_give_the_same_bits():
    found = []
    for count in (1, 2):
        set_threads(count)
        model = Simulation(scene())
        model.advance(120)
        found.append(bits(model))
    assert found[0] == found[1]


def crowd():
    """1600 particles of soil: the smallest array, one number each, is 13 kB."""
    x = square_lattice((0.0, 0.0), (0.4, 0.4), 0.01)
    return in_tank(x, geostatic(0.4 - x[:, 1], SAND), (0.5, 0.5), 0.01, SAND)


def test_no_array_is_made_in_a_step():
    flow = crowd()
    builds = flow.pairs.builds
    # What Python itself needs for its calls stays below 4 kB.
    assert growth(flow.advance, steps=10) < 4096
    assert flow.pairs.builds == builds  # a rebuild may make room for more pairs


def test_an_array_in_a_step_would_be_noticed():  # the twin that must fail
    flow = crowd()

    def step_and_copy():
        flow.advance()
        flow.soil.density.copy()

    assert growth(step_and_copy, steps=10) > 8192


def test_soil_beyond_sense_is_said_to_be_unstable():
    model = Simulation(scene())
    model.check()
    model.flow.soil.v[3] = 1e3, 0.0
    with pytest.raises(Unstable, match="speed"):
        model.check()


def test_a_report_says_what_the_soil_can_bear():
    text = str(soil_report(scene()))
    assert "soil particles" in text
    soft = soil_report(scene(stiffness=1e4))
    assert any("soil.stiffness" in warning for warning in soft.warnings)


@pytest.mark.parametrize("cohesion", [0.0, 1000.0])
def test_a_stress_at_rest_beyond_the_strength_is_warned_of(cohesion):
    given = scene(cohesion=cohesion)
    sine = math.sin(given.soil.friction_angle)
    weight = given.soil.density * given.gravity * given.soil.height
    # Mohr-Coulomb for stresses w and K w: (K - 1) w = (K + 1) w sin phi + 2 c cos phi
    held = 2.0 * cohesion * math.cos(given.soil.friction_angle) / weight
    most, least = (1.0 + sine + held) / (1.0 - sine), (1.0 - sine - held) / (1.0 + sine)

    def warned(rest):
        report = soil_report(scene(cohesion=cohesion, rest=rest))
        return any(it.startswith("soil.rest = ") for it in report.warnings)

    assert not warned(0.99 * most)
    assert warned(1.01 * most)
    assert not warned(max(0.0, 1.01 * least))
    assert warned(0.99 * least) == (least > 0.0)


def test_motion_that_is_braked_to_the_end_is_warned_of():
    for settle, said in ((0.2, 1), (0.19, 0)):  # of 0.2 s
        assert sum("is braked" in it for it in report(scene(numerics={"settle": settle})).warnings) == said


@pytest.mark.parametrize(
    ("soil", "key"),
    [
        ({"body": [{"outline": [[0, 0], [2, 0], [2, 0.4]]}]}, "soil.body[0].outline"),
        ({"body": [{"outline": [[0, 0], [0.4, 0.4]]}]}, "soil.body[0].outline"),
        ({"dilatancy_angle": "31 degree"}, "soil.dilatancy_angle"),
        ({"cohesion": 100.0, "tension": 200.0}, "soil.tension"),
        ({"rest": 0.5, "stress": "none"}, "soil.rest"),
    ],
)
def test_ground_that_cannot_be_is_refused(soil, key):
    with pytest.raises(InputError) as refused:
        scene(**soil)
    assert key in {fault.key for fault in refused.value.faults}


def test_a_tank_with_nothing_in_it_is_refused():
    table = scene().model_dump()
    table["soil"] = None
    with pytest.raises(InputError) as refused:
        validate(Scene, table)
    assert [fault.key for fault in refused.value.faults] == ["water.column"]


def test_outlines_hold_what_is_inside_and_know_their_top():
    slope = Body(outline=((0.0, 0.0), (2.0, 0.0), (1.0, 1.0), (0.0, 1.0)))
    points = np.array([[0.5, 0.5], [1.5, 0.4], [1.5, 0.6], [-0.1, 0.5], [0.5, 1.1]])
    assert slope.holds(points).tolist() == [True, True, False, False, False]
    assert slope.top(np.array([0.5, 1.5, 3.0])).tolist() == [1.0, 0.5, -np.inf]


def test_a_bank_and_its_mirror_image_have_mirrored_particles():
    """Slopes of 1 : 1 run through centres of the lattice: those of left sides were ground, those of right sides not,
    and round-off took some of either."""
    tank, spacing = 1.6, 0.025
    bank = [(0.2, 0.0), (0.5, 0.3), (0.7, 0.3), (1.0, 0.0)]
    at = (np.arange(round(tank / spacing)) + 0.5) * spacing
    points = np.stack(np.meshgrid(at, at), -1).reshape(-1, 2)

    def places(outline):
        held = points[Body(outline=tuple(outline)).holds(points)]
        return {(round(x / spacing - 0.5), round(y / spacing - 0.5)) for x, y in held.tolist()}

    there = places(bank)
    last = len(at) - 1
    assert {(last - i, j) for i, j in places([(tank - x, y) for x, y in reversed(bank)])} == there
    assert len(there) == sum(32 - 2 * k for k in range(12))  # centres from 0.2 + y to 1 - y, both ends counted
    # the check that must fail: a tenth of a spacing to the right the left slope has lost its row
    assert len(places([(x + 0.1 * spacing, y) for x, y in bank])) == len(there) - 12


def pair(apart, pull):
    """Acceleration of two particles, ``apart`` of a spacing from each other, of soil under a tension ``pull``, Pa."""
    record = np.zeros((2, 16))
    record[:, X], record[:, VOLUME], record[:, MASS] = [0.0, 0.1 * apart], 0.01, 16.0
    stress = np.tile([0.0, -pull, 0.0, 0.0], (2, 1))
    acceleration = np.zeros((2, 2))
    start, split, partner = np.array([0, 1, 2]), np.array([1, 2]), np.array([1, 0])
    near = Neighbours(start, split, partner, None, None, 1, 0.13)
    repel_under_tension.py_func(2, record, stress, acceleration, near, 0.1, 10.0)
    return acceleration


def test_soil_under_tension_pushes_apart_what_comes_near_and_nothing_else():
    near = pair(0.9, 100.0)
    assert near[0, 0] < 0.0
    assert near[0].tolist() == (-near[1]).tolist()
    assert not pair(1.0, 100.0).any()
    assert not pair(0.9, -100.0).any()
    assert pair(0.8, 100.0)[0, 0] < near[0, 0]


def test_soil_without_cohesion_has_no_tension_to_hold():
    assert not in_tank(np.array([[0.05, 0.05]]), np.zeros((1, 4)), (0.2, 0.2), 0.1, SAND).pulling
    clay = Material(1e6, 1600.0, cohesion_intercept=1e3, tension=500.0)
    assert in_tank(np.array([[0.05, 0.05]]), np.zeros((1, 4)), (0.2, 0.2), 0.1, clay).pulling


def test_damping_given_as_a_viscosity_is_the_same_at_any_stiffness_and_spacing():
    given = {"damping_viscosity": 0.05}
    for stiffness in (1e6, 4e6):
        law = soil_law(scene(stiffness=stiffness, numerics=given))
        sound = math.sqrt(law.materials[0].column_modulus / law.materials[0].density)
        assert law.damping * sound * law.smoothing.length == pytest.approx(0.05, rel=1e-14)
