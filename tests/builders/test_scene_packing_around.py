"""Packings are made around what stands in their rectangle: discs, grains and clumps, rectangles, bodies of segments."""

import copy
import warnings
from typing import Any

import numpy as np
import pytest

from porescale.builders.build import build
from porescale.builders.derive import derive
from porescale.builders.initial.frames import placed_frames
from porescale.builders.initial.obstacles import obstacles_of
from porescale.builders.initial.packing import settled_void_ratio
from porescale.builders.initial.placed import packed_count
from porescale.builders.report import report
from porescale.builders.simulation import Simulation
from porescale.common.compiled import jit
from porescale.common.core.errors import PorescaleWarning
from porescale.dem.prepare.obstacles import Obstacles
from porescale.scene.scene import Scene
from tests.reference.scenes import dry, grain, refusals

BED = {"left": 0.0, "width": 0.012, "height": 0.005, "diameter": 0.0008, "packing_fraction": 0.7, "settle": True}
DISC = {"x": 0.006, "y": 0.002, "diameter": 0.002}
SOLID = {"corners": [[0.004, 0.001], [0.008, 0.0015], [0.006, 0.0035]], "thickness": 1e-4}
FUNNEL = {"ends": [[0.0005, 0.0045, 0.005, 0.0015], [0.0115, 0.0045, 0.007, 0.0015]], "thickness": 0.0}
BODIES: dict[str, dict[str, Any]] = {
    "held disc": {"disc": [DISC]},
    "towed disc": {"disc": [{**DISC, "velocity": [0.01, 0.0]}]},
    "grain": {"grains__grain": [grain(0.006, 0.002, 0.0015)]},
    "clump": {"clump": [{"discs": [[0, 0, 0.0008], [0.0008, 0, 0.0008]], "at": [[0.003, 0.002], [0.008, 0.003]]}]},
    "rectangle on the floor": {"rectangle": [{"lower": [0.004, 0.0], "upper": [0.006, 0.003]}]},
    "rectangle amid": {"rectangle": [{"lower": [0.003, 0.001], "upper": [0.007, 0.002]}]},
    "held polygon": {"polygon": [{**SOLID, "held": True}]},
    "free polygon": {"polygon": [SOLID]},
    "funnel": {"container": [FUNNEL]},
    "all of them": {"polygon": [{**SOLID, "held": True}], "disc": [{**DISC, "x": 0.001}],
                    "grains__grain": [grain(0.0105, 0.003)]},
}  # fmt: skip
STEPS = 200
every_body = pytest.mark.parametrize("bodies", BODIES.values(), ids=BODIES)


def bed(**changes: Any) -> Scene:
    """A dry bed over the whole floor of the box, settled, with what is put into it."""
    return dry(**{"grains__packing": BED, **changes})


def around(scene: Scene) -> Obstacles:
    """What the packing of a scene is made around."""
    return obstacles_of(scene, placed_frames(scene))


def deepest(scene: Scene, simulation: Simulation) -> float:
    """How deep (m) a grain of the packing lies in what stands there."""
    assert simulation.grains
    discs, count = simulation.grains.discs, packed_count(scene)
    x, r = discs.position[:count], discs.radius[:count]
    return float((around(scene).depth(x, 1.0) + r).max())


@every_body
def test_no_grain_of_a_packing_lies_in_what_stands_there(bodies: dict[str, Any]) -> None:
    scene = bed(**bodies)
    simulation = build(scene)
    assert simulation.grains
    # No contact bears more than the weight of all grains: 1.26e-3 kg/m times 9.81 m/s^2 each, on 2e5 N/m.
    allowed = packed_count(scene) * 1.26e-3 * 9.81 / 2e5
    assert deepest(scene, simulation) < allowed
    # The twin: a packing that knows of nothing takes its place.
    assert deepest(scene, build(bed())) > 10 * allowed


