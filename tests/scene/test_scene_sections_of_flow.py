"""Sections of the fluid, of its sides, of held discs: what they accept, what they refuse, what they build."""

from typing import Any

import numpy as np
import pytest

from porescale import Scene
from porescale.builders.build import build
from porescale.builders.derive import derive
from porescale.builders.initial.fluid import lattice_sides
from porescale.builders.report import report
from porescale.common.schema.sections import scene_as_dict, validate
from tests.reference.scenes import column, dry, grain, refusals, water

DISC = {"x": 0.004, "y": 0.004, "diameter": 0.002}
INLET = {"kind": "velocity", "velocity": [0.1, 0.0]}


def channel(**changes: Any) -> Scene:
    """A channel of 60 x 40 cells without grains, from an inlet to an outlet, past a held disc."""
    given: dict[str, Any] = {
        "domain__left": INLET, "domain__right": "pressure", "fluid__body_force": None, "disc": [DISC],
        "gravity": [0.0, 0.0],
    }  # fmt: skip
    return water(**{**given, **changes})


def said(make: Any, **changes: Any) -> str:
    """What is said of the first fault."""
    return refusals(lambda: report(make(**changes)))[0]


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("fluid__operator", "centrl", "did you mean 'central'?"),
        ("fluid__solid_operator", "odd-sc1", "did you mean 'odd-SC1'?"),
        ("fluid__weighting", "b1", "did you mean 'B1'?"),
        ("fluid__weighting", "B2", "fluid.weighting = 'B2': does not go with the solid operator 'exact-wall'"),
        ("fluid__precision", "float16", "unknown choice"),
        ("domain__top", "slipp", "did you mean 'slip'?"),
        ("domain__top", {"kind": "slip", "speed": 1.0}, 'belongs to a side of kind "wall", this is a slip'),
        ("domain__left", {"kind": "velocity"}, "is missing"),
        ("domain__left", {"kind": "wall", "pressure": 1.0}, 'belongs to a side of kind "pressure"'),
        ("probe", [{"x": 1.0, "y": 0.0}], "is outside the box"),
        ("look", {"view": [0.0, 1.0, 0.0, 0.001]}, "look.view = '(1, 0.001)': is outside the box"),
        ("flux", [{"start": [0.0, 0.0], "end": [0.0, 0.0]}], "is the same as start"),
        ("loads", {"discs": [3]}, "there is no such disc (allowed: 0 to 0)"),
        ("loads", {"grains": [0]}, "there is no such grain"),
        ("loads", {"discs": [0], "speed": 1.0}, "coefficients need both"),
        ("permeability", {}, "permeability.window: is needed where there is no packing"),
        ("permeability", {"wanted": 0.01}, "is of grains, whose hydraulic_radius_ratio may differ"),
        ("disc", [DISC, {**DISC, "x": 0.0045}], "overlaps disc 0"),
        ("disc", [{**DISC, "x": 0.0005}], "reaches out of the box"),
    ],
)
def test_what_does_not_fit_is_said(key, value, words):
    assert words in said(channel, **{key: value})


@pytest.mark.parametrize("section", ["probe", "line", "flux"])
def test_without_fluid_there_is_nothing_to_measure(section):
    given = {"start": [0.0, 0.001], "end": [0.001, 0.001]} if section != "probe" else {"x": 0.001, "y": 0.001}
    assert said(dry, **{section: [given]}).startswith(f"{section}: there is no fluid to measure")


def test_a_scene_with_everything_survives_its_own_card():
    scene = channel(
        fluid__operator="mrt", fluid__smagorinsky=0.1, fluid__precision="float32", probe=[{"x": 0.001, "y": 0.001}],
        line=[{"start": [0.0, 0.001], "end": [0.01, 0.001]}], loads={"discs": [0], "speed": 0.1, "length": 0.002},
        output__fields=["vorticity", "stream_function"],
    )  # fmt: skip
    assert validate(Scene, scene_as_dict(scene)) == scene


