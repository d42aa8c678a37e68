"""What scenes say of contacts, materials, energy, clumps, controls, walls and cells: in the grains, or refused."""

import math
from typing import Any

import numpy as np
import pytest

from porescale import Scene
from porescale.builders.build import build
from porescale.builders.derive import derive
from porescale.common.core.constants import GRAVITY
from porescale.common.schema.sections import scene_as_dict, validate
from porescale.dem.contact.hertz import Hertz
from porescale.dem.contact.law import CR, KN, KR, MU, MUR
from porescale.dem.contact.linear import Linear, LinearKernel
from tests.reference.scenes import column, dry, grain
from tests.reference.scenes_of_grains import assert_same_bits, lines, loose, resumed


def test_the_card_of_a_scene_makes_the_same_scene():
    scene = loose(grain(0.002, 0.002), output__energy=True)
    assert validate(Scene, scene_as_dict(scene)) == scene


# -- energy


def test_no_book_is_kept_unless_asked():
    simulation = build(loose(grain(0.002, 0.002)))
    assert simulation.grains.budget is None
    assert "residual (J/m)" not in simulation.series()


def fallen(step: float) -> dict[str, float]:
    """The series after some bounces of a grain that falls by 1.5 mm, with a contact step in s."""
    simulation = build(loose(grain(0.002, 0.002), output__energy=True, contact__step=step))
    simulation.advance(round(0.05 / simulation.step_seconds))
    return simulation.series()


def test_the_energy_of_a_falling_grain_is_its_weight_times_its_height():
    weight = 2500 * math.pi * 0.0005**2 * GRAVITY
    first = build(loose(grain(0.002, 0.002), output__energy=True)).series()
    assert first["potential energy (J/m)"] == pytest.approx(weight * 0.002, rel=1e-12)
    row, coarse = fallen(5e-6), fallen(2e-5)
    assert list(row)[-1] == "residual (J/m)"
    assert row["lost in normal dashpots (J/m)"] > 0.1 * weight * 0.0015  # 1 - e^2 = 0.19 a bounce
    # The residual is of first order in the step: four times less at least, and 1e-3 of what was turned over (the bound
    # of the specification) with some 40 steps in a contact; 10 steps in a contact miss it.
    assert abs(row["residual (J/m)"]) < 1e-3 * row["turned over (J/m)"] < abs(coarse["residual (J/m)"])
    assert abs(row["residual (J/m)"]) < 0.25 * abs(coarse["residual (J/m)"])


def test_a_run_with_an_energy_book_is_taken_up_again_to_the_bit():
    assert_same_bits(*resumed(dry(output__energy=True), 150, 150))


def test_energy_needs_grains():
    (line,) = lines(grains=None, contact=None, disc=[grain(0.002, 0.002)], output__energy=True,
                    fluid={"viscosity": 2e-5, "spacing": 0.0002, "step": 4e-5})  # fmt: skip
    assert line.startswith("output.energy: there are no grains to measure")


# -- contact and materials

ROLLS = {"rolling_friction": 0.1, "rolling_stiffness": 2e4, "rolling_damping": 0.01}
HERTZ = {"law": "hertz", "young": 1e9, "poisson": 0.25, "restitution": 0.7, "friction": 0.4, "rolling_friction": 0.1}
SLIDES = {"friction": 0.5, "tangential_stiffness": 1e5}
SAND, STEEL = {"name": "sand"}, {"name": "steel", "density": 7800, "stiffness": 6e5, "friction": 0.2}


def test_one_plain_law_has_neither_materials_nor_rolling():
    grains = build(dry()).grains
    assert grains.material is None
    assert grains.pairs.carried.shape[1] == 1
    assert isinstance(grains.contact, LinearKernel)
    assert grains.contact.rolling is None


def test_rolling_resistance_arrives_in_the_kernels_table():
    grains = build(loose(grain(0.002, 0.002), **{f"contact__{key}": value for key, value in ROLLS.items()})).grains
    row = grains.contact.table[0, 0]
    assert (row[KR], row[CR], row[MUR]) == (2e4, 0.01, 0.1)
    np.testing.assert_array_equal(grains.wall_laws[2, 0], row)
    assert grains.pairs.carried.shape[1] == 2


