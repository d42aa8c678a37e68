"""Bonds and rock of dry scenes: when and between whom they are made, what they bear, and runs that go on with them."""

import warnings
from typing import Any

import numpy as np
import pytest

from porescale import Scene
from porescale.builders.build import build
from porescale.builders.derive import derive
from porescale.builders.initial.rock import rock_discs
from porescale.builders.parts.bonds import BondsPart
from porescale.builders.report import report
from porescale.common.core.errors import InputError, PorescaleWarning, Unstable
from porescale.common.schema.sections import scene_as_dict, validate
from porescale.dem.prepare.rock import rock as made_by_hand
from porescale.output.frame_pictures import cracks
from porescale.output.rock_pictures import drawn, write_rock_picture
from tests.reference.scenes import grain, refusals
from tests.reference.scenes_of_grains import assert_same_bits, framed, loose, resumed

STIFFNESS, OVERLAP = 2e5, 8e-7
SIDE = 1e-3
"""Of the squares; their lines are 0.1 mm apart less the overlap."""


def wall(**changes: Any) -> Scene:
    """Three squares side by side on nothing, without weight, the first held, with bonds."""
    apart = SIDE + 1e-4 - OVERLAP
    square = {"corners": [[0, 0], [SIDE, 0], [SIDE, SIDE], [0, SIDE]], "thickness": 5e-5}
    at = [[2e-3 + k * apart, 2e-3] for k in range(3)]
    rest = {axis: {"velocity": 0.0} for axis in ("x", "y", "rotation")}
    return framed(**{
        "polygon": [{**square, "at": at}], "gravity": [0, 0], "bonds": {}, "contact__restitution": 0.5,
        "contact__stiffness": STIFFNESS, "control": [{"polygon": 0, **rest}], **changes,
    })  # fmt: skip


def test_squares_are_bonded_at_the_ends_of_their_sides_and_stand():
    simulation = build(wall())
    bonds = simulation.grains.bonds
    # Side against side: four corners press, as many are counted twice at corner against corner and taken off again,
    # so that the sum of back tensions is that of the two points that bear: 2 k d0 a pair.
    assert bonds.back.sum() == pytest.approx(2 * 2 * STIFFNESS * OVERLAP, rel=1e-6)
    simulation.advance(300)
    # Contact and bond cancel to eps of the force; 300 steps of that push the last square by nothing to speak of.
    assert np.abs(simulation.grains.steering.clumps.velocity).max() < 1e-9
    assert simulation.series()["broken bonds ()"] == 0.0


def test_without_bonds_they_fly_apart():  # the twin that must fail
    simulation = build(wall(bonds=None))
    simulation.advance(300)
    assert simulation.grains.steering.clumps.velocity[2, 0] > 1e-3


def strength(**bonds: Any) -> float:
    """Largest force (N/m) on the held square while the third one is pulled away slowly."""
    rest = wall().control[0].model_dump()
    pull = {"polygon": 2, "x": {"velocity": 5e-4}, "y": {"velocity": 0.0}, "rotation": {"velocity": 0.0}}
    simulation = build(wall(bonds=bonds, control=[{**rest, "record": True}, pull]))
    most = 0.0
    while simulation.time < 8e-3 and simulation.series()["broken bonds ()"] == 0.0:
        simulation.advance(20)
        most = max(most, simulation.tables()["control"]["polygon 0 contact force x (N/m)"])
    return most


def test_bonds_break_at_k_times_their_overlap_and_a_factor_makes_them_stronger():
    plain = strength()
    # Two points a side, k d0 each.  Pulled through 1.6 um in 3.2 ms, 20 periods of these springs, looked at every 20
    # steps, in which the pull grows by 1 %.
    assert plain == pytest.approx(2 * STIFFNESS * OVERLAP, rel=0.02)
    assert strength(factor=1.5) == pytest.approx(1.5 * plain, rel=0.02)


def test_bonds_made_on_the_way_leave_the_energy_budget_closed():
    # Squares that press each other fly apart, and are bonded on the way: the energy that bonds bring, -b d, is none
    # that anything turned over.  With it the residual is of the size of all elastic energy.
    residuals = []
    for step in (4e-6, 1e-6):
        simulation = build(wall(bonds={"at": 1e-4}, output__energy=True, contact__step=step))
        while simulation.time < 2e-4:
            simulation.advance(1)
        series = simulation.series()
        assert series["bonds ()"] > 0
        assert series["elastic energy, normal (J/m)"] < 0
        residuals.append(abs(series["residual (J/m)"]) / series["turned over (J/m)"])
    # The budget is of first order in the step: 0.76, 0.31, 0.14, 0.06 % with 8, 4, 2, 1 us. What bonds bring is 150 %
    # of what is turned over, so 2 %, six times the first of these two, is a 75th of it.
    assert residuals[0] < 0.02
    assert residuals[1] < residuals[0] / 2  # falls with the step