def test_sides_reach_the_lattice_in_its_units():
    scene = channel(domain__left={**INLET, "profile": "parabola"}, domain__right={"kind": "pressure", "pressure": 30.0})
    scales = derive(scene).scales
    sides = lattice_sides(scene.domain, scales, (60, 40))
    given = np.asarray(sides.left_velocity)
    # The midpoint rule on a parabola of mean 1 over n cells gives 1 + 1/(2 n²).
    assert given[:, 0].mean() * scales.velocity == pytest.approx(0.1 * (1 + 0.5 / 40**2), rel=1e-12)
    assert np.array_equal(given, given[::-1])
    assert (sides.right_density - 1) * scales.pressure == pytest.approx(30.0, rel=1e-12)
    moving = lattice_sides(column(domain__top={"speed": 0.2}).domain, scales, (60, 40))
    assert moving.top_speed * scales.velocity == pytest.approx(0.2, rel=1e-15)


def test_a_disc_that_never_moves_is_told_to_the_rims():
    towed, swung = {**DISC, "x": 0.007, "spin": 1.0}, {**DISC, "y": 0.0065, "velocity_x": {"mean": 0.01}}
    scene = channel(fluid__operator="central", disc=[DISC, towed, swung])
    assert build(scene).coupled.saturated.soft_rim.stands.tolist() == [True, False, False]


def test_every_law_that_a_scene_names_is_the_one_that_runs():
    scene = channel(fluid__operator="mrt", fluid__smagorinsky=0.17, fluid__solid_operator="SC1", fluid__weighting="B1")
    simulation = build(scene)
    assert type(simulation.fluid.law).__name__ == "EddyMrt"
    assert float(simulation.fluid.law.strain_factor) == pytest.approx(18 * 2**0.5 * 0.17**2, rel=1e-15)
    default = build(channel())
    assert type(default.fluid.law).__name__ == "Trt"
    for one in (simulation, default):
        one.advance(20)
    assert not np.array_equal(simulation.fields()[1], default.fields()[1])
    values = {row.name: row.value for row in report(scene).groups["Operators"]}
    assert (values["collision"], values["solid"], values["weight"]) == ("mrt", "SC1", "B1")


def test_the_weight_that_is_used_is_shown_and_kept():
    for changes, weight in (({}, "wall"), ({"fluid__solid_operator": "odd-SC1"}, "B2")):
        scene = channel(**changes)
        assert {row.name: row.value for row in report(scene).groups["Operators"]}["weight"] == weight
        assert validate(Scene, scene_as_dict(scene)) == scene
    wrong = channel, {"fluid__solid_operator": "SC1", "fluid__weighting": "wall"}
    assert said(wrong[0], **wrong[1]).endswith("(allowed: 'B2' or 'B1'); leave it out")


def test_single_precision_runs_restores_and_says_the_same_to_its_own_round_off():
    single, double = build(channel(fluid__precision="float32")), build(channel())
    assert single.fluid.populations.dtype == np.float32
    for one in (single, double):
        one.advance(100)
    # A hundred steps, each of which rounds populations of at most a tenth to 6e-8 of themselves: 6e-7 cells a step at
    # worst, of the inlet's 0.02 cells a step 3e-5.
    scale = 0.1
    assert np.abs(single.fields()[1] - double.fields()[1]).max() < 3e-5 * scale
    twin = build(channel(fluid__precision="float32"))
    twin.restore(single.state())
    for one in (single, twin):
        one.advance(10)
    assert np.array_equal(single.fields()[1], twin.fields()[1])


def test_a_fixed_disc_stays_and_a_towed_one_keeps_its_velocity():
    towed = {**DISC, "y": 0.0055, "x": 0.008, "diameter": 0.001, "velocity": [0.05, 0.0], "spin": 3.0}
    simulation = build(channel(disc=[DISC, towed]))
    simulation.advance(50)
    discs = simulation.grains.discs
    assert discs.position[0].tolist() == [0.004, 0.004]
    assert discs.velocity[0].tolist() == [0.0, 0.0]
    assert discs.velocity[1].tolist() == [0.05, 0.0]
    # Fifty additions to a number of order 0.01: half a unit in the last place each.
    assert discs.position[1, 0] == pytest.approx(0.008 + 0.05 * simulation.time, abs=50 * 1e-18)
    assert discs.angle[1] == pytest.approx(3.0 * simulation.time, rel=50 * 1e-16)