def test_the_law_of_hertz_is_that_of_its_elastic_constants():
    law = build(loose(grain(0.002, 0.002), contact=HERTZ)).grains.laws[0]
    assert law == Hertz.of(1e9, 0.25, 0.7, 0.4, "force", 0.1)


def bounce(**contact: Any) -> float:
    """Parting over approach speed of a grain that flies against the wall without gravity."""
    flying = grain(0.00051, 0.002, velocity=[-0.1, 0.0])
    simulation = build(loose(flying, gravity=[0.0, 0.0], contact=contact))
    simulation.advance(round(4e-3 / simulation.step_seconds))
    return float(simulation.grains.discs.velocity[0, 0]) / 0.1


def test_a_given_restitution_is_that_of_the_impact():
    # First order in the step: 1e-3 at a thousand steps in a contact, whatever its phase (the specification); these laws
    # touch for 0.2 ms (hertz) and, at m k = 2 e-3 kg 2e5 N/m, for 0.3 ms, here 300 steps and more: 3.3e-3.
    assert bounce(**{**HERTZ, "step": 5e-7}) == pytest.approx(0.7, abs=3.3e-3)
    # The restitution of [contact] is that of two grains, m/2; a wall sees m, and the same dashpot damps it less.
    law = Linear.from_restitution(0.7, 2500 * math.pi * 0.0005**2 / 2, 2e5)
    wanted = law.restitution(2500 * math.pi * 0.0005**2)
    assert bounce(stiffness=2e5, restitution=0.7, step=5e-7) == pytest.approx(wanted, abs=3.3e-3)
    assert wanted > 0.75  # the twin: it is not 0.7


def two_materials(**more: Any) -> Scene:
    pair = {"materials": ["steel", "sand"], "friction": 0.05, "stiffness": 1e5}
    return loose(
        grain(0.002, 0.002), grain(0.004, 0.002, material="steel"), material=[SAND, STEEL],
        disc=[grain(0.006, 0.002)],
        **{"contact__wall_material": "steel", "contact__pair": [pair], **more},
    )  # fmt: skip


def test_materials_arrive_as_numbers_masses_and_laws():
    grains = build(two_materials()).grains
    assert grains.material.tolist() == [0, 1, 1]  # a held disc is of the walls' material
    np.testing.assert_allclose(grains.discs.mass[:2], np.array([2500, 7800]) * math.pi * 0.0005**2, rtol=1e-15)
    table = grains.contact.table
    assert (table[0, 0, KN], table[0, 0, MU]) == (2e5, 0.5)
    assert (table[1, 1, KN], table[1, 1, MU]) == (6e5, 0.2)
    assert (table[0, 1, KN], table[0, 1, MU]) == (1e5, 0.05)
    np.testing.assert_array_equal(table[0, 1], table[1, 0])
    np.testing.assert_array_equal(grains.wall_laws[0], table[1])  # steel against each


def test_without_a_pair_of_its_own_the_mixing_rule_holds():
    table = build(two_materials(contact__pair=[])).grains.contact.table
    assert table[0, 1, KN] == pytest.approx(2 * 2e5 * 6e5 / 8e5, rel=1e-15)
    assert table[0, 1, MU] == 0.2


def test_a_settled_packing_of_a_material_rests_on_walls_of_another():
    scene = dry(
        grains__packing__settle=True, gate={"x": 0.008, "opens_at": 1}, material=[SAND, STEEL],
        grains__packing__material="steel", contact__wall_material="sand",
        **{f"contact__{key}": value for key, value in ROLLS.items()},
    )  # fmt: skip
    grains = build(scene).grains
    assert set(grains.material.tolist()) == {1}
    weight = float(np.sum(grains.discs.mass)) * GRAVITY
    simulation = build(scene)
    simulation.advance(20)
    # At rest is a net force below the balance that settling asks for; friction of the side and the gate carries a part.
    held = -float(simulation.grains.wall_force[:, 1].sum() + simulation.grains.plate_force[:, 1].sum())
    assert held == pytest.approx(weight, rel=1e-2)


@pytest.mark.parametrize(
    ("contact", "energy"), [(HERTZ, False), ({**ROLLS, "stiffness": 2e5, "restitution": 0.9, **SLIDES}, True)]
)
def test_a_run_with_another_law_is_taken_up_again_to_the_bit(contact, energy):
    assert_same_bits(*resumed(dry(contact=contact, output__energy=energy), 150, 150))