def test_bonds_are_made_at_their_time_between_the_chosen():
    later = {"at": 2e-4, "bodies": ["polygon"], "within": [2.9e-3, 0, 5e-3, 5e-3]}
    rest = [{"polygon": k, **{axis: {"velocity": 0.0} for axis in ("x", "y", "rotation")}} for k in range(3)]
    simulation = build(wall(bonds=[later, {"at": 4e-4, "tension": 1.0}], control=rest))
    counts = []
    for time in (1e-4, 3e-4, 5e-4):
        simulation.advance(round((time - simulation.time) / simulation.step_seconds))
        counts.append(simulation.series()["bonds ()"])
    assert counts[0] == 0.0 < counts[1]
    assert counts[2] == 2 * counts[1]  # first the right pair, then the left one, alike
    bonds = simulation.grains.bonds
    new = bonds.back[len(bonds.back) // 2 :]
    assert new[new > 0].mean() == pytest.approx(1.0, rel=1e-12)


def test_a_run_goes_on_to_the_bit_before_and_after_bonds_are_made_and_broken():
    rest = wall().control[0].model_dump()
    scene = wall(bonds={"at": 2e-4}, control=[rest, {"polygon": 2, "x": {"velocity": 5e-3}, "record": True}],
                 contact__damping=20, contact__restitution=None)  # fmt: skip
    whole = build(scene)
    whole.advance(600)
    gone = whole.series()["broken bonds ()"]
    assert gone > 0
    for before in (10, 100, 400):
        one, other = resumed(scene, before, 600 - before)
        assert_same_bits(one, other)
        assert_same_bits(whole, other)
        np.testing.assert_array_equal(one.grains.bonds.broken, other.grains.bonds.broken)
    assert validate(Scene, scene_as_dict(scene)) == scene


def test_cracks_lie_along_the_common_side():
    rest = wall().control[0].model_dump()
    pull = {"polygon": 2, "x": {"velocity": 5e-3}, "y": {"velocity": 0.0}, "rotation": {"velocity": 0.0}}
    simulation = build(wall(control=[rest, pull]))
    while simulation.series()["broken bonds ()"] == 0.0:
        assert cracks(simulation.snapshot()) == []
        simulation.advance(20)
    ((x0, y0), (x1, y1)), *more = cracks(simulation.snapshot())
    assert abs(x1 - x0) < 1e-5
    assert abs(y1 - y0) == pytest.approx(SIDE, rel=1e-3)
    assert len(more) <= 1


@pytest.mark.parametrize(
    ("bonds", "line"),
    [
        ({"bodies": ["polygon 7"]}, "bonds[0].bodies[0] = 'polygon 7': there is no such body (allowed: of polygon)"),
        ({"within": [5e-3, 5e-3, 6e-3, 6e-3]}, "bonds[0].at = 0.0 s: nothing touches, so there is nothing to bond"),
        ({"known": [[0, 99, 0, 1.0]]}, "bonds[0].known[0]: there are 12 discs and corners, and 12 segments"),
        ({"known": [[2, 2, 0, 1.0]]}, "bonds[0].known[0]: bonds a body to itself"),
        ({"known": [[1, 4, 0, 1.0], [1, 2, 1, 1.0]]}, "bonds[0].known[1]: bonds a body to itself"),
        ({"known": [[1, 4, 0, 1.0], [4, 1, 0, 1.0]]}, "bonds[0].known[1]: bonds what an earlier row bonds"),
        ({"bodies": ["polygon 7"], "at": 2e-4}, "bonds[0].bodies[0] = 'polygon 7': there is no such body"),
        ({"known": [[0, 99, 0, 1.0]], "at": 2e-4}, "bonds[0].known[0]: there are 12 discs and corners"),
    ],
)
def test_bonds_between_nobody_are_refused(bonds, line):
    for made in (build, report):  # check refuses what run would
        assert refusals(lambda made=made: made(wall(bonds=bonds)))[0].startswith(line)


def test_known_bonds_between_what_does_not_touch_are_warned_of():
    def said(other):
        lines = build(wall(bonds=[{"known": [[0, other, 0, 1.0]]}])).part(BondsPart).doubts()
        return [line for line in lines if "does not touch" in line]

    (line,) = said(10)
    assert line.startswith(
        "bonds between what does not touch break in their first step: 1 of bonds.known, such as [0, 10,"
    )
    simulation = build(wall(bonds=[{"known": [[0, 10, 0, 1.0]]}]))
    simulation.advance(1)
    assert simulation.series()["broken bonds ()"] == 1.0
    made = build(wall(bonds=[{}]))
    assert not [line for line in made.part(BondsPart).doubts() if "does not touch" in line]  # the check that must fail


ROCK: dict[str, Any] = {
    "grains": {"density": 2500, "packing": {
        "left": 0.05, "bottom": 0.05, "width": 0.2, "height": 0.2, "diameter": 0.04, "size_spread": 0.25,
        "packing_fraction": 0.84, "pressure": 16e3, "seed": 2}},
    "domain": {"width": 0.3, "height": 0.3}, "gravity": [0, 0], "contact": {
        "stiffness": 1e7, "tangential_stiffness": 2.5e6, "damping": 3e3, "tangential_damping": 1.5e3, "friction": 0.5},
}  # fmt: skip


def rock(kind: str, domain: dict[str, float] | None = None, **more: Any) -> Scene:
    """A rock of some 26 discs, or polygons of them."""
    own = {} if kind == "discs" else {"gap": 2e-3, "pressed": 8e-5}
    return framed(
        **ROCK | ({"domain": domain} if domain else {}), rock={"kind": kind, **own, **more}, output__energy=False
    )


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["discs", "triangles", "cells"])
def test_rock_is_made_of_the_packing_and_bears_a_pull(kind):
    simulation = build(rock(kind, strain=[[0, 0], [2e-3, 2e-4]]))
    kinds = [it.kind for it in simulation.frames]
    assert kinds[-2:] == ["plate", "plate"]
    if kind != "discs":
        assert len(simulation.snapshot().clouds) == 2  # frames and bonds: no disc is left
        solid = simulation.grains.steering.clumps.area[:-2].sum()
        # Sides stand 2 mm apart: of the sample, 0.2 m, that is 1 % for each of some 4 (cells) to 6 bodies across.
        assert 0.80 * 0.2**2 < solid < 0.96 * 0.2**2
    own, discs = simulation.derived.law, rock_discs(rock("discs"), simulation.derived.law)
    polygons = {} if kind == "discs" else {"gap": 2e-3, "pressed": 8e-5}
    by_hand = made_by_hand(kind, discs, (0.05, 0.05), (0.25, 0.25), own, 2500.0, **polygons)
    # The same sample as in Python, elsewhere in its box; places to eps of 0.25 m, overlaps of 4e-5 m.
    assert simulation.series()["bonds ()"] == by_hand.bonds > 16
    back = simulation.grains.bonds.back
    assert back[back > 0].mean() == pytest.approx(by_hand.tension, rel=1e-10)
    assert simulation.tables()["rock"]["stress (Pa)"] == 0.0
    simulation.advance(round(2e-3 / simulation.step_seconds))
    row = simulation.tables()["rock"]
    assert row["strain ()"] == pytest.approx(
        min(0.1 * simulation.time, 2e-4), rel=1e-9
    )  # places to eps of 0.2 m, by 2e-5 m
    # A fifth of what parts a contact of 16 kPa: it bears, by a stiffness of 0.1 to 10 contacts' (1e7 Pa).
    assert 2e-4 * 1e6 < row["stress (Pa)"] < 2e-4 * 1e8


