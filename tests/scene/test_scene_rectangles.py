"""Rectangles of a scene: what is refused, how they move, what they carry through sides, what they do to grains."""

from typing import Any

import numpy as np
import pytest

from porescale import Scene
from porescale.builders.build import build
from porescale.builders.checks.rectangle_places import Body, first_meeting, nearest
from porescale.builders.derive import derive
from porescale.builders.parts import rectangles
from porescale.builders.report import report
from porescale.common.core.errors import Unstable
from porescale.common.record.checkpoint import read_checkpoint, write_checkpoint
from porescale.common.schema.sections import scene_as_dict, validate
from porescale.dem.measures.energy import elastic
from porescale.dem.measures.survey import max_overlap
from porescale.scene.bodies.rectangle import Rectangle, outline
from tests.reference.scenes import column, dry, grain, refusals, warned, water

WALLS: dict[str, Any] = {"domain__left": "wall", "domain__right": "wall", "fluid__body_force": None, "gravity": [0, 0]}
BLOCK: dict[str, Any] = {"lower": [0.004, 0.002], "upper": [0.006, 0.004]}
PISTON: dict[str, Any] = {"lower": [-0.009, -0.001], "upper": [0.002, 0.009], "velocity": [0.05, 0.0]}
GATE: dict[str, Any] = {"lower": [0.007, 0.0], "upper": [0.008, 0.009], "velocity": [0.0, 0.3], "starts_at": 0.002}
ONE = {"density": 2500, "grain": [grain(0.005, 0.0005)]}
H = 0.0002
EPS = np.finfo(float).eps


def tank(*sections: dict[str, Any], **changes: Any) -> Scene:
    """A closed box of 60 x 40 cells of water, 12 x 8 mm, with rectangles."""
    return water(**{**WALLS, "rectangle": list(sections), **changes})


def behind_gate(**changes: Any) -> Scene:
    """The small column behind a rectangle that lifts, instead of the gate."""
    return column(**{"gate": None, "rectangle": [GATE], **changes})


def said(scene: Any) -> list[str]:
    """The lines of a refusal."""
    return refusals(lambda: report(scene()))