def test_a_packing_settles_under_the_law_of_hertz():
    simulation = build(dry(grains__packing__settle=True, contact=HERTZ, gate={"x": 0.008, "opens_at": 1}))
    simulation.advance(50)
    assert simulation.series()["largest grain speed (m/s)"] < 1e-3  # sqrt(1e-8 g d) a grain at rest, less for most


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"contact__young": 1e9}, 'contact.young = 1000000000.0: belongs to law = "hertz", this is "linear"'),
        ({"contact__law": "hertz"}, 'contact.stiffness = 200000.0: belongs to law = "linear", this is "hertz"'),
        ({"contact": {"law": "hertz", "restitution": 0.5}}, "contact.young: is missing"),
        ({"contact__stiffness": None}, "contact.stiffness: is missing"),
        ({"contact__rolling_friction": 0.1}, "contact.rolling_stiffness: is needed"),
        ({"contact__rolling_stiffness": 1e4}, "contact.rolling_friction: is needed"),
        ({"material": [SAND, SAND]}, "material[1].name = 'sand': is taken"),
        ({"material": [SAND], "contact__wall_material": "sad"}, "contact.wall_material = 'sad': no such material"),
        ({"material": [SAND], "contact__wall_friction": 0.1}, "contact.wall_friction = 0.1: friction at walls follows"),
        ({"material": [{**SAND, "damping": 1.0, "restitution": 0.5}]}, "material[0].damping, restitution: exactly one"),
        ({"contact__pair": [{"materials": ["sand", "sand"]}]}, "contact.pair[0].materials = 'sand': no such material"),
        ({"grains__grain": [grain(0.002, 0.002, material="ice")]}, "grains.grain[0].material = 'ice': no such"),
        ({"contact": HERTZ, "grains__packing": {"left": 0.0, "width": 0.012, "height": 0.008, "diameter": 0.001,
                                                "pressure": 100.0}}, "contact.law = 'hertz': packings are compressed"),
    ],
)  # fmt: skip
def test_contacts_that_make_no_sense_are_refused(changes, line):
    assert lines(**changes)[0].startswith(line)


# -- clumps and controls

PAIR = {"discs": [[-0.0004, 0.0, 0.0005], [0.0004, 0.0, 0.0005]], "at": [[0.003, 0.002], [0.006, 0.004]]}


def clumped(*sections: dict[str, Any], **changes: Any) -> Scene:
    return dry(**{"grains": {"density": 2500}, "clump": list(sections), **changes})


def test_no_clump_and_no_control_leave_the_grains_without_steering():
    assert not build(dry()).grains.steered


def test_a_clump_has_the_mass_of_its_union_and_its_motion():
    scene = clumped(
        {**PAIR, "angle": [0.0, math.pi / 2], "velocity": [0.1, 0.2], "spin": 30.0, "density": 2000},
        grains__grain=[grain(0.009, 0.002)],
    )  # fmt: skip
    grains = build(scene).grains
    clumps = grains.steering.clumps
    half = math.acos(0.8)  # the lens of two discs of radius r at 1.6 r: 2 r^2 (a - sin a cos a)
    area = 0.0005**2 * (2 * math.pi - 2 * (half - 0.8 * math.sin(half)))
    np.testing.assert_allclose(clumps.mass, 2000 * area, rtol=1e-12)
    assert clumps.discs_of(0).tolist() == [1, 2]  # after the grain
    np.testing.assert_allclose(clumps.position, PAIR["at"], rtol=1e-12)
    np.testing.assert_allclose(grains.discs.position[3:], [[0.006, 0.0036], [0.006, 0.0044]], rtol=1e-12)
    np.testing.assert_array_equal(clumps.velocity, [[0.1, 0.2]] * 2)
    assert clumps.spin.tolist() == [30.0, 30.0]
    np.testing.assert_allclose(grains.discs.velocity[1:3], [[0.1, 0.188], [0.1, 0.212]], rtol=1e-12)


def test_a_clump_may_have_mass_and_inertia_by_hand():
    clumps = build(clumped({**PAIR, "mass": 0.01, "inertia": 4e-9})).grains.steering.clumps
    assert clumps.mass.tolist() == [0.01, 0.01]
    assert clumps.inertia.tolist() == [4e-9, 4e-9]