def test_bonds_of_what_a_rock_has_bonded_are_refused():
    with pytest.raises(InputError) as caught:  # it touches, so that bodies closer would not help
        build(rock("discs", strain=None).with_({"bonds": [{}]}))
    assert str(caught.value) == (
        "bonds[0].at = 0.0 s: nothing touches that is not bonded already, so there is nothing to bond; "
        "leave it out, or bond later"
    )


@pytest.mark.parametrize(("strain", "least"), [([[0, 0], [1, -2]], -2), ([[0, 0.5], [1, -0.5]], -1)])
def test_a_strain_that_presses_a_rock_to_nothing_is_refused(strain, least):
    (line,) = refusals(lambda: rock("discs", strain=strain))
    assert line.startswith(f"rock.strain = {float(least)}: presses the sample to nothing (allowed: > -1)")
    assert rock("discs", strain=[[0, 0.5], [1, -0.4]]).rock


@pytest.mark.parametrize("kind", ["discs", "cells"])
def test_a_rock_that_the_box_would_press_is_refused_and_one_that_stands_free_is_at_rest(kind):
    """A sample as large as the box was pressed by its sides, and stood at several times its strength without strain."""
    packing = ROCK["grains"]["packing"] | {"left": 0.0, "bottom": 0.0, "width": 0.3, "height": 0.3}
    own = {} if kind == "discs" else {"gap": 2e-3, "pressed": 8e-5}
    filled = ROCK | {"grains": {"density": 2500, "packing": packing}}
    (line,) = refusals(lambda: framed(**filled, rock={"kind": kind, **own}))
    assert line.startswith("rock: reaches the sides of the box")
    assert all(f"domain.{side}" in line for side in ("left", "right", "bottom", "top"))
    simulation = build(rock(kind))
    simulation.advance(50)
    # Round-off of overlaps of a sample 0.3 m wide, times the springs of a plate's 10 contacts, over its 0.2 m
    assert abs(simulation.tables()["rock"]["stress (Pa)"]) < 10 * 1e7 * 0.3 * np.finfo(float).eps / 0.2


