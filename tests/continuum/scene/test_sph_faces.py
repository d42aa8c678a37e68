"""Sides of the tank that water passes at a given head: flow as Darcy's law has it, resumed, refused, stopped."""

import numpy as np
import pytest

from continuum_sph.builders.parts import pore_water
from continuum_sph.builders.parts.faces import FARTHEST, FacePart
from continuum_sph.builders.parts.sheet_pile import given_heads, sheet_pile
from continuum_sph.builders.report import report
from continuum_sph.builders.reports.seepage_report import gradients, moments, reached
from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.face import FaceSection
from continuum_sph.scene.sections import Scene
from continuum_sph.seepage import pores
from continuum_sph.validation.seepage.sheet_pile import SheetPile
from porescale.common.core.errors import InputError, Unstable
from porescale.common.schema.sections import validate
from tests.reference.continuum.part_of_a_side import discharge
from tests.reference.same_run import leaves

K = 1e-3  # m/s
WIDE, HIGH, SPACING = 0.5, 0.4, 0.05


def ground(width, height):
    return {"held": True, "saturated": True, "permeability": K,
            "body": [{"outline": [[0, 0], [width, 0], [width, height], [0, height]]}]}  # fmt: skip


def scene(faces, *, soil=None, **changes):
    table = {
        "tank": {"width": WIDE, "height": HIGH},
        "water": {"sound_speed": 150.0},
        "soil": ground(WIDE, HIGH) | (soil or {}),
        "face": faces,
        "numerics": {"spacing": SPACING},
        "time": {"end": 0.3},
        "output": {"snapshot_interval": 0.1, "series_interval": 0.1},
    }
    return validate(Scene, table | changes)


def pair(one, other, fall):
    return [{"name": "high", "side": one, "head": 1.0 + fall}, {"name": "low", "side": other, "head": 1.0}]


def steady(given, seconds=0.3):
    """The model then, and the last row of its series.csv."""
    model = Simulation(given)
    return model, at(model, seconds)


def at(model, seconds):
    """The last row of series.csv of a model that has gone on until then."""
    while model.time < seconds:
        model.advance(50)
    model.check()
    return model.series()


@pytest.mark.parametrize(
    ("one", "other", "along", "across"), [("left", "right", WIDE, HIGH), ("floor", "lid", HIGH, WIDE)]
)  # fmt: skip
def test_flow_between_two_sides_is_darcys(one, other, along, across):
    """A linear head is exact for the faces and for corrected gradients.  Each face is known to a twentieth of a
    spacing, by so much of a row's fall the heads beside it zig-zag: two of them are 1.25 % of eight rows.  It lasts, as
    particles behind the faces go along with the water: where they stay 8 and 10 % are lost by then."""
    exact = K * 0.2 / along * across
    _, row = steady(scene(pair(one, other, 0.2)), 0.4)
    assert row["high flow in (m2/s)"] == pytest.approx(exact, rel=0.0125)
    assert row["low flow in (m2/s)"] == pytest.approx(-exact, rel=0.0125)


def test_flow_is_darcys_under_a_small_fall_too(monkeypatch):
    """The lid is the ground's surface, where water flows out at no pressure.  1.25 %, as above, however small the fall
    is beside the weight of the water, which moves nothing: it drove 14 and 21 % more in and out under this one."""
    fall = 0.05 * HIGH
    faces = [{"name": "high", "side": "floor", "head": HIGH + fall}, {"name": "low", "side": "lid", "head": HIGH}]
    exact = K * fall / HIGH * WIDE

    def flows():
        _, row = steady(scene(faces), 0.4)
        return row["high flow in (m2/s)"] / exact, -row["low flow in (m2/s)"] / exact

    assert flows() == pytest.approx((1.0, 1.0), abs=0.0125)
    # the check that fails: corners behind the lid that push, as walls do before dry ground
    monkeypatch.setattr(pores, "continue_behind", lambda *given: None)
    assert flows()[1] > 1.03