@pytest.mark.parametrize(
    ("sections", "changes", "line"),
    [
        ([{**BLOCK, "upper": [0.004, 0.003]}], {}, "rectangle[0].upper = '(0.004, 0.003)': does not lie right of"),
        ([{**BLOCK, "starts_at": 2, "stops_at": 1}], {}, "rectangle[0].stops_at = 1.0 s: is before starts_at"),
        ([{**BLOCK, "speed": 1}], {}, "rectangle[0].speed = 1: unknown key"),
        ([BLOCK, {**BLOCK, "lower": [0.005, 0.003], "upper": [0.007, 0.007]}], {},
         "rectangle[1]: stands in rectangle 0"),
        ([BLOCK, {**PISTON, "velocity": [0.5, 0], "stops_at": 0.01}], {},
         "rectangle[1]: runs into rectangle 0 after 0.004 s"),
        ([{**BLOCK, "lower": [0.02, 0.0], "upper": [0.03, 0.01]}], {}, "rectangle[0]: is never in the box"),
        ([{**PISTON, "lower": [-0.03, -0.001], "velocity": [0.5, 0]}], {},
         "rectangle[0]: fills the whole box after 0.02 s"),
        ([BLOCK], {"gate": {"x": 0.005}}, "rectangle[0]: stands in the gate"),
        ([{**PISTON, "velocity": [0.5, 0], "stops_at": 0.01}], {"gate": {"x": 0.005, "opens_at": 0.01}},
         "rectangle[0]: runs into the gate after 0.006 s"),
        ([PISTON], {"domain__left": {"kind": "velocity", "velocity": [0.1, 0]}, "domain__right": "pressure"},
         "rectangle[0]: stands in the left side, which is open"),
        ([{**BLOCK, "velocity": [0.5, 0.0]}], {"domain__right": "pressure"},
         "rectangle[0]: runs into the right side, which is open after 0.012 s"),
        ([{**BLOCK, "make_good": True}, {**GATE, "make_good": False}], {}, "rectangle.make_good: differs"),
        ([{**BLOCK, "lower": [-0.01, 0.002]}], {"domain__left": "periodic", "domain__right": "periodic"},
         "rectangle[0] = 0.016 m: is longer along x than the periodic box"),
        ([BLOCK], {"disc": [{"x": 0.0035, "y": 0.003, "diameter": 0.002}]}, "disc[0]: stands in rectangle 0"),
        ([BLOCK], {"disc": [{"x": 0.002, "y": 0.003, "diameter": 0.001, "velocity": [0.1, 0]}]},
         "disc[0]: and rectangle 0 run into each other"),
        ([BLOCK], {"loads": {"rectangles": [1]}}, "loads.rectangles = 1: there is no such rectangle (allowed: 0 to 0)"),
        ([{**PISTON, "velocity": [3.0, 0], "stops_at": 1e-3}], {}, "fluid.step = 4e-05 s: a speed of 3 m/s is to be"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_with_one_line(sections, changes, line):
    lines = said(lambda: tank(*sections, **changes))
    assert len(lines) == 1
    assert lines[0].startswith(line)


@pytest.mark.parametrize(
    ("sections", "changes"),
    [
        ([BLOCK, {**BLOCK, "lower": [0.006, 0.002], "upper": [0.008, 0.006]}], {}),  # a step of two: they touch
        ([BLOCK, {**PISTON, "velocity": [0.5, 0], "stops_at": 0.004}], {}),  # stops where the block begins
        ([PISTON], {"gate": {"x": 0.005, "opens_at": 0.01}}),  # not there yet when the gate has gone
        ([BLOCK], {"domain__right": "pressure"}),
        ([{**BLOCK, "lower": [0.01, 0.0], "upper": [0.012, 0.004]}], {"domain__right": "pressure"}),  # an outlet
        ([BLOCK], {"disc": [{"x": 0.0065, "y": 0.003, "diameter": 0.001}]}),
        ([{**BLOCK, "lower": [0.02, 0.0], "upper": [0.03, 0.01], "velocity": [-0.5, 0], "stops_at": 0.02}], {}),
        ([{**BLOCK, "upper": [0.016, 0.004]}], {"domain__left": "periodic", "domain__right": "periodic"}),
    ],
)  # fmt: skip
def test_what_can_be_is_accepted(sections, changes):
    derive(tank(*sections, **changes))


def test_grains_and_rectangles_keep_clear_of_each_other():
    stands = said(lambda: dry(grains=ONE, rectangle=[{"lower": [0.004, 0.0], "upper": [0.006, 0.001]}]))
    assert stands == ["grains.grain[0]: stands in rectangle 0; move one of them"]
    periodic = {"domain__left": "periodic", "domain__right": "periodic"}
    assert "in a periodic box" in said(lambda: dry(grains=ONE, rectangle=[{**BLOCK}], **periodic))[0]
    inside = {**GATE, "lower": [0.009, 0.0], "upper": [0.01, 0.009]}
    derive(column(gate=None, rectangle=[GATE, inside]))  # the packing settles around it
    step = {"grains__packing__bottom": 0.001, "rectangle": [GATE, {"lower": [0.008, -1], "upper": [0.012, 0.001]}]}
    made = build(column(gate=None, grains__packing__height=0.004, **step)).grains
    assert (made.discs.position[:, 1] - made.discs.radius).min() > 0.00099  # and onto it
    assert "nothing holds the packing on its left" in said(lambda: column(gate=None))[0]
    derive(behind_gate())


@pytest.mark.parametrize("away", [0.1, 1.0])
def test_a_low_step_far_from_a_packing_holds_nothing_while_it_settles(away):
    # A step of 1 mm, 6 mm away: before, grains 5 mm high were said to spill over it.
    step = {"lower": [0.001, 0.0], "upper": [0.002, 0.001 * away]}
    simulation = build(behind_gate(rectangle=[GATE, step]))
    assert simulation.grains.plate_names == ["rectangle 0 right"]
    assert simulation.grains.plates[0, 4] == 0.0  # and is gone once the rectangle has taken over


def test_what_meets_when_follows_from_straight_motion():
    one, other = Body((0.0, 0.0), (1.0, 1.0), (1.0, 0.0), 2.0, 6.0), Body((3.0, 0.5), (4.0, 2.0))
    assert first_meeting(one, other, 10.0, 0.0) == 4.0  # two away, from 2 s on at 1 m/s
    assert first_meeting(one, other, 3.9, 0.0) == np.inf
    assert first_meeting(one, Body((3.0, 1.5), (4.0, 2.0)), 10.0, 0.0) == np.inf  # passes below
    assert first_meeting(one, Body((6.0, 0.0), (7.0, 1.0)), 10.0, 0.0) == np.inf  # stops before
    away = Body((3.0, 0.5), (4.0, 2.0), (0.0, 1.0), 0.0)  # has risen out of the way by then
    assert first_meeting(one, away, 10.0, 0.0) == np.inf
    square = Rectangle(lower=(0.0, 0.0), upper=(1.0, 1.0))
    passing = Body((0.0, 0.0), (0.0, 0.0), (1.0, 0.0))
    # From (-2, 1.5) on along x: over the square half a metre is the least; for one second only, (-1, 1.5) to (0, 1).
    assert nearest(square, passing, np.array([-2.0, 1.5]), 0.0, 5.0) == pytest.approx(0.5, abs=1e-12)
    assert nearest(square, passing, np.array([-2.0, 1.5]), 0.0, 1.0) == pytest.approx(1.25**0.5, abs=1e-12)


def test_a_ramp_is_even_acceleration_and_slowing_to_rest():
    it = Rectangle(lower=(0, 0), upper=(1, 1), velocity=(2.0, -1.0), starts_at=1.0, stops_at=6.0, ramp=2.0)
    # 2 m/s after 2 s: 2 m; even for one second: 2 m; to rest in 2 s: 2 m.  Halves of a ramp are 1/4 and 3/4 of it.
    times = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 9.0)
    assert [it.travelled(t)[0] for t in times] == pytest.approx([0.0, 0.5, 2.0, 4.0, 5.5, 6.0, 6.0], rel=1e-14)
    assert it.travelled(5.0)[1] == pytest.approx(-2.75, rel=1e-14)
    for_ever = Rectangle(lower=(0, 0), upper=(1, 1), velocity=(2.0, 0.0), ramp=2.0)
    assert for_ever.travelled(10.0)[0] == pytest.approx(18.0, rel=1e-14)
    # Two that meet in the ramp of one: after 1/2 t²/2 = 1 m; even parts of an eighth of it err by 2 * 2/(8 * 64) m.
    other = Body((2.0, 0.0), (3.0, 1.0))
    assert first_meeting(for_ever, other, 10.0, 0.0) == pytest.approx(2**0.5, abs=2 * 2 / 512 / 2**0.5)
    (line,) = refusals(lambda: derive(tank({**BLOCK, "velocity": [0.1, 0], "stops_at": 1e-3, "ramp": 6e-4})))
    assert line.startswith(
        "rectangle[0].ramp = 0.0006 s: does not fit twice between starts_at and stops_at (allowed: <= 0.0005"
    )


def test_a_piston_that_starts_at_once_rings_and_a_ramp_of_the_length_that_is_said_does_not():
    piston = {"lower": [-0.004, -0.001], "upper": [0.002, 0.009], "velocity": [0.01, 0.0]}
    channel = {
        "fluid__body_force": None, "gravity": [0, 0], "domain__left": "wall", "domain__top": "wall",
        "domain__right": {"kind": "pressure", "pressure": 0.0}, "time__end": 0.12,
    }  # fmt: skip

    def flows(steps, **more):
        """Mean velocity in front over that of the piston, after each step; what is said of it."""
        scene = water(**channel, rectangle=[{**piston, **more}])
        simulation, found = build(scene), []
        for _ in range(steps):
            simulation.advance(1)
            found.append(simulation.fluid.fields()[1][:, 35:45].mean() * simulation.coupled.scales.velocity / 0.01)
        return np.array(found), warned(scene, "ramp")

    at_once, (said,) = flows(420)
    # rho c V: 1000 * 0.0002/4e-5/sqrt 3 * 0.01 = 29 Pa;  w = pi c/2L = 378/s;  T = 20/w
    assert "a pulse of 29 Pa goes to and fro at 60.1 Hz" in said
    assert "swing by 100 % of what it displaces" in said
    assert "rectangle.ramp = 0.053 s" in said
    # All of it: twice the flow half a period after the start, less what walls have taken by then (exp(-0.07) of it)
    # and what the front is spread; and hardly any flow a period after it.
    assert 1.8 < at_once.max() < 2.0
    assert at_once[300:].min() < 0.4
    ramped, silent = flows(2000, ramp=0.053)  # the ramp has 1325 steps
    assert not silent
    assert np.abs(ramped[1400:] - 1).max() < 0.1
    # The check that must fail: a ramp of a fifth of it leaves five times as much, 2/wT = 53 %.
    _, (said,) = flows(1, ramp=0.01)
    assert "starts in 0.01 s" in said
    assert "swing by 53 %" in said


def test_a_gate_that_rises_along_itself_and_a_thick_liquid_do_not_ring():
    assert not warned(tank(GATE), "ramp")
    piston = {"lower": [-0.009, -0.001], "upper": [0.002, 0.009], "velocity": [0.01, 0.0]}
    given = {"fluid__body_force": None, "domain__left": "wall", "time__end": 0.9, "rectangle": [piston]}
    out = {"domain__right": {"kind": "pressure", "pressure": 0.0}}
    assert warned(water(**given | out | {"time__end": 0.1}), "ramp")
    thick = {"fluid__viscosity": 1e-4}  # damped at sqrt(nu w/2)/H = 17/s, long before half of 0.9 s
    assert not warned(water(**given | out | thick), "ramp")


def test_a_rectangle_goes_as_its_section_says():
    it = Rectangle(lower=(0, 0), upper=(1, 1), velocity=(2.0, -1.0), starts_at=1.0, stops_at=3.0)
    assert [it.travelled(t) for t in (0.0, 1.0, 1.5, 3.0, 9.0)] == [(0, 0), (0, 0), (1, -0.5), (4, -2), (4, -2)]
    # 12 of 40 cells a step; it sets off 12.5 steps after the start, so half of that step is its own.
    given = {**BLOCK, "velocity": [0.05, 0.0], "starts_at": 5e-4, "stops_at": 1e-3}
    simulation = build(tank(given, grains=ONE, contact={"stiffness": 2e5, "restitution": 0.9},
                            grains__hydraulic_radius_ratio=1.0))  # fmt: skip
    part = simulation.part(rectangles.RectanglesPart)
    seen = []
    for _ in range(30):
        simulation.advance(1)
        seen.append(float(part.lattice[0].velocity[0]))
        away = simulation.scene.rectangle[0].travelled(simulation.time)[0]
        # Both are places of order 0.01 m that one sum gives.
        assert part.lattice[0].lower[0] * H == pytest.approx(0.004 + away, abs=4 * 0.01 * EPS)
        assert simulation.grains.rectangles[0, 0] == 0.004 + away
    full = 0.05 * 4e-5 / H
    assert seen[:12] == [0.0] * 12
    assert seen[12] == pytest.approx(full / 2, rel=1e-9)
    assert seen[13:25] == pytest.approx([full] * 12, rel=1e-9)
    assert seen[25:] == [0.0] * 5


def test_a_card_keeps_a_scene_with_rectangles():
    scene = tank(PISTON, {**GATE, "make_good": True}, loads={"rectangles": [0]})
    assert validate(Scene, scene_as_dict(scene)) == scene
    rows = {row.name: row.value for row in report(scene).groups["Parts"]}
    assert "rectangle" in rows["built"]


def test_a_scene_without_rectangles_builds_nothing_and_does_nothing_for_them(monkeypatch):
    def refuse(*args: Any, **options: Any) -> None:
        raise AssertionError("asked for a rectangle")

    for name in ("__init__", "before", "after", "row"):
        monkeypatch.setattr(rectangles.RectanglesPart, name, refuse)
    simulation = build(column())
    simulation.advance(3)
    simulation.series()
    assert not [part for part in simulation.parts if isinstance(part, rectangles.RectanglesPart)]
    assert simulation.coupled.saturated.bodies is None
    assert len(simulation.grains.rectangles) == simulation.grains.rectangle_spring.size == 0
    assert not [key for key in simulation.state() if "made" in key]
    with pytest.raises(AssertionError, match="asked for"):  # the twin: with one, all of it is
        build(behind_gate())


def test_without_grains_there_is_fluid_around_it_and_without_fluid_grains():
    wet = build(tank(PISTON, loads={"rectangles": [0]}))
    wet.advance(20)
    assert wet.tables()["loads"]["rectangle 0 force x (N/m)"] < 0.0  # the water holds it back
    assert not wet.snapshot().clouds
    solid = wet.snapshot().grids["fields"].cells["solid_fraction"]
    assert solid.sum() * H**2 == pytest.approx((0.002 + 0.05 * wet.time) * 0.008, rel=1e-6)  # kept in float32
    plain = build(dry(grains=ONE, rectangle=[PISTON]))
    plain.advance(20)
    assert plain.coupled is None
    assert plain.grains.rectangles[0, 2] == 0.002 + 0.05 * plain.time


def test_the_book_of_a_closed_box_is_right_and_made_good():
    # A piston comes in: what fills it comes with it, at the density of the fluid before it, a few per cent denser in a
    # closed box; and is taken out of all of the fluid again, but for what came since.
    kept, good = (build(tank({**PISTON, "make_good": it})) for it in (False, True))
    for one in (kept, good):
        one.advance(448)
        row = one.series()
        gained = row["fluid mass change ()"] * 60 * 40 * H**2
        book = row["fluid in with rectangles (m²)"] - row["of it taken out again (m²)"]
        # Round-off of some 0.1 in each of 2400 cells and 448 steps, all one way.
        assert abs(gained - book) < 0.1 * 2400 * 448 * EPS * H**2
        way = 0.05 * one.time * 0.008
        assert row["fluid in with rectangles (m²)"] == pytest.approx(way, rel=0.1)
    assert kept.series()["of it taken out again (m²)"] == 0.0
    # What is not yet taken out came in during the last 64 steps: a seventh of 448.
    assert book < 0.2 * row["fluid in with rectangles (m²)"]
    # The twin: without it the box fills up.  The way is 0.9 mm of 10: its share of the fluid is 9 %.
    assert kept.series()["highest relative density ()"] > 1.07
    assert good.series()["highest relative density ()"] < 1.05


@pytest.mark.parametrize("steps", [70, 131])
@pytest.mark.parametrize(
    "scene", [behind_gate, lambda: tank(PISTON, loads={"rectangles": [0]})], ids=["gate", "piston"]
)
def test_a_run_goes_on_bit_for_bit_from_a_checkpoint_in_the_middle_of_a_motion(scene, steps, tmp_path):
    one, two = build(scene()), build(scene())
    one.advance(steps)
    write_checkpoint(tmp_path / "checkpoint.h5", one.state())
    state = read_checkpoint(tmp_path / "checkpoint.h5")
    two.restore(state)
    for simulation in (one, two):
        simulation.advance(140)
    moved, also = (it.part(rectangles.RectanglesPart) for it in (one, two))
    assert moved.made_good == also.made_good != 0.0
    assert one.series() == two.series()
    assert one.tables() == two.tables()
    for a, b in zip(one.fields(), two.fields(), strict=True):
        np.testing.assert_array_equal(a, b)
    # The twin: without the book of what came in, one more step takes out another amount.
    state["coupled"]["saturated"]["bodies"]["mass"] += 1.0
    two.restore(state)
    two.advance(140)
    assert moved.made_good != also.made_good


def test_a_piston_pushes_grains_as_it_does_alone():
    # Elastic, in the frame of the face: a grain at rest leaves at twice its speed.
    law = {"stiffness": 2e5, "restitution": 1.0}
    given = {**PISTON, "upper": [0.004, 0.009], "velocity": [0.1, 0.0]}
    pushed = build(dry(grains={"density": 2500, "grain": [grain(0.0051, 0.004)]}, contact=law, gravity=[0, 0],
                       rectangle=[given]))  # fmt: skip
    pushed.advance(int(0.012 / pushed.step_seconds))
    # A free bounce of the leap-frog errs by a step in its duration, of which there are ten at least.
    assert pushed.grains.discs.velocity[0, 0] == pytest.approx(0.2, rel=0.1)
    # In fluid, whose drag wants to stop it, it is never behind the face by more than the deepest overlap.
    wet = build(tank(given, grains={"density": 2500, "hydraulic_radius_ratio": 1.0, "grain": [grain(0.0051, 0.004)]},
                     contact=law))  # fmt: skip
    for _ in range(20):
        wet.advance(20)
        face = 0.004 + 0.1 * wet.time
        assert wet.grains.discs.position[0, 0] > face + 0.99 * 0.0005
    assert wet.grains.discs.position[0, 0] > 0.0055


def test_an_overlap_with_a_rectangle_counts_among_the_others():
    simulation = build(dry(grains=ONE, rectangle=[{"lower": [0.004, 0.0015], "upper": [0.006, 0.002]}]))
    grains = simulation.grains
    grains.discs.position[0] = 0.005, 0.0012
    # 0.2 mm of 0.5, and k d²/2 at a stiffness of 2e5; the centre 0.1 mm inside makes it 1.2 radii.
    assert max_overlap(grains).against == "rectangle 0"
    assert max_overlap(grains).share == pytest.approx(0.4, rel=1e-12)
    assert sum(elastic(grains)) == pytest.approx(0.5 * 2e5 * 2e-4**2, rel=1e-12)
    grains.discs.position[0] = 0.005, 0.0016
    assert max_overlap(grains).share == pytest.approx(1.2, rel=1e-12)


def test_pictures_show_a_rectangle_where_it_is_and_within_the_box():
    (section,) = scene_as_dict(tank({**PISTON, "stops_at": 0.02}))["rectangle"]
    assert outline(section, 0.0, (0.012, 0.008)) == [((0.002, 0.0), (0.002, 0.008))]  # all else is beyond the sides
    ((low, _),) = outline(section, 1.0, (0.012, 0.008))
    assert low == (pytest.approx(0.003), 0.0)
    block = scene_as_dict(tank(BLOCK))["rectangle"][0]
    assert len(outline(block, 5.0, (0.012, 0.008))) == 4
    assert outline({**block, "velocity": [0.0, 1.0]}, 5.0, (0.012, 0.008)) == []


def test_grains_squeezed_between_a_rectangle_and_a_wall_are_named():
    law = {"stiffness": 2e5, "restitution": 0.5}
    press = {"lower": [-0.1, -0.1], "upper": [0.009, 0.1], "velocity": [0.1, 0.0]}
    squeezed = build(dry(grains={"density": 2500, "grain": [grain(0.0115, 0.004)]}, contact=law, gravity=[0, 0],
                         rectangle=[press], time__end=0.025))  # fmt: skip

    def squeeze() -> None:
        for _ in range(100):
            squeezed.advance(50)
            squeezed.check()

    with pytest.raises(Unstable, match=r"overlap with (rectangle 0|the right wall) over radius"):
        squeeze()
    gentle = build(dry(grains={"density": 2500, "grain": [grain(0.0115, 0.004)]}, contact=law, gravity=[0, 0],
                       rectangle=[{**press, "stops_at": 0.02}], time__end=0.025))  # fmt: skip
    gentle.advance(int(0.024 / gentle.step_seconds))
    gentle.check()


def test_a_gate_holds_the_packing_until_it_lifts_and_leaves_through_a_slip_lid():
    simulation = build(behind_gate())
    simulation.advance(49)
    row = simulation.series()
    assert abs(row["run-out (m)"]) < 1e-5  # a hundredth of a grain
    highest = 0.0
    for _ in range(14):
        simulation.advance(50)
        highest = max(highest, simulation.series()["highest relative density ()"])
        simulation.check()
    row = simulation.series()
    assert row["run-out (m)"] > 0.0005
    # All of it has left, 1 x 8 mm; of the half row at floor and lid each it takes less, 1/40.
    assert row["fluid in with rectangles (m²)"] == pytest.approx(-0.001 * 0.008, rel=0.05)
    # Pressure of the bed's weight and of the lift-off, 0.3 m/s of a sound speed of 2.9 m/s: 10 % at most; a lid that
    # rests is run into, to densities of 1.2 and far more (test_coupling_shapes).
    assert highest < 1.1


def test_a_rectangle_thinner_than_two_cells_is_warned_of():
    thin = {"lower": [0.004, 0.0], "upper": [0.004 + 1.9 * H, 0.006]}
    (said,) = warned(tank(thin), "thick")
    assert said.startswith(
        "rectangle 0 is 1.9 cells thick: below 2 it may fill no cell and lets fluid through; a spacing"
    )
    assert not warned(tank({**thin, "upper": [0.004 + 2 * H, 0.006]}), "thick")
    assert not warned(tank(thin), "nothing solid")