def test_a_clump_rolls_down_a_slope_as_its_inertia_says():
    # A round body with mass in its rim rolls at a = g sin/(1 + I/(m r^2)).
    body = {"discs": [[0, 0, 0.0005]], "at": [[0.002, 0.00049995]], "mass": 0.002, "inertia": 4e-10}  # fmt: skip
    tilt, g = 0.2, 9.81
    simulation = build(clumped(body, gravity=[g * math.sin(tilt), -g * math.cos(tilt)], contact__friction=1.0))
    simulation.advance(round(0.02 / simulation.step_seconds))
    wanted = g * math.sin(tilt) / (1 + 4e-10 / (0.002 * 0.0005**2)) * simulation.time
    clumps = simulation.grains.steering.clumps
    # It starts with an overlap of m g/k = 1e-7 m to within 5e-8 m: a lever arm of 1e-4 and a bounce as small; the
    # tangential spring winds up over its period, 2 pi sqrt(m/k_t) = 1 ms of 20: 1 % at most.
    assert clumps.velocity[0, 0] == pytest.approx(wanted, rel=1e-2)
    assert clumps.spin[0] == pytest.approx(-wanted / 0.0005, rel=1e-2)
    assert wanted < 0.6 * g * math.sin(tilt) * simulation.time  # the twin: it does not slide


DROP = {"x": {"displacement": [[0, 0], [0.01, "0.5 mm"]]}, "y": {"force": 0.02}, "record": True}


def test_controls_move_and_push_and_are_recorded():
    scene = loose(
        grain(0.002, 0.002), grain(0.005, 0.004), gravity=[0.0, 0.0],
        control=[{"grain": 0, **DROP}, {"grain": 1, "rotation": {"velocity": {"amplitude": 5.0, "frequency": 25.0}}}],
    )  # fmt: skip
    simulation = build(scene)
    assert set(simulation.tables()) == {"control"}
    steps = round(0.01 / simulation.step_seconds)
    simulation.advance(steps)
    row, time, discs = simulation.tables()["control"], simulation.time, simulation.grains.discs
    mass = discs.mass[0]
    assert row["time (s)"] == time
    assert row["grain 0 displacement x (m)"] == pytest.approx(min(0.05 * time, 0.0005), rel=1e-9)
    # Leap-frog from rest under a constant force: x_n = F dt^2 n (n + 1)/(2 m), to round-off.
    fallen_by = 0.02 * simulation.step_seconds**2 * steps * (steps + 1) / (2 * mass)
    assert row["grain 0 displacement y (m)"] == pytest.approx(fallen_by, rel=1e-9)
    assert row["grain 0 control force y (N/m)"] == pytest.approx(0.02, rel=1e-12)
    assert row["grain 0 contact force y (N/m)"] == 0.0
    assert not any(name.startswith("grain 1") for name in row)
    assert discs.spin[1] == pytest.approx(5 * math.sin(50 * math.pi * (time - simulation.step_seconds / 2)), rel=1e-9)


def test_a_clump_is_controlled_and_meets_what_it_pushes():
    # Two discs side by side, held against turning, press a grain into the floor by 10 um at a constant speed.
    scene = clumped(
        {**PAIR, "at": [[0.003, 0.0015]]}, grains__grain=[grain(0.0034, 0.0005)], gravity=[0.0, 0.0],
        contact__stiffness=1e5, contact__friction=0.0, contact__tangential_stiffness=0.0,
        control=[{"clump": 0, "name": "stamp", "x": {"velocity": 0}, "y": {"displacement": [[0, 0], [0.01, -1e-5]]},
                  "rotation": {"displacement": 0}, "record": True}],
    )  # fmt: skip
    simulation = build(scene)
    simulation.advance(round(0.02 / simulation.step_seconds))
    row = simulation.tables()["control"]
    # Two like springs in a row, k/2 times 10 um; waves have died down: e = 0.9 a period of 0.5 ms, over 20 periods.
    assert row["stamp contact force y (N/m)"] == pytest.approx(0.5e5 * 1e-5, rel=0.9**20)
    assert row["stamp control force y (N/m)"] == pytest.approx(-row["stamp contact force y (N/m)"], rel=1e-9)


