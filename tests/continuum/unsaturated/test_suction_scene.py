"""Scenes of soil with suction: refused, built, at rest, resumed; and scenes without, that build none of it."""

import numpy as np
import pytest

from continuum_sph.builders import simulation
from continuum_sph.builders.parts import suction
from continuum_sph.builders.parts.suction import MoisturePart, retention_of
from continuum_sph.builders.report import report
from continuum_sph.builders.simulation import Simulation
from continuum_sph.soil import SoilFlow
from continuum_sph.soil.stress import YY
from continuum_sph.unsaturated.pore_stress import borne
from continuum_sph.unsaturated.richards import CONTENT, EFFECTIVE, HEAD, PRESSURE
from continuum_sph.validation.tanks import level_ground, tank_scene
from porescale.common.core.constants import GRAVITY
from porescale.common.core.errors import InputError
from tests.reference.same_run import leaves

OUTLINE = [[0, 0], [0.3, 0], [0.3, 0.2], [0, 0.2]]
SUCTION = {"alpha": 5.0, "n": 3.0, "residual": 0.1, "water_table": 0.1}


def scene(given=SUCTION, soil=None, **changes):
    ground = {"stiffness": 1e6, "permeability": 1e-3, "body": [level_ground(0.3, 0.2)]} | (soil or {})
    ground |= {} if given is None else {"suction": given}
    return tank_scene(0.3, 0.4, 0.02, **{"water": {"sound_speed": 75.0}, "soil": ground} | changes)


UNDER = {"reservoir": [{"left": 0, "right": 0.3, "bottom": 0.2, "level": 0.3}]}
SETTLED = 0.1 * 0.6 * 1650.0 * GRAVITY * 0.2**2 / 2.0 / 1.35e6
"""m, of soil under open water: forces of p and weight cancel but at the ends of the column, where they settle it by a
row's share, 1/10, of its elastic settlement γ' H²/(2 M)."""


@pytest.mark.parametrize(
    ("given", "changes", "key"),
    [
        ({"saturation": 0.5}, {}, "suction: needs a saturation or a water_table"),
        ({"water_table": None}, {}, "suction: needs a saturation or a water_table"),
        ({"water_table": None, "saturation": 0.05}, {}, "suction.saturation = 0.05"),
        ({"n": 1.0}, {}, r"suction\.n"),
        ({"alpha": -1.0}, {}, r"suction\.alpha"),
        ({"beta": 1.0}, {}, "beta"),
        ({}, {"gravity": 0.0}, "gravity"),
        ({}, {"water": {"column": [{"width": 0.3, "height": 0.3}]}}, r"water\.column.*; use \[\[reservoir\]\]"),
        ({}, {"probe": [{"x": 0.1, "y": 0.1}]}, "probe.*; leave it out: snapshots have pore_pressure and saturation"),
        ({}, {"level": [{"x": 0.1}]}, "level.*; leave it out: the series has the level of every reservoir"),
        ({}, {"air": {}}, "air"),
        ({"water_table": 0.5}, {}, r"suction\.water_table = 0\.5 m: lies over the tank \(allowed: <= 0\.4 m\)"),
    ],
)
def test_what_cannot_be_is_refused_by_its_key(given, changes, key):
    with pytest.raises(InputError, match=key):
        scene(SUCTION | given, **changes)


@pytest.mark.parametrize("water", [{"sound_speed": 75.0}, {}])
def test_soil_that_is_held_is_not_sent_for_water_that_suction_refuses(water):
    with pytest.raises(InputError) as refused:
        scene(soil={"held": True}, water=water)
    assert [fault.problem for fault in refused.value.faults] == ["cannot be with soil.suction"]


def test_a_face_beside_suction_is_not_sent_for_pores_that_suction_refuses():
    with pytest.raises(InputError) as refused:
        scene(face=[{"side": "left", "head": 0.5}])
    assert [fault.problem for fault in refused.value.faults] == ["cannot be with soil.suction"]


@pytest.mark.parametrize("height", [0.0, 0.1])
def test_a_water_table_of_the_soil_is_refused_beside_suction(height):
    """0 m passed, as it equals False, and did nothing."""
    with pytest.raises(InputError, match=rf"soil\.water_table = {height} m: cannot be with soil\.suction"):
        scene(soil={"water_table": height})