def test_flow_is_darcys_where_the_lower_head_is_as_high_as_the_lid(monkeypatch):
    """Each face is known to a twentieth of a spacing, as above: 1.25 % of eight rows.  Water under the lid flows to
    where it has no pressure; what is over the lid continues that below zero."""
    faces = [{"name": "high", "side": "left", "head": HIGH + 0.05}, {"name": "low", "side": "right", "head": HIGH}]
    exact = K * 0.05 / WIDE * HIGH

    def flows():
        _, row = steady(scene(faces), 0.4)
        return row["high flow in (m2/s)"] / exact, -row["low flow in (m2/s)"] / exact

    assert flows() == pytest.approx((1.0, 1.0), abs=0.0125)
    # the check that fails: a lid that does not pull, and so pushes water out beside the lower face
    monkeypatch.setattr(pore_water, "stays_full", lambda scene, count: False)
    assert flows()[1] > 1.1


def test_a_lid_pulls_in_tanks_that_stay_full_alone():
    high = {"name": "high", "side": "left", "head": HIGH + 0.05}
    rising = {"side": "right", "rise": [[0.0, HIGH], [1.0, HIGH + 0.1]]}
    for face, lowest in ((rising, True), ({"side": "floor", "head": 0.5 * HIGH}, False)):
        water = Simulation(scene([high, face])).flow.water
        over = water.layer.x[water.enclosing, 1] > HIGH
        inside = (water.layer.x[water.enclosing, 0] > 0.0) & (water.layer.x[water.enclosing, 0] < WIDE)
        assert bool((over & inside).any()) is lowest


@pytest.mark.parametrize("sides", [("left", "right"), ("floor", "lid")])
def test_flow_in_a_closed_tank_does_not_depend_on_the_depth_of_both_heads(sides, monkeypatch):
    """Water that fills a tank rests under the lowest of its heads before it flows.  What more it bears then, the fall,
    presses it together by g Δh/c² = 10⁻⁴; each face as at any depth, 1.25 %."""
    along, across = (WIDE, HIGH) if sides[0] == "left" else (HIGH, WIDE)
    exact = K * 0.2 / along * across
    deep = [face | {"head": face["head"] + 8.0} for face in pair(*sides, 0.2)]

    def flow():
        return steady(scene(deep, water={"sound_speed": 134.0}), 0.3)[1]["high flow in (m2/s)"]  # 10 sqrt(2 g h)

    assert flow() == pytest.approx(exact, rel=0.0125)
    # the check that fails: water that rests under the lid alone, and is pressed together by 0.5 % as it starts
    monkeypatch.setattr(pore_water, "head_on_lid", lambda scene, count: 0.0)
    assert flow() < 0.98 * exact


def passing(sides, share):
    """Flow in and out, over Darcy's, when so much of a spacing has passed, in ground that lets much through.

    A third of a second or more, in which what moves at the start dies as exp(-n g t/2k), at a porosity n of 0.4 by
    e⁻²⁰; the head of the speed there, v²/2g, is 10⁻⁴ m.
    """
    through = 30 * K
    model = Simulation(scene(pair(*sides, 0.2), soil={"permeability": through}))
    part = model.part(FacePart)
    while max(part.passed(face) for face in part.faces) < share * SPACING:
        model.advance(20)
    along, across = (WIDE, HIGH) if sides[0] == "left" else (HIGH, WIDE)
    exact, row = through * 0.2 / along * across, model.series()
    return row["high flow in (m2/s)"] / exact, -row["low flow in (m2/s)"] / exact


@pytest.mark.parametrize("sides", [("left", "right"), ("floor", "lid")])
def test_flow_stays_darcys_until_a_quarter_of_a_spacing_has_passed(sides, monkeypatch):
    """As at the start: 1.25 %.  The room of the water at a face ends where its particles do, not at the side."""
    assert passing(sides, 0.25) == pytest.approx((1.0, 1.0), abs=0.0125)
    # the check that fails: rooms that end at the sides, of which water that has come nearer takes up too much
    monkeypatch.setattr(pores.PoreFlow, "edges_at", lambda self, x: (self.lower, self.upper))
    assert passing(sides, 0.25)[1] > 1.15