@every_body
def test_as_many_grains_as_without(bodies: dict[str, Any]) -> None:
    scene = bed(**bodies)
    grains = build(scene).grains
    assert grains
    assert packed_count(scene) == derive(bed()).grain_count
    assert int(np.sum(np.isclose(grains.discs.radius, 0.0004, atol=0.00005))) >= packed_count(scene)
    frames = placed_frames(scene)
    assert grains.discs.count == derive(scene).grain_count + sum(len(it.frame.corners) for it in frames)


@pytest.mark.parametrize("name", ["held disc", "rectangle amid", "held polygon"])
def test_a_packing_rests_on_what_stands_there_by_the_springs_it_settled_with(name: str) -> None:
    rests, forgets = build(bed(**BODIES[name])), build(bed(**BODIES[name]))
    count = packed_count(rests.scene)
    grains = forgets.grains
    assert grains
    for springs in (grains.pairs.carried, grains.wall_spring, grains.rectangle_spring):
        springs[:] = 0.0
    if grains.segments:
        grains.segments.near_memory[:] = grains.segments.corner_memory[:] = 0.0

    def moved(simulation: Simulation) -> float:
        """How far a grain of the packing goes in STEPS steps, m."""
        assert simulation.grains
        start = simulation.grains.discs.position[:count].copy()
        simulation.advance(STEPS)
        return float(np.abs(simulation.grains.discs.position[:count] - start).max())

    # Rest is a kinetic energy of 1e-8 m g d per grain: at most sqrt(2e-8 N g d) in one.
    assert moved(rests) < np.sqrt(2e-8 * count * 9.81 * 0.0008) * STEPS * rests.step_seconds
    assert moved(forgets) > 10 * moved(rests)  # the twin: friction held part of the weight


def test_springs_at_segments_alone_matter() -> None:
    rests, forgets = build(bed(**BODIES["held polygon"])), build(bed(**BODIES["held polygon"]))
    assert forgets.grains
    assert forgets.grains.segments
    assert np.abs(forgets.grains.segments.near_memory).max() > 0.0
    forgets.grains.segments.near_memory[:] = 0.0
    for it in (rests, forgets):
        it.advance(STEPS)
    assert rests.grains
    assert not np.array_equal(rests.grains.discs.position, forgets.grains.discs.position)


def test_what_is_free_is_held_while_the_packing_settles_and_free_then() -> None:
    scene = bed(grains__grain=[grain(0.006, 0.0045)], disc=[DISC])
    simulation = build(scene)
    grains = simulation.grains
    assert grains
    assert grains.discs.position[-2:].tolist() == [[0.006, 0.0045], [0.006, 0.002]]
    assert grains.held[:, 0].tolist() == [0] * (grains.discs.count - 1) + [1]
    simulation.advance(STEPS)
    assert np.any(grains.discs.position[-2] != [0.006, 0.0045])
    assert grains.discs.position[-1].tolist() == [0.006, 0.002]


def test_what_stands_beside_or_above_changes_no_bit() -> None:
    above = build(bed(disc=[{**DISC, "y": 0.0065}])).grains
    alone = build(bed()).grains
    assert alone
    assert above
    count = alone.discs.count
    np.testing.assert_array_equal(above.discs.position[:count], alone.discs.position)
    lower = build(bed(disc=[{**DISC, "y": 0.0045}])).grains  # the twin: it would be seen
    assert lower
    assert not np.array_equal(lower.discs.position[:count], alone.discs.position)


