"""Two fluids in one layer: surface tension, density ratios, scenes with an inclusion."""

import numpy as np
import pytest

from continuum_sph.builders.parts.inclusion import inclusion_row, pieces
from continuum_sph.builders.report import report
from continuum_sph.builders.sanity_fluids import bounds
from continuum_sph.builders.simulation import Simulation
from continuum_sph.program import scene_type
from continuum_sph.validation.water import fluids as trials_fluids
from continuum_sph.validation.water.fluids import TENSION
from continuum_sph.water.energy_budget import budget
from continuum_sph.water.smoothing import RATIO
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import validate


def scene(walls="slip", numerics=None, **inclusion):
    """A disc of 0.2 m in a closed box of 1 m full of water."""
    return validate(
        scene_type(),
        {
            "tank": {"width": 1.0, "height": 1.0, "walls": walls},
            "water": {"sound_speed": 20.0, "column": [{"width": 1.0, "height": 1.0}]},
            "inclusion": {"law": "liquid", "density": 100.0, "disc": [{"x": 0.5, "y": 0.4, "radius": 0.2}]} | inclusion,
            "numerics": {"spacing": 0.05, "gradient": "corrected", "shifting": 2.0} | (numerics or {}),
            "time": {"end": 1.0},
            "output": {"snapshot_interval": 0.1, "series_interval": 0.1, "energy": True},
        },
    )


def test_an_interface_is_drawn_inwards_by_as_much_as_sigma_over_r():
    flow = trials_fluids.drop(40, 0.25)
    layer = flow.layer
    layer.acceleration[:] = 0.0
    flow.pull()
    out = layer.x - 0.5
    r = np.hypot(out[:, 0], out[:, 1])
    force = (layer.acceleration * out).sum(axis=1) / r * layer.mass
    assert force.sum() / (2.0 * np.pi) == pytest.approx(
        -TENSION, rel=0.05
    )  # ∫ F r dr = σ but for the staircase's steps
    assert np.abs(force[np.abs(r - 0.25) > 4.0 / 40]).max() == 0.0


def test_a_straight_interface_is_not_drawn():
    flow = trials_fluids.drop(20, 0.25)
    layer = flow.layer
    layer.material[:] = (layer.x[:, 0] > 0.25) & (layer.x[:, 0] < 0.75)
    layer.acceleration[:] = 0.0
    flow.pull()
    assert np.abs(layer.acceleration).max() < 1e-9 * TENSION * 20**2 / 0.1  # round-off of σ/(ρ dx²)
    assert flow.normal[:, 2].max() > 0.2 / (1.3 / 20)


def test_tension_swaps_sides_with_the_numbers_of_the_fluids():
    flow = trials_fluids.drop(20, 0.25)
    found = []
    for _ in range(2):
        flow.layer.acceleration[:] = 0.0
        flow.pull()
        found.append(flow.layer.acceleration.copy())
        flow.layer.material[:] = 1 - flow.layer.material
    np.testing.assert_allclose(found[0], found[1], rtol=1e-9, atol=1e-9 * np.abs(found[0]).max())


def test_the_budget_of_a_drop_at_rest_closes_with_the_work_of_its_tension():
    flow = trials_fluids.drop(20, 0.25, stretch=1.2)
    flow.layer.keep_budget()
    first = budget(flow)
    for _ in range(200):
        flow.advance()
    last = budget(flow)
    moved = abs(last["work of surface tension"])
    assert moved > 0.1 * last["kinetic energy"] > 0.0
    # steps miss (Δt c/h)²/2 = 3 % of what is turned over; shifting moves 2 % of the energy with its particles
    turned = moved + last["heat of viscosity"] + abs(last["compressive energy"] - first["compressive energy"])
    assert abs(last["energy balance"] - first["energy balance"]) < 0.05 * turned


def test_a_light_bubble_rises_and_a_heavy_drop_sinks():
    for density, way in ((100.0, 1.0), (2000.0, -1.0)):
        model = Simulation(scene(density=density, viscosity=1.0))
        start = model.series()
        model.advance(400)
        model.check()
        now = model.series()
        assert way * now["bubble rise (m/s)"] > 0.05
        assert way * (now["bubble centre (m)"] - start["bubble centre (m)"]) > 0.0
        # volume: pressures of ρ g H compress by g H/c² = 2.5 %
        assert now["bubble area (m2)"] == pytest.approx(start["bubble area (m2)"], rel=0.025)