def test_room_at_a_face_goes_along_with_the_water_and_nothing_beside_it_does():
    given = scene([{"side": "left", "head": 1.2, "start": 0.1, "end": 0.3}, {"side": "lid", "head": 1.0}])
    water = Simulation(given).flow.water
    x = np.array([[0.1, 0.2], [0.1, 0.05], [0.1, 0.35], [0.4, 0.3]])
    for edge, own in zip(water.edges_at(x), (water.lower, water.upper), strict=True):
        np.testing.assert_array_equal(edge, np.repeat(own[:, None], 4, axis=1))  # nothing has passed yet
    one, other = (face.columns for face in water.faces)
    water.layer.x[one] += [0.01, 0.0]
    water.layer.x[other] += [0.0, 0.02]
    lower, upper = water.edges_at(x)
    # to a rounding of lengths of the tank
    np.testing.assert_allclose(lower, [[0.01, 0.0, 0.0, 0.0], np.zeros(4)], atol=1e-15)
    np.testing.assert_allclose(upper, [np.full(4, WIDE), np.full(4, HIGH + 0.02)], atol=1e-15)


@pytest.mark.slow
def test_flow_converges_and_falls_where_particles_behind_a_face_stay(monkeypatch):
    def flow():
        _, row = steady(scene(pair("left", "right", 0.2), numerics={"spacing": 0.025}), 0.6)
        return row["high flow in (m2/s)"] / (K * 0.2 / WIDE * HIGH)

    assert flow() == pytest.approx(1.0, abs=0.5 * 0.0125)
    monkeypatch.setattr(pores, "follow", lambda *given: None)  # the check that fails
    assert flow() < 0.95


def test_nothing_flows_where_heads_are_alike_nor_where_there_is_one_face():
    """Water at rest under its own weight: heads beside the faces are off by 1 mm, 1/200 of the difference that drives
    what is compared with."""
    little = 5e-3 * K * 0.2 / WIDE * HIGH
    assert abs(steady(scene(pair("left", "right", 0.0)))[1]["high flow in (m2/s)"]) < little
    alone = [{"name": "high", "side": "left", "head": 1.2}]
    assert abs(steady(scene(alone))[1]["high flow in (m2/s)"]) < little
    # the check that fails: with the other face it flows
    assert abs(steady(scene(pair("left", "right", 0.2)))[1]["high flow in (m2/s)"]) > 180 * little


def test_flow_under_a_pile_is_within_three_per_cent():
    """A face is known to half a spacing beside the pile, where as much flows as the exit gradient says: with 16 rows
    1/32 · 0.626/0.462, 4 % of the discharge; held to 3 %."""
    rows, fall = 16, 0.5
    spacing = 1.0 / rows
    width = (2 * rows + 1) * spacing
    faces = [{"name": "up", "side": "lid", "end": 1.0, "head": 1.0 + fall},
             {"name": "down", "side": "lid", "start": 1.0 + spacing, "head": 1.0}]  # fmt: skip
    given = scene(
        faces, soil=ground(width, 1.0), tank={"width": width, "height": 1.0}, numerics={"spacing": spacing},
        water={"sound_speed": 250.0}, pile={"x": 0.5 * width, "tip": 0.5},
    )  # fmt: skip
    model, row = steady(given, 0.35)
    assert not any(its.size for its in model.part(FacePart).past)  # faces end at the pile, not amid a side
    exact = SheetPile(0.5, rows)
    assert row["up flow in (m2/s)"] == pytest.approx(exact.discharge * K * fall, rel=0.03)
    assert row["down flow in (m2/s)"] == pytest.approx(-exact.discharge * K * fall, rel=0.03)
    assert row["exit gradient ()"] == pytest.approx(exact.exit_gradient * fall, rel=0.03)
    shallow = SheetPile(0.35, rows)  # the check that fails: of a pile 2.4 rows shorter
    assert row["up flow in (m2/s)"] != pytest.approx(shallow.discharge * K * fall, rel=0.03)