def test_the_energy_book_knows_clumps_and_controls():
    def residual(step: float) -> float:
        scene = clumped(
            {**PAIR, "spin": 20.0}, grains__grain=[grain(0.003, 0.0033)], output__energy=True, contact__step=step,
            control=[{"clump": 1, "x": {"velocity": 0.05}}, {"grain": 0, "rotation": {"force": 1e-5}}],
        )  # fmt: skip
        simulation = build(scene)
        simulation.advance(round(0.03 / simulation.step_seconds))
        row = simulation.series()
        return abs(row["residual (J/m)"]) / row["turned over (J/m)"]

    # First order in the step; 1e-3 (the specification's bound) at some 40 steps in a contact.
    assert residual(5e-6) < 1e-3


def test_clumps_and_controls_are_taken_up_again_to_the_bit():
    scene = clumped(
        {**PAIR, "at": [[0.003, 0.0006], [0.003, 0.0018]], "spin": 20.0}, output__energy=True,
        control=[{"clump": 1, "x": {"velocity": {"amplitude": 0.1, "frequency": 50}}, "record": True}],
    )  # fmt: skip
    assert_same_bits(*resumed(scene, 400, 400))
    assert validate(Scene, scene_as_dict(scene)) == scene


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"clump": [{**PAIR, "discs": []}]}, "clump[0].discs: holds none"),
        ({"clump": [{**PAIR, "discs": [[0, 0, -1e-3]]}]}, "clump[0].discs[0] = -0.001 m: has no radius"),
        ({"clump": [{**PAIR, "mass": 1.0}]}, "clump[0].inertia: is needed with the other"),
        ({"clump": [{**PAIR, "angle": [1.0]}]}, "clump[0].angle = 1: are not as many as bodies"),
        ({"clump": [{**PAIR, "mass": 1.0, "inertia": 1e-12}]}, "clump[0].inertia = 1e-12 kg m^2/m"),
        ({"clump": [{**PAIR, "at": [[0.0, 0.002]]}]}, "clump[0] = '(-0.0004, 0.002)': reaches out of the box"),
        ({"clump": [{**PAIR, "at": [[0.0026, 0.002]]}]}, "clump[0]: overlaps grain 0"),
        ({"clump": [{**PAIR, "material": "ice"}]}, "clump[0].material = 'ice': no such material"),
        ({"control": [{"x": "free"}]}, "control[0].grain, clump, segment, polygon: exactly one of them is needed"),
        ({"control": [{"grain": 1}]}, "control[0].grain = 1: there is no such grain"),
        ({"control": [{"clump": 0}]}, "control[0].clump = 0: there is no such clump"),
        ({"control": [{"grain": 0}, {"grain": 0}]}, "control[1].grain = 0: is controlled twice"),
        ({"control": [{"grain": 0, "x": "held"}]}, "control[0].x = 'held': unknown choice"),
        ({"control": [{"grain": 0, "x": {"velocity": 1, "force": 1}}]}, "control[0].x.force: and velocity cannot both"),
        ({"control": [{"grain": 0, "x": {"velocity": [[1, 0], [0, 1]]}}]}, "control[0].x.velocity.times: must ascend"),
        ({"control": [{"grain": 0, "x": {"velocity": "1 m"}}]}, "control[0].x.velocity = '1 m'"),
        ({"control": [{"grain": 0, "x": {"velocity": {"amplitude": 1}}}]}, "control[0].x.velocity.frequency = 0:"),
        ({"grains": None, "contact": None, "clump": [PAIR], "disc": [grain(0.009, 0.002)]}, "fluid, grains: nothing"),
    ],
)  # fmt: skip
def test_bodies_that_make_no_sense_are_refused(changes, line):
    assert lines(**changes)[0].startswith(line)


WATER = {"viscosity": 2e-5, "spacing": 0.0002, "step": 4e-5}
LEVEL = {**PAIR, "at": [[0.006, 0.005]], "velocity": [0.0, 0.0], "spin": 0.0, "angle": [0.0]}


def wet(**changes: Any) -> Scene:
    """A clump of two discs alone in water."""
    grains = {"density": 2500, "hydraulic_radius_ratio": 1.0}
    return column(**{"gate": None, "grains": grains, "fluid": WATER, "clump": [LEVEL], **changes})