@pytest.mark.parametrize("name", ["all of them", "rectangle amid"])
def test_the_same_bits_at_any_number_of_threads_and_from_disk(
    name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Any
) -> None:
    found, before = [], jit.threads()
    for count in (1, 2):
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / str(count)))
        jit.set_threads(min(count, jit.most_threads()))
        try:
            found.append(build(bed(**BODIES[name])))
        finally:
            jit.set_threads(before)
    monkeypatch.setattr("porescale.dem.prepare.among.settle", None)  # it must not be settled again
    found.append(build(bed(**BODIES[name])))
    moved = copy.deepcopy(BODIES[name])
    first = next(iter(moved.values()))[0]
    first |= {"thickness": 1.1e-4} if "corners" in first else {"upper": [0.007, 0.0021]}
    with pytest.raises(TypeError):
        build(bed(**moved))  # the twin: around something else it is another packing
    for it in found:
        it.advance(20)
    states = [it.grains.discs.state() for it in found if it.grains]
    for other in states[1:]:
        for key, array in states[0].items():
            np.testing.assert_array_equal(array, other[key])


def test_a_run_goes_on_bit_for_bit() -> None:
    scene = bed(**BODIES["all of them"])
    whole, begun, resumed = build(scene), build(scene), build(scene)
    whole.advance(60)
    begun.advance(25)
    resumed.restore(copy.deepcopy(begun.state()))
    resumed.advance(35)
    assert whole.grains
    assert resumed.grains
    np.testing.assert_array_equal(whole.grains.discs.position, resumed.grains.discs.position)
    assert not np.array_equal(whole.grains.discs.position, begun.grains.discs.position)  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"disc": [{"x": 0.006, "y": 0.0035, "diameter": 0.007}], "grains__packing": {**BED, "packing_fraction": 0.8}},
         "grains.packing.height: grains among what stands there are placed up to 0.0"),
        ({"disc": [{"x": 0.006, "y": 0.0025, "diameter": 0.004}],
          "grains__packing": {**BED, "settle": False, "packing_fraction": 0.7}},
         "grains.packing.packing_fraction = 0.6991: of the rectangle do not fit beside what stands in it"),
        ({"rectangle": [{"lower": [0.0, 0.0], "upper": [0.0115, 0.0049]}],
          "grains__packing": {**BED, "settle": False, "packing_fraction": 0.02}},
         "grains.packing.diameter = 0.0008"),
        ({"disc": [{"x": 0.006, "y": 0.004, "diameter": 0.006}],
          "grains__packing": {**BED, "settle": None, "height": 0.008, "compress": True, "packing_fraction": 0.8}},
         "grains.packing.packing_fraction = 0.7985: of the rectangle does not fit beside what stands in it"),
        ({"polygon": [SOLID], "grains__packing": {**BED, "settle": None, "height": 0.008, "compress": True}},
         "polygon[0]: is in the way of a packing that is compressed, which goes around discs alone"),
        ({"rectangle": BODIES["rectangle amid"]["rectangle"],
          "grains__packing": {**BED, "settle": None, "height": 0.008, "compress": True}},
         "rectangle[0]: stands in the packing, which is compressed"),
    ],
    ids=["settled", "placed", "no place", "compressed", "segments", "rectangles"],
)  # fmt: skip
def test_where_there_is_no_room_check_and_run_say_the_same_line(changes: dict[str, Any], line: str) -> None:
    changes["grains__packing"] = {key: it for key, it in changes["grains__packing"].items() if it is not None}
    (check,), (run,) = refusals(lambda: report(bed(**changes))), refusals(lambda: build(bed(**changes)))
    assert check == run
    assert check.startswith(line)


def test_a_packing_that_does_not_settle_is_placed_around_what_stands_there() -> None:
    packing = {**BED, "settle": False, "packing_fraction": 0.5}
    for bodies in BODIES.values():
        scene = bed(**bodies, grains__packing=packing)
        assert deepest(scene, build(scene)) <= 0.0
        assert deepest(scene, build(bed(grains__packing=packing))) > 1e-4  # the twin


def pressed(**changes: Any) -> Scene:
    """A compressed packing of the whole box around a held disc and a grain."""
    packing = {"left": 0.0, "width": 0.012, "height": 0.008, "diameter": 0.0006, "settling_friction": 0.0, **changes}
    return dry(grains__packing=packing, disc=[{**DISC, "y": 0.004}], grains__grain=[grain(0.002, 0.006, 0.0015)])