@pytest.mark.parametrize("look", [report, Simulation])
@pytest.mark.parametrize("porosity", [0.0, 0.04])
def test_pores_without_room_for_water_are_refused(look, porosity):
    """Division by no porosity was a traceback."""
    with pytest.raises(InputError, match=r"soil\.porosity = .*: leaves water no room \(allowed: >= 0\.05 with water\)"):
        look(scene(soil={"porosity": porosity}))
    look(scene(soil={"porosity": 0.05}))


@pytest.mark.parametrize("look", [report, Simulation])
def test_suction_that_leaves_pores_less_than_no_water_is_refused(look):
    """`check` passed it, and the first look of the run found a negative filling, or the bound of its step a root of a
    negative density."""
    dry = {"water": {"sound_speed": 20.0}}
    few = "leaves pores less than no water"
    with pytest.raises(InputError, match=rf"suction\.water_table = -100\.0 m: {few}") as refused:
        look(scene(SUCTION | {"water_table": -100.0}, **dry))
    allowed = float(refused.value.faults[0].allowed.removeprefix(">= "))
    look(scene(SUCTION | {"water_table": allowed + 0.1}, **dry))
    little = SUCTION | {"water_table": None, "residual": 0.0, "saturation": 1e-9}
    with pytest.raises(InputError, match=rf"suction\.saturation = 1e-09: {few}"):
        look(scene(little, **dry))


def test_check_says_of_which_gravity_permeability_is_with_suction():
    told = "soil.permeability and alpha are those under the scene's gravity"
    assert any(told in it for it in report(scene(gravity=98.1, water={"sound_speed": 240.0})).warnings)
    assert not any(told in it for it in report(scene(gravity=9.8)).warnings)


def test_check_says_how_high_water_is_drawn_and_how_soon():
    out = report(scene())
    text = str(out)
    fringe = float(retention_of(scene()).suction(0.5))
    assert fringe == pytest.approx((0.5**-1.5 - 1.0) ** (1.0 / 3.0) / 5.0)
    for part in ("capillary height", "time to rise as high", "cohesion of half full pores", "stages of flow"):
        assert part in text
    assert f"{fringe:.4g}"[:5] in text


@pytest.mark.parametrize(("permeability", "sound"), [(1e-3, 75.0), (1e-2, 120.0), (1e-1, 120.0)])
def test_check_counts_the_stages_that_the_flow_of_water_takes(permeability, sound):
    """It told them for each half of a step, by a rate that was too large on a lattice with h of more than a spacing and
    with a whole step in place of a half: 12.8 of 10, 43 of 26 stages."""
    full = scene(SUCTION | {"water_table": 0.4}, soil={"permeability": permeability}, water={"sound_speed": sound})
    found = {row.name: row.value for group in report(full).groups.values() for row in group}
    run = Simulation(full)
    run.advance(10)
    longer = run.step_seconds / found["longest step for sound in soil that cannot drain"]
    assert 1.0 <= longer < 1.15  # of which half, by its root, may be in the stages
    # A stage more for each half where the number has to be odd, and for its edge.
    assert run.flow.stages / run.step == pytest.approx(found["stages of flow in a step"], rel=0.075, abs=2.0)
    assert found["stages of flow in a step"] % 4 == 2


@pytest.mark.parametrize("exponent", [0.0, 0.5])
def test_check_holds_the_water_against_soil_as_stiff_as_its_weight_makes_it(exponent):
    """With an exponent it was held against soil at the reference stress, and the step was that of such soil."""
    out = report(scene(soil={"stiffness": 1e7, "exponent": exponent}, water={"sound_speed": 300.0}))
    found = {row.name: row.value for group in out.groups.values() for row in group}
    modulus = found["modulus of a column, B + G"]
    assert found["stiffness of the water K_w/(n M)"] == pytest.approx(1000.0 * 300.0**2 / (0.4 * modulus), rel=1e-12)


def test_check_warns_of_a_table_over_soil_that_no_water_stands_on():
    def said(table, **changes):
        return any(
            "lies over the soil" in it for it in report(scene(SUCTION | {"water_table": table}, **changes)).warnings
        )

    assert said(0.25)
    assert not said(0.2)
    assert not said(0.3, **UNDER)