def test_the_series_of_grains_does_not_count_held_discs():
    grains = {"density": 2500, "hydraulic_radius_ratio": 0.8, "grain": [grain(0.01, 0.004)]}
    contact = {"stiffness": 2e5, "restitution": 0.9}
    simulation = build(channel(grains=grains, contact=contact))
    row = simulation.series()
    assert row["centre of mass x (m)"] == 0.01
    assert row["hydraulic radius ratio ()"] == 0.8
    assert simulation.coupled.hydraulic_radius.tolist() == pytest.approx([0.0004, 0.001])  # the disc at its full size
    assert "centre of mass x (m)" not in build(channel()).series()


def test_a_choice_that_does_nothing_is_warned_of():
    def warnings(scene: Scene) -> str:
        return " ".join(derive(scene).warnings)

    assert "magic = 0.25 is not used" in warnings(channel(fluid__operator="bgk", fluid__magic=0.25))
    assert "is not used" not in warnings(channel(fluid__magic=0.25))
    assert "nothing solid in the fluid" in warnings(channel(disc=[], fluid__solid_operator="odd-SC1"))
    assert "nothing solid in the fluid" not in warnings(channel(disc=[]))
    narrow = {"fluid__solid_operator": "narrow-wall"}
    assert "is made for 0.1875" in warnings(channel(**narrow, fluid__magic=0.0417))
    assert "is made for" not in warnings(channel(**narrow)) + warnings(channel(fluid__magic=0.0417))
    low = {"fluid__viscosity": 3e-7}  # cell Reynolds number 0.1 * 2e-4/3e-7 = 67
    assert "'trt' is known to hold up to 51" in warnings(channel(**low))
    assert "relaxation time" not in warnings(channel(**low, fluid__operator="central"))
    assert "relaxation time" not in warnings(channel(**low, fluid__smagorinsky=0.1))


def test_the_speed_to_expect_is_that_of_inlets_lids_and_towed_discs():
    assert derive(channel()).speed == pytest.approx(0.1, rel=1e-12)
    assert derive(channel(domain__left={**INLET, "profile": "parabola"})).speed == pytest.approx(0.15, rel=1e-12)
    assert derive(channel(domain__top={"speed": 0.4})).speed == pytest.approx(0.4, rel=1e-12)
    assert derive(channel(disc=[{**DISC, "velocity": [0.3, 0.0]}])).speed == pytest.approx(0.3, rel=1e-12)
    held = {"domain__left": {"kind": "pressure", "pressure": 20.0}}
    # Plane Poiseuille: dp/L H²/(8 mu) = 20/0.012 * 0.008²/(8 * 0.02) = 0.67 m/s; Bernoulli: sqrt(2 * 20/1000) = 0.2.
    assert derive(channel(**held)).speed == pytest.approx(0.2, rel=1e-12)


@pytest.mark.parametrize(
    ("make", "look", "allowed"),
    [
        (dry, {"colour": "mass"}, "radius, angle, velocity, spin"),
        (dry, {"field": "pressure"}, "radius, angle, velocity, spin"),
        (column, {"colour": "mass"}, "radius, angle, velocity, spin, hydraulic_radius"),
        (column, {"field": "vorticity"}, "velocity, pressure, solid_fraction"),
        (water, {"colour": "spin"}, "none: there are no grains"),
    ],
)
def test_pictures_of_what_no_snapshot_holds_are_refused(make, look, allowed):
    (key, name), *_ = look.items()
    line = f"look.{key} = '{name}': is not recorded (allowed: {allowed})"
    assert any(it.startswith(line) for it in refusals(lambda: make(look=look))), refusals(lambda: make(look=look))


def test_pictures_of_what_snapshots_hold_are_taken():  # the twins
    dry(look={"colour": "spin", "field": "radius"})
    dry(look={"field": "stress_xx"}, coarse_graining={"spacing": 0.002})
    column(look={"colour": "hydraulic_radius", "field": "vorticity"}, output__fields=["vorticity"])