@pytest.mark.parametrize("law", ["adiabatic", "printed"])
def test_a_thousandfold_lighter_gas_stays_a_bubble_for_a_while(law):
    model = Simulation(scene(law=law, density=1.0, pressure=1e5, numerics={"artificial_viscosity": 0.1}))
    start = model.series()
    model.advance(1500)
    model.check()
    row = model.series()
    assert row["bubble pieces ()"] == 1.0
    assert row["bubble centre (m)"] > start["bubble centre (m)"]
    # Nothing is made of nothing: steps miss (Δt c/h)²/2 = 3 % of what is turned over, here of a hundredth of all
    assert abs(row["energy balance (J/m)"] / start["energy balance (J/m)"] - 1.0) < 0.01


def test_the_step_knows_of_gas_that_moves_against_the_stiffness_of_water():
    model = Simulation(scene(law="adiabatic", density=1.0, pressure=1e5, numerics={"artificial_viscosity": 0.1}))
    law = model.flow.law
    assert law.interface_speed > 1.3 * law.quickest
    assert law.interface_speed == pytest.approx(((1.403e5 + 1000.0 * 400.0) / 2.0) ** 0.5)


def test_what_is_said_of_a_bubble_is_true_of_a_disc_and_of_two():
    flow = Simulation(scene(numerics={"spacing": 0.02}, surface_tension=1.0)).flow
    said = inclusion_row(flow)
    assert said["bubble centre x (m)"] == pytest.approx(0.5, abs=1e-9)
    assert said["bubble centre (m)"] == pytest.approx(0.4, abs=1e-3)
    assert said["bubble area (m2)"] == pytest.approx(np.pi * 0.04, rel=0.02)  # a quarter spacing of 10 in R, on a side
    assert said["bubble circularity ()"] == pytest.approx(1.0, abs=0.02)
    x = flow.layer.x[: flow.layer.fluid][flow.layer.material[: flow.layer.fluid] == 1]
    assert pieces(np.concatenate((x, x + np.array([0.6, 0.0]), [[2.0, 2.0]])), 0.02) == 2  # a stray one does not count


def test_floor_and_lid_hold_while_sides_let_slip():
    flow = Simulation(scene(walls="floor and lid stick", viscosity=10.0)).flow
    walls = slice(flow.layer.fluid, None)
    side = (flow.layer.x[walls, 1] > 0.0) & (flow.layer.x[walls, 1] < 1.0)
    assert (flow.layer.material[walls] == side).all()


def test_restored_two_fluids_go_on_bit_for_bit():
    one, other = (Simulation(scene(surface_tension=1.0)) for _ in range(2))
    one.advance(40)
    other.restore(one.state())
    one.advance(40)
    other.advance(40)
    assert one.flow.layer.x.tobytes() == other.flow.layer.x.tobytes()
    assert one.flow.layer.density.tobytes() == other.flow.layer.density.tobytes()


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"disc": [{"x": 0.1, "y": 0.4, "radius": 0.2}]}, r"inclusion\.disc\[0\].*column of water"),
        ({"disc": [{"x": 0.5, "y": 0.4, "radius": 0.1}]}, "fewer than 6 particles"),
    ],
)
def test_discs_that_do_not_fit_are_refused(change, named):
    with pytest.raises(InputError, match=named):
        scene(**change)


def test_a_disc_of_just_six_particles_that_touches_the_edges_is_taken():
    """0.15 is less than 3 * 0.05, and 0.3 - 0.1 less than 0.2, by round-off alone."""
    table = scene().model_dump(mode="json")
    tank = {**table["tank"], "width": 1.0, "height": 1.0}
    for spacing, left, x, radius in ((0.05, 0.0, 0.3, 0.15), (0.02, 0.2, 0.3, 0.1)):
        column = {"left": left, "bottom": 0.0, "width": 0.6, "height": 0.6}
        parts = {
            "tank": tank,
            "water": {**table["water"], "column": [column]},
            "inclusion": {**table["inclusion"], "disc": [{"x": x, "y": 0.3, "radius": radius}]},
            "numerics": {**table["numerics"], "spacing": spacing},
        }
        validate(scene_type(), {**table, **parts})
        parts["inclusion"]["disc"][0]["radius"] *= 0.99 if radius == 0.15 else 1.01
        with pytest.raises(InputError, match=r"fewer than 6|column of water"):  # the check that must fail
            validate(scene_type(), {**table, **parts})