@pytest.mark.parametrize("target", [{"pressure": 100.0}, {"compress": True, "packing_fraction": 0.76}])
def test_a_compressed_packing_grows_around_discs(target: dict[str, Any]) -> None:
    scene = pressed(**target)
    simulation = build(scene)
    assert simulation.grains
    discs = simulation.grains.discs
    assert discs.count == packed_count(scene) + 2 == derive(scene).grain_count
    assert discs.radius[-2:].tolist() == [0.00075, 0.001]  # these do not grow
    assert deepest(scene, simulation) < 0.02 * 0.0006  # where grains would be discs no more, see compaction.DEEPEST
    if "packing_fraction" in target:
        area = float((np.pi * discs.radius[:-2] ** 2).sum())
        assert area == pytest.approx(0.76 * 0.012 * 0.008, rel=0.5 / packed_count(scene))


def test_void_ratios_count_neither_as_pores_nor_as_grains_what_stands_there() -> None:
    scene = bed(grains__packing={**BED, "height": 0.006}, disc=[{**DISC, "diameter": 0.0025, "y": 0.003}])
    assert scene.grains
    packing, grains = scene.grains.packing, build(scene).grains
    assert packing
    assert grains
    found = settled_void_ratio(packing, grains, around(scene))
    discs, count = grains.discs, packed_count(scene)
    height = float((discs.position[:count, 1] + discs.radius[:count]).max())
    x, y = np.meshgrid((np.arange(1200) + 0.5) * 1e-5, (np.arange(800) + 0.5) * 1e-5)
    part = (y > 0.1 * height) & (y < 0.7 * height)
    covered = np.zeros(x.shape, int)
    for k in range(discs.count):
        in_it = np.hypot(x - discs.position[k, 0], y - discs.position[k, 1]) < discs.radius[k]
        covered[in_it] = 1 if k < count else 2
    grain_area, pores = np.sum(part & (covered == 1)), np.sum(part & (covered == 0))
    # By points 0.01 mm apart: a row of them at the edges of the region is 1/360 of it, 1 % of the pores.
    assert found == pytest.approx(pores / grain_area, rel=0.015)
    assert settled_void_ratio(packing, grains) != pytest.approx(found, rel=0.1)  # the twin: the disc as a grain


def test_a_void_ratio_that_is_missed_around_what_stands_there_is_said() -> None:
    packing = {key: it for key, it in BED.items() if key not in ("packing_fraction", "settle")}
    scene = pressed(compress=True, void_ratio=0.4)
    with pytest.warns(PorescaleWarning, match=r"void_ratio = 0\.4 sets the number of grains by the whole rectangle"):
        build(scene)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        build(dry(grains__packing={**packing, "height": 0.008, "compress": True, "void_ratio": 0.4,
                                   "settling_friction": 0.0}))  # fmt: skip


def test_a_packing_of_two_materials_rests_on_a_disc_of_the_walls() -> None:
    steel = {"name": "steel", "stiffness": 1e6, "friction": 0.2}  # sand rolls as in other tests with two materials
    materials = [{"name": "sand", "friction": 0.3, "rolling_friction": 0.1, "rolling_stiffness": 1e4}, steel]
    scene = bed(disc=[DISC], material=materials, contact__wall_material="steel")
    simulation = build(scene)
    assert simulation.grains
    assert simulation.grains.material is not None
    assert simulation.grains.material.tolist() == [0] * packed_count(scene) + [1]
    start = simulation.grains.discs.position.copy()
    simulation.advance(STEPS)
    fastest = np.sqrt(2e-8 * packed_count(scene) * 9.81 * 0.0008)
    assert np.abs(simulation.grains.discs.position - start).max() < fastest * STEPS * simulation.step_seconds