def test_flow_through_a_face_that_ends_amid_a_side_is_what_comes_out_of_the_other(monkeypatch):
    """An end is known to half a spacing, as above.  Wall particles of the face alone miss 11 % of it (10 rows): what
    passes its end spreads along the side."""
    spacing, fall = 0.1, 0.3
    faces = [{"name": "high", "side": "left", "head": 1.2 + fall, "end": 0.5},
             {"name": "low", "side": "right", "head": 1.2}]  # fmt: skip
    given = scene(faces, soil=ground(1.0, 1.0), tank={"width": 1.0, "height": 1.0}, numerics={"spacing": spacing},
                  water={"sound_speed": 250.0})  # fmt: skip
    model, row = steady(given, 0.2)
    exact = K * fall * discharge(0.5)
    within = K * fall * discharge(0.5 + 0.5 * spacing) - exact
    assert row["high flow in (m2/s)"] == pytest.approx(exact, abs=within)
    assert row["low flow in (m2/s)"] == pytest.approx(-exact, abs=within)
    part = model.part(FacePart)
    monkeypatch.setattr(part, "past", [its[:0] for its in part.past])  # the check that fails
    assert model.series()["high flow in (m2/s)"] < exact - 2.0 * within


def test_walls_between_two_faces_of_a_side_belong_to_the_nearer():
    faces = [{"name": "high", "side": "left", "head": 1.5, "end": 0.4},
             {"name": "low", "side": "left", "head": 1.2, "start": 0.6}]  # fmt: skip
    given = scene(faces, soil=ground(1.0, 1.0), tank={"width": 1.0, "height": 1.0}, numerics={"spacing": 0.1},
                  water={"sound_speed": 250.0})  # fmt: skip
    part = Simulation(given).part(FacePart)
    assert [part.flow.home[its, 1].round(3).tolist() for its in part.past] == [[0.45], [0.55]]


def test_flow_follows_a_head_that_rises():
    """The same as at a constant head once it has risen: what is left of the rise falls as exp(-π² D t/L²), of which
    there are 7 in 0.3 s."""
    low = {"name": "low", "side": "right", "head": 1.0}
    high = {"name": "high", "side": "left", "rise": [[0.1, 1.0], [0.2, 1.2]]}
    model, early = steady(scene([high, low]), 0.15)
    exact = K * 0.2 / WIDE * HIGH
    assert early["high flow in (m2/s)"] != pytest.approx(exact, rel=0.1)  # the check that fails: half of the rise
    assert at(model, 0.5)["high flow in (m2/s)"] == pytest.approx(exact, rel=0.0125)


def test_heads_that_stay_are_not_set_again():
    rising, staying = (
        Simulation(scene([{"side": "left"} | head])).part(FacePart)
        for head in ({"rise": [[0.0, 1.0], [1.0, 1.2]]}, {"head": 1.0})
    )
    assert len(rising.rising) == 1
    assert staying.rising == []


@pytest.mark.parametrize("high", [{"head": 1.3}, {"rise": [[0.0, 1.0], [1e-3, 1.3]]}])
def test_a_run_with_faces_goes_on_bit_for_bit(high):
    faces = [{"side": "floor"} | high, {"side": "lid", "head": 1.0}]
    whole, part = (Simulation(scene(faces)) for _ in range(2))
    whole.advance(12)
    part.advance(5)
    resumed = Simulation(scene(faces))
    resumed.restore(part.state())
    resumed.advance(7)
    assert dict(leaves(whole.state())) == dict(leaves(resumed.state()))
    assert whole.series() == resumed.series()