def test_a_clump_as_heavy_as_water_floats_and_a_heavier_one_sinks_with_what_it_weighs_there():
    floating = build(wet(clump=[{**LEVEL, "density": 1000}], grains__density=1000))
    heavy = build(wet())
    # Early on the fluid around goes with it as with a disc, which moves as much as it displaces, and so does a layer as
    # thick as momentum has gone, sqrt(nu t) = 0.11 mm of 0.5 mm: a = (s - 1) g/(s + (1 + sqrt(nu t)/R)^2).  Two discs
    # side by side differ from one by a tenth in what they move with them.
    for simulation in (floating, heavy):
        simulation.advance(15)
    clumps = heavy.grains.steering.clumps
    assert np.abs(floating.grains.steering.clumps.velocity).max() < 1e-9
    layer = 1.0 + math.sqrt(2e-5 * heavy.time) / 0.0005
    assert clumps.velocity[0, 1] == pytest.approx(-1.5 / (2.5 + layer**2) * GRAVITY * heavy.time, rel=0.1)
    assert abs(clumps.velocity[0, 0]) < 1e-3 * abs(clumps.velocity[0, 1])
    displaced = heavy.coupled.inner_mass.sum()
    assert displaced == pytest.approx(1000 * clumps.area[0], rel=1e-12)
    assert displaced < 0.95 * 1000 * heavy.grains.discs.area.sum()  # the twin: discs counted one by one


@pytest.mark.parametrize("operator", ["trt", "central"])
def test_a_wet_clump_is_taken_up_again_to_the_bit(operator):
    assert_same_bits(*resumed(wet(fluid={**WATER, "operator": operator}, lubrication={"gap": 0.5}), 15, 15))


def test_a_clump_lighter_than_lasts_is_warned_of():
    assert not any("density ratio" in line for line in derive(wet()).warnings)
    assert any("density ratio 0.05" in line for line in derive(wet(clump=[{**LEVEL, "density": 50}])).warnings)


def test_a_controlled_grain_in_water_is_a_towed_disc():
    told = {"x": {"velocity": 0.02}, "y": {"velocity": 0.0}, "rotation": {"velocity": 5.0}, "record": True}
    here, other = grain(0.004, 0.004, velocity=[0.02, 0.0], spin=5.0), grain(0.010, 0.002)
    grains = {"density": 2500, "hydraulic_radius_ratio": 1.0, "grain": [here, other]}
    moved = build(wet(clump=None, grains=grains, control=[{"grain": 0, **told}]))
    towed = build(wet(clump=None, grains={**grains, "grain": [other]}, disc=[here]))
    free = build(wet(clump=None, grains=grains))
    for simulation in (moved, towed, free):
        simulation.advance(40)
    assert moved.grains.discs.position[0].tolist() == pytest.approx(towed.grains.discs.position[1].tolist(), rel=1e-13)
    moving, tow, fall = (np.stack(simulation.fields()[1:3]) for simulation in (moved, towed, free))
    # Bodies in another order: round-off of 40 steps of speeds of 0.02 m/s, in units of a lattice of 5 m/s.
    assert np.abs(moving - tow).max() < 40 * 2.3e-16 * 5
    assert np.abs(fall - tow).max() > 1e-4  # the twin that must fail: a grain that nobody tows
    assert moved.coupled.fluid_force[0].tolist() == pytest.approx(towed.coupled.fluid_force[1].tolist(), rel=1e-9)
    # Nothing else touches it: what the control gives is what the fluid and its weight take.
    assert moved.coupled.fluid_force[0, 0] < 0.0
    given = moved.tables()["control"]["grain 0 control force x (N/m)"]
    assert given == pytest.approx(-moved.coupled.force[0, 0], rel=1e-6)


def test_controls_in_water_count_for_the_mach_number_and_are_taken_up_again_to_the_bit():
    swing = {"x": {"displacement": {"amplitude": "1 mm", "frequency": 50}}, "y": {"force": 0.01}, "record": True}
    scene = wet(control=[{"clump": 0, **swing}])
    assert derive(scene).speed >= 2 * math.pi * 50 * 1e-3
    assert_same_bits(*resumed(scene, 15, 15))