def test_check_warns_of_water_that_is_soft_and_of_levels_over_the_crest():
    assert any("n M" in it for it in report(scene(water={"sound_speed": 20.0})).warnings)
    assert any("both sides" in it for it in report(scene(**UNDER)).warnings)
    assert not report(scene()).warnings


def test_check_refuses_water_softer_than_suction():
    given = SUCTION | {"alpha": 0.001, "n": 1.1, "water_table": 0.1}
    said = r"^water\.sound_speed: makes water softer, 1e\+03 Pa, than suction in its pores, [0-9.e+]+ Pa; raise it more"
    with pytest.raises(InputError, match=said) as refused:
        report(scene(given, water={"sound_speed": 1.0}))
    report(scene(given, water={"sound_speed": float(str(refused.value).split("more than ")[1].split()[0])}))


@pytest.mark.parametrize("look", [report, Simulation])
def test_water_too_stiff_for_a_step_is_refused(look):
    """`check` passed it, and the run was "unstable at step 0", with repairs that did not help."""
    with pytest.raises(InputError, match=r"water\.sound_speed = 1000000\.0 m/s: makes steps of 5\.6e-09 s") as refused:
        look(scene(water={"sound_speed": 1e6}))
    allowed = float(refused.value.faults[0].allowed.removeprefix("<= "))
    look(scene(water={"sound_speed": 0.999 * allowed}))
    with pytest.raises(InputError, match=r"water\.sound_speed"):
        look(scene(water={"sound_speed": 1.001 * allowed}))


@pytest.mark.slow
def test_a_column_over_its_water_table_stays_at_rest():
    model = Simulation(scene())
    both = model.flow
    soil, n = both.ground.soil, both.ground.soil.soil
    depth = 0.2 - soil.x[:n, 1]
    state = both.water.state
    pore = np.array([borne(*it) for it in zip(state[:, PRESSURE], state[:, EFFECTIVE], strict=True)])
    # what is over a particle, water of its pores between residual and full, less what the pores bear
    low, high = (GRAVITY * (1590.0 + s * 400.0) * depth - pore for s in (0.1, 1.0))
    assert (soil.stress[:n, YY] > low - 1e-6).all()
    assert (soil.stress[:n, YY] < high + 1e-6).all()
    model.advance(800)
    model.check()
    # It sinks as soil does that is placed on its lattice, by a share of its elastic settlement (γ + suction) H/M
    assert model.series()["largest displacement (m)"] < 0.1 * (1990.0 * GRAVITY * 0.2 + 1000.0) * 0.2 / 1.35e6
    np.testing.assert_allclose(state[:, HEAD], 0.1, atol=0.002)  # what its strain has squeezed out flows in a second


def test_a_block_over_a_gap_weighs_nothing_on_the_soil_below():
    def lower(*blocks):
        """Upright stress of the soil of OUTLINE, Pa, with blocks (bottom, top), m, over it."""
        bodies = [{"outline": OUTLINE}, *({"outline": [[0, a], [0.3, a], [0.3, b], [0, b]]} for a, b in blocks)]
        soil = suction.moist_soil(scene(soil={"body": bodies})).ground.soil
        below = soil.x[: soil.soil, 1] < 0.2
        return soil.stress[: soil.soil, YY][below]

    alone = lower()
    np.testing.assert_array_equal(lower((0.24, 0.36)), alone)
    # the check that must fail: what stands on it is borne, (1 - n) rho_s and the water of its pores
    assert (lower((0.2, 0.32)) - alone).min() > 1650.0 * GRAVITY * 0.12


@pytest.mark.slow
def test_soil_under_open_water_bears_its_weight_less_buoyancy():
    model = Simulation(scene(SUCTION | {"water_table": 0.3}, soil={"permeability": 1e-2}, **UNDER))
    soil, n = model.flow.ground.soil, model.flow.ground.soil.soil
    before = soil.stress[:n, YY].mean()
    assert before == pytest.approx(0.6 * 1650.0 * GRAVITY * 0.1, rel=0.01)
    model.advance(1500)
    model.check()
    assert soil.stress[:n, YY].mean() == pytest.approx(before, rel=0.03)
    assert model.series()["largest displacement (m)"] < SETTLED