def test_soil_that_may_move_settles_as_water_leaves_it():
    """Water that flows down through an elastic layer presses it on its floor: at the top by the settlement
    ∫ i ρ g z/M dz = Δh ρ g H/2M.  The height that bears is uncertain by half of one of 8 rows, 1 - (1 - 1/16)² = 12 %,
    and 3 % are for swings (0.96 of it measured, from 0.1 to 0.4 s)."""
    fall, modulus = 0.2, 1e6 * 0.7 / (1.3 * 0.4)
    soil = {"held": False, "elastic": True, "stiffness": 1e6, "permeability": 5e-3, "stress": "geostatic"}
    low = {"name": "low", "side": "floor", "head": HIGH}
    given, same = (
        scene([{"name": "high", "side": "lid", "head": head}, low], soil=soil) for head in (HIGH + fall, HIGH)
    )

    def top(model):
        x = model.flow.water.skeleton.x
        return float(x[x[:, 1] > HIGH - SPACING, 1].mean())

    settled = top(steady(same)[0]) - top(steady(given)[0])
    assert settled == pytest.approx(fall * 9806.65 * HIGH / (2.0 * modulus), rel=0.15)


def test_a_run_stops_when_the_water_at_a_face_is_used_up():
    model = Simulation(scene(pair("left", "right", 0.3), soil={"permeability": 0.2}))
    part = model.part(FacePart)
    while max(part.passed(face) for face in part.faces) < FARTHEST * SPACING:
        model.check()
        model.advance(20)
    with pytest.raises(Unstable, match="distance that water has moved through the face"):
        model.check()


def test_check_says_when_that_will_be_and_when_water_is_too_soft():
    said = " ".join(report(scene(pair("left", "right", 0.3), soil={"permeability": 0.2})).warnings)
    assert "the run stops" in said
    soft = " ".join(report(scene(pair("left", "right", 0.3), water={"sound_speed": 20.0})).warnings)
    assert "mends it" in soft
    assert "water.sound_speed" in soft
    assert not report(scene(pair("left", "right", 0.3))).warnings
    # one face under open ground, by which water leaves; in a high tank
    rising = scene(
        [{"side": "floor", "head": 1.0}], soil={"permeability": 0.2}, tank={"width": WIDE, "height": 4.0, "lid": False}
    )
    said = " ".join(report(rising).warnings)
    assert "the run stops" in said
    assert "mends it" not in said
    # half a spacing passes sooner at a constant head than at one that rises to it
    given = [scene([{"side": "left", "rise": [[0.0, low], [2.0, 1.2]]}, {"side": "right", "head": 1.0}],
                   time={"end": 2.0}) for low in (1.0, 1.2)]  # fmt: skip
    times, steep = moments(given[0]), 0.2 / (WIDE - SPACING)
    rising, staying = (gradients(it, times)[0].steep for it in given)
    assert reached(times, staying, steep) == pytest.approx(1.0)
    # t²/4 of the last gradient;  of 100 straight pieces the root is known to (1/100)²/8 of the square
    assert reached(times, rising, 0.5 * steep) == pytest.approx(np.sqrt(2.0), rel=1e-4)
    assert reached(times, rising, 2.0 * steep) == pytest.approx(3.0)
    loose = scene(pair("floor", "lid", 0.2), soil={"held": False, "stiffness": 1e7})
    assert any("passes through it" in it for it in report(loose).warnings)


def test_a_lid_has_no_particles_where_a_pile_stands_for_them():
    width = 21 * SPACING
    faces = [{"side": "lid", "end": 0.5, "head": 0.9}, {"side": "lid", "start": 0.55, "head": 0.8}]
    given = scene(
        faces, soil=ground(width, 0.8), tank={"width": width, "height": 0.8}, pile={"x": 0.5 * width, "tip": 0.4}
    )
    water = Simulation(given).flow.water
    standing = sheet_pile(given.pile, SPACING)
    walls = water.layer.x[water.layer.fluid :]
    there = walls[standing.holds(walls) & (walls[:, 1] > 0.8)]
    _, often = np.unique(np.round(there / SPACING, 6), axis=0, return_counts=True)
    assert often.max() == 2  # the pile's own: one seen from its left, one from its right