@pytest.mark.parametrize("kind", ["discs", "cells"])
@pytest.mark.parametrize("key", ["grains.grain[0]", "disc[0]", "clump[0]", "polygon[0]", "segment[0]", "container[0]"])
def test_what_stands_in_a_rock_is_refused_and_beside_it_is_not(kind, key):
    """A disc in a rock of cells was bonded by the run, and threw it apart in the first steps."""

    def beside(y):
        name = key.split("[")[0].split(".")[-1]
        made = {
            "grain": grain(0.15, y), "disc": {"x": 0.15, "y": y, "diameter": 2e-3},
            "clump": {"discs": [[-1e-3, 0, 1e-3], [1e-3, 0, 1e-3]], "at": [[0.15, y]]},
            "polygon": {"sides": 4, "diameter": 4e-3, "thickness": 1e-3, "at": [[0.15, y]]},
            "segment": {"ends": [[-2e-3, 0, 2e-3, 0]], "thickness": 1e-3, "at": [[0.15, y]]},
            "container": {"ends": [[0.02, y, 0.28, y]], "thickness": 1e-3},
        }[name]  # fmt: skip
        grains = ROCK["grains"] | ({"grain": [made]} if name == "grain" else {})
        return rock(kind).with_({"grains": grains} | ({} if name == "grain" else {name: [made]}))

    (line,) = refusals(lambda: derive(beside(0.15)))
    assert line.startswith(f"{key}: stands in the sample of [rock]")
    assert derive(beside(0.285)).corners >= 0


def test_a_plate_needs_room_for_its_way():
    (line,) = refusals(lambda: rock("discs", strain=[[0, 0], [1, 0.25]]))  # 0.05 m and its own 0.02 m
    assert "leave 0.07 m from domain.right:" in line
    assert rock("discs", strain=[[0, 0], [1, 0.14]]).rock


def test_sides_pressed_deeper_than_their_gap_are_refused():
    lines = refusals(lambda: rock("cells", pressed=2.1e-3))
    assert lines[0].startswith("rock.pressed = 0.0021 m: presses sides so deep")
    assert rock("cells", pressed=2e-3).rock


def test_the_speed_to_expect_of_a_rock_is_that_of_its_plate():
    pulled = derive(rock("discs", strain=[[0, 0], [1e-2, 2]], domain={"width": 0.75, "height": 0.3}))
    assert pulled.speed == pytest.approx(2 / 1e-2 * 0.2)
    assert any("contacts are too soft" in line for line in pulled.warnings)


def test_rock_without_a_pressed_packing_is_refused():
    packing = {**ROCK["grains"]["packing"], "pressure": None, "settle": False, "packing_fraction": 0.5}
    with pytest.raises(InputError) as caught:
        derive(framed(**{**ROCK, "grains": {"density": 2500, "packing": packing}}, rock={"kind": "discs"}))
    assert [fault.key for fault in caught.value.faults] == ["rock"]