@pytest.mark.slow
def test_soil_that_forgets_the_water_on_it_is_pressed_apart(monkeypatch):  # the twin that must fail
    from continuum_sph.unsaturated import step

    def alone(soil, record, facing, matrix, near, pore, around, weight, force):
        around[:] = 0.0
        around[:, 1] = 1.0
        forces(soil, record, facing, matrix, near, pore, around, weight, force)

    forces = step.pore_forces
    monkeypatch.setattr(step, "pore_forces", alone)
    model = Simulation(scene(SUCTION | {"water_table": 0.3}, soil={"permeability": 1e-2}, **UNDER))
    model.advance(300)
    assert model.series()["largest displacement (m)"] > 10.0 * SETTLED


@pytest.mark.slow
def test_a_steep_face_stands_by_suction_and_falls_without():
    tower = {"body": [{"outline": [[0, 0], [0.1, 0], [0.1, 0.2], [0, 0.2]]}], "numerics": {"settle": 0.1}}
    moist = SUCTION | {"water_table": None, "saturation": 0.6}
    ends = []
    for given in (moist, None):
        model = Simulation(scene(given, soil=tower))
        while model.time < 0.35:
            model.advance(1)
        ends.append(model.series()["front (m)"])
    # S_e ψ of 0.556 and 0.22 m is 1200 Pa, cohesion 690 Pa: H_c = 4 c tan(60°)/γ = 0.27 m, of 0.2
    assert ends[0] < 0.105
    assert ends[1] > 0.13


@pytest.mark.slow
def test_a_resumed_run_goes_on_bit_for_bit():
    rising = {"reservoir": [{"left": 0, "right": 0.3, "bottom": 0.2, "rise": [[0.0, 0.2], [0.01, 0.3]]}]}
    whole, part, resumed = (Simulation(scene(**rising)) for _ in range(3))
    whole.advance(60)
    part.advance(23)
    resumed.restore(part.state())
    assert dict(leaves(resumed.state())) == dict(leaves(part.state()))
    resumed.advance(37)
    assert dict(leaves(resumed.state())) == dict(leaves(whole.state()))
    assert whole.series() == resumed.series()
    shown = resumed.snapshot().clouds["particles"].data
    assert {"saturation", "suction", "pore_pressure"} <= set(shown)


def test_a_scene_without_suction_builds_none_of_it(monkeypatch):
    def never(*_):
        raise AssertionError("built")

    for name in ("assemble", "moist_soil", "MoisturePart", "Moisture", "MoistSoil"):
        monkeypatch.setattr(suction, name, never)
    monkeypatch.setattr(simulation.suction, "assemble", never)
    model = Simulation(scene(None, water={}))
    assert type(model.flow) is SoilFlow
    assert not any(isinstance(part, MoisturePart) for part in model.parts)
    model.advance(2)
    assert not any("saturation" in name or "suction" in name for name in model.series())
    assert "moisture" not in model.state()
    assert "saturation" not in model.snapshot().clouds["particles"].data


@pytest.mark.slow
def test_water_is_kept_while_soil_moves():
    model = Simulation(scene(SUCTION | {"water_table": None, "saturation": 0.9}, soil={"friction_angle": "5 degree"}))
    before = model.flow.water.content[:, CONTENT].sum()
    model.advance(300)
    row = model.series()
    now = row["water in pores (kg/m)"]
    assert now == pytest.approx(
        before + row["water from reservoirs (kg/m)"] - row["water seeped out (kg/m)"], rel=1e-11
    )


def test_a_force_in_proportion_to_masses_pushes_soil_and_its_water_as_one():
    corners = [[0.1, 0.1], [0.2, 0.1], [0.2, 0.2], [0.1, 0.2]]
    given = {"alpha": 1.0, "n": 3.0, "saturation": 0.8}
    sim = Simulation(scene(given, {"body": [{"outline": corners}], "cohesion": 1e4, "tension": 1e3}, gravity=1e-3))

    @sim.force
    def push(time, positions, velocities, out):
        out[:, 0] = 0.1 * sim.masses

    sim.run(steps=20)
    water = sim.series()["water in pores (kg/m)"]
    assert sim.masses.sum() == pytest.approx(sim.series()["mass (kg/m)"] + water, rel=1e-12)
    # a free block moves as one, but for the weight of 1e-3 m/s² that stirs it; with grains alone it gets a sixth less
    assert (sim.masses @ sim.velocities)[0] == pytest.approx(0.1 * sim.time * sim.masses.sum(), rel=1e-6)