def test_the_heads_over_the_ground_beside_a_pile_are_those_of_the_nearest_faces():
    size, x = (2.0, 1.0), 1.0
    faces = [FaceSection(name="", side="lid", head=head, start=start, end=end) for head, start, end in
             ((1.5, 0.6, 0.9), (1.2, 0.0, 0.5), (1.0, 1.5, 2.0), (1.1, 1.05, 1.5))]  # fmt: skip
    assert given_heads(faces, x, size, SPACING) == (1.5, 1.1)
    assert given_heads(faces[1:3], x, size, SPACING) == (None, None)  # too far away to stand over it


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"soil": {"saturated": False}}, "needs ground whose pores are full; give soil.saturated = true"),
        ({"face": [{"side": "lid", "head": 1.0}], "tank": {"width": WIDE, "height": HIGH, "lid": False}}, "open tank"),
        ({"face": [{"side": "lid", "head": 1.0, "end": 0.6}]}, "lies beyond the side"),
        ({"face": [{"side": "left", "head": 1.0, "start": 0.35}]}, "fewer than 2 rows"),
        ({"face": [{"side": "left", "head": 1.0}, {"side": "left", "head": 0.5, "start": 0.1}]}, "overlaps face[0]"),
        ({"face": [{"side": "left", "head": 1.0, "name": "a"}, {"side": "right", "head": 0.5, "name": "a"}]},
         "that of another face"),
        ({"face": [{"side": "left", "head": 1.0, "name": "face 1"}, {"side": "right", "head": 0.5}]},
         "that of another face"),
        ({"face": [{"side": "left", "head": 1.0, "start": 5.0}]}, "start = 5.0 m: lies beyond the side"),
        ({"face": [{"side": "left", "head": 1.0, "start": 0.3, "end": 0.1}]}, "allowed: >= 0.4"),
        ({"tank": {"width": WIDE, "height": 0.6}, "face": [{"side": "lid", "head": 1.0}]}, "not along ground"),
        ({"face": [{"side": "lid", "head": 0.3}]}, "makes the pressure at its upper end negative"),
        ({"face": [{"side": "lid", "rise": [[0, 0.5], [1, 0.3]]}]}, r"rise = 0.3 m: makes the pressure"),
        ({"face": [{"side": "lid"}]}, "needs a head or a rise, and not both"),
        ({"face": [{"side": "lid", "head": 1.0, "rise": [[0, 1.0]]}]}, "needs a head or a rise, and not both"),
        ({"face": [{"side": "lid", "rise": [[1, 1.0], [1, 1.1]]}]}, "has times that do not rise"),
        ({"gravity": 0.0}, "needs gravity"),
    ],
)  # fmt: skip
def test_faces_that_cannot_be_are_refused(changes, said):
    faces = changes.pop("face", pair("left", "right", 0.2))
    soil = changes.pop("soil", {})
    with pytest.raises(InputError, match=said.replace("[", r"\[")):
        scene(faces, soil=soil, **changes)


def test_a_scene_without_faces_builds_none():
    pool = {"left": 0, "right": 0.2, "bottom": 0.4, "level": 0.5}
    given = scene([], tank={"width": 0.5, "height": 0.6}, reservoir=[pool])
    model = Simulation(given)
    assert model.flow.water.faces == []
    assert not any(isinstance(part, FacePart) for part in model.parts)
    assert not any("flow in" in name for name in model.series())
    model.advance(5)
    water = model.flow.water
    assert np.array_equal(water.layer.x[water.layer.fluid :], water.home[water.layer.fluid :])