def test_the_step_that_capillary_waves_allow_is_reported_and_used():
    wide = [{"x": 0.5, "y": 0.5, "radius": 0.35}]
    thick = scene(surface_tension=1.2e4, density=1000.0, disc=wide)
    rows = {row.name: row.value for group in report(thick).groups.values() for row in group}
    assert rows["limited by"] == "capillarity"
    model = Simulation(thick)
    h = RATIO * 0.05
    assert model.step_seconds == pytest.approx(0.25 * (1000.0 * h**3 / (2.0 * np.pi * 1.2e4)) ** 0.5)


GAS = {"law": "adiabatic", "density": 1.2, "pressure": 1e3}
HARDEST = 1000.0 * 20.0**2 / 7.0 * (1.3**7 - 1.0)  # Pa, of the water at 1.3 of its density


@pytest.mark.parametrize(
    ("given", "warned", "raised"),
    [
        ({}, 0.01 * 1000.0 * 20.0**2, "water"),  # liquid, as stiff as the water
        ({"sound_speed": 5.0}, 0.01 * 100.0 * 5.0**2, "inclusion"),
        (GAS, 0.09 * 1.403e3, "inclusion.pressure"),
    ],
)
def test_tension_that_may_tear_a_disc_is_warned_of(given, warned, raised):
    near, low = (report(scene(surface_tension=share * warned * 0.2, **given)).warnings for share in (1.001, 0.999))
    assert any("σ/R" in text and "raise " + raised in text for text in near)
    assert not any("σ/R" in text for text in low)


@pytest.mark.parametrize("given", [{}, {"sound_speed": 5.0}, GAS])
def test_only_tension_that_makes_discs_denser_than_a_run_allows_is_refused(given):
    """1e6 N/m was unstable at step 0.  σ/R over 0.09 ρ c² of a liquid or ρ c² of a gas was refused, which drops and
    bubbles of 16 spacings bear."""
    line = r"denser than .* kg/m³, at which a run ends, .*; lower it, or raise water\.sound_speed"
    with pytest.raises(InputError, match=line):
        report(scene(surface_tension=1.001 * HARDEST * 0.2, **given))
    assert report(scene(surface_tension=0.999 * HARDEST * 0.2, **given)).warnings
    over = validate(scene_type(), scene(surface_tension=1.001 * HARDEST * 0.2, **given).model_dump(mode="json"))
    flow = Simulation(over).flow
    bubble = flow.layer.density[: flow.layer.fluid][flow.layer.material[: flow.layer.fluid] == 1]
    assert bubble.max() > bounds(flow.law.fluids)[1][1]


def test_a_gas_bubble_of_16_particles_bears_four_times_its_stiffness():
    """Its currents stay below √(σ/ρR), the speed of its waves.  A scene with more than its stiffness was refused."""
    radius, sigma = 0.16, 4.0 * 1.403e4 * 0.16
    disc = [{"x": 0.36, "y": 0.36, "radius": radius}]
    table = scene().model_dump(mode="json")
    table["tank"] |= {"width": 0.72, "height": 0.72}
    table["water"]["column"] = [{"width": 0.72, "height": 0.72}]
    table["inclusion"] |= GAS | {"density": 100.0, "pressure": 1e4, "disc": disc, "surface_tension": sigma}
    table["numerics"]["spacing"] = 0.02
    model = Simulation(validate(scene_type(), table | {"gravity": 0.0}))
    model.run(until=3.0 * (1000.0 * radius**3 / sigma) ** 0.5)
    layer = model.flow.layer
    assert np.hypot(*layer.v[: layer.fluid].T).max() < (sigma / (1000.0 * radius)) ** 0.5


def test_discs_that_overlap_are_refused_where_each_has_its_own_pressure():
    """Particles of both had σ/R of the disc that came last: the order in which discs are given was physics."""
    two = [{"x": 0.3, "y": 0.5, "radius": 0.2}, {"x": 0.6, "y": 0.5, "radius": 0.15}]
    line = (
        r"inclusion\.disc\[1\] = \(0\.6, 0\.5\) m: overlaps inclusion\.disc\[0\] by 0\.05 m, .* its own pressure; "
        "move them apart, or give one disc in place of both"
    )
    with pytest.raises(InputError, match=line):
        scene(surface_tension=1.0, disc=two)
    scene(surface_tension=1.0, disc=[two[0], two[1] | {"x": 0.65}])  # they touch
    # without surface tension they are one body, whatever the order
    one, other = (Simulation(scene(disc=discs)).flow.layer for discs in (two, two[::-1]))
    np.testing.assert_array_equal(one.material, other.material)
    np.testing.assert_array_equal(one.density, other.density)