def test_a_rocks_picture_counts_the_breaks_of_its_table(tmp_path):
    class Run:
        name = "rock"

        def __init__(self, rows: int) -> None:
            self.rows = rows

        def table(self, name: str) -> dict[str, Any]:
            strain = np.linspace(0, 1e-3, self.rows)
            return {"strain ()": strain, "stress (Pa)": 1e8 * strain, "broken bonds ()": np.arange(self.rows) // 2}

    assert write_rock_picture(Run(1), tmp_path) == []  # type: ignore[arg-type]
    (path,) = write_rock_picture(Run(11), tmp_path)  # type: ignore[arg-type]
    assert path.read_bytes().startswith(b"\x89PNG")
    table = Run(11).table("rock")
    figure = drawn(*(table[name] for name in ("strain ()", "stress (Pa)", "broken bonds ()")), "rock")
    stress, counts = figure.axes
    assert "(kPa)" in stress.get_ylabel()
    assert sum(bar.get_height() for bar in counts.patches) == 5.0
    assert "5 in all" in counts.get_ylabel()


def pair(stiffness: float, bonds: dict[str, Any] | None, *, pulled: bool = False) -> Scene:
    """Two discs of 20 mm, 0.39 kg/m reduced, that overlap by 10 nm, or drift apart at 20 mm/s."""
    speed, discs = 0.01 if pulled else 0.0, []
    for side in (-1, 1):
        discs.append({"x": 0.05 + side * (0.01 - 5e-9), "y": 0.05, "diameter": 0.02, "velocity": [side * speed, 0.0]})
    return loose(
        *discs, domain={"width": 0.1, "height": 0.1}, gravity=[0, 0], bonds=bonds, output__energy=True,
        contact={"stiffness": stiffness, "restitution": 1.0},
    )  # fmt: skip


def test_bonds_that_the_steps_do_not_resolve_are_warned_of_before_the_first_one():
    # 50 N/m on a contact of 1e5 N/m * 10 nm = 1 mN/m.  In a step of 0.62 ms they move by 50 * dt^2/0.39 = 50 um.
    said = [it for it in report(pair(1e5, {"tension": 50.0})).warnings if "bond" in it]
    assert len(said) == 1
    assert said[0].startswith("a bond of 50 N/m is 5e+04 times what its contact carries")
    # What is said: the break makes energy, of order b^2 dt^2/m, out of nothing.
    simulation = build(pair(1e5, {"tension": 50.0}, pulled=True))
    before = simulation.series()["kinetic energy of grains (J/m)"]
    while simulation.step < 200 and simulation.series()["broken bonds ()"] == 0.0:
        simulation.advance(1)
    row = simulation.series()
    assert row["broken bonds ()"] == 1.0
    assert row["kinetic energy of grains (J/m)"] > 1.5 * before
    assert abs(row["residual (J/m)"]) > 0.5 * before


def test_bonds_that_press_bodies_into_each_other_are_warned_of():
    # 50 N/m on 2e4 N/m: 2 b/k = 5 mm, half of the radius; on 5e4 2 mm, a fifth.
    said = [it for it in report(pair(2e4, {"tension": 50.0})).warnings if "into each other" in it]
    assert len(said) == 1
    assert (
        "by up to 0.005 m, and beyond 0.003 m, 0.3 of the radius, a run stops: contacts 1.8 times as stiff" in said[0]
    )
    simulation = build(pair(2e4, {"tension": 50.0}))
    simulation.advance(6)  # half of a period, pi (m/k)^(1/2) = 14 ms with 0.39 kg/m, is 10 steps of 1.4 ms
    with pytest.raises(Unstable, match="overlap with grain 1 over radius"):
        simulation.check()
    assert not [it for it in report(pair(5e4, {"tension": 50.0})).warnings if "into each other" in it]


def test_bonds_that_are_made_later_are_warned_of_when_they_are_made():
    later = {"at": 1.2e-3}  # before the third step of 0.62 ms; their contact lasts for five
    simulation = build(pair(1e5, {**later, "tension": 50.0}))
    simulation.advance(1)
    with pytest.warns(PorescaleWarning, match="t = 0.0012.* s: a bond of 50 N/m is .* times what its contact carries"):
        simulation.advance(2)
    assert simulation.series()["bonds ()"] == 1.0
    with pytest.warns(PorescaleWarning, match=r"bonds\[0\] makes no bond, as nothing touches"):
        build(pair(1e5, {"at": 5e-3, "tension": 50.0})).advance(10)
    with warnings.catch_warnings(action="error"):  # the twin that must fail
        build(pair(1e5, later)).advance(6)


@pytest.mark.parametrize("bonds", [{}, {"factor": 1.5}, {"factor": 5.0}])
def test_bonds_that_are_about_as_strong_as_their_contacts_are_not_warned_of(bonds):  # the twin that must fail
    assert not [it for it in report(pair(1e5, bonds)).warnings if "bond" in it]
    assert not [it for it in report(wall(bonds=bonds)).warnings if "bond" in it]
