"""Packings of a scene: graded, lognormal, compressed, from files; each refusal names its key and what to do."""

import os
import warnings
from typing import Any

import numpy as np
import pytest

from porescale import Scene
from porescale.builders.build import build
from porescale.builders.derive import derive
from porescale.builders.initial.packing import settled_void_ratio
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import scene_as_dict, validate
from porescale.dem.measures.contacts import contacts
from porescale.dem.measures.porosity import porosity, void_ratio
from porescale.dem.measures.region import Region
from porescale.dem.measures.survey import max_overlap
from porescale.dem.prepare.compaction import DEEPEST, mean_stress, write_packing
from tests.reference.dem.grading import percent_finer
from tests.reference.scenes import dry, refusals, table

CURVE = [[0.0003, 0.0], [0.0006, 40.0], [0.0009, 100.0]]
BOX = {"left": 0.0, "width": 0.012, "height": 0.008}
ROUND = {f"domain__{side}": "periodic" for side in ("left", "right", "bottom", "top")}


PRESSED = {"compress": True, "pressure": 500, "packing_fraction": 0.82, "diameter": 0.001}
FREE = {"settling_friction": 1.0, "settling_rolling_friction": 0.5}


def grains_of(scene: Scene) -> Any:
    """The grains of a scene, built."""
    return build(scene).grains


def packed(**keys: Any) -> Any:
    """The dry column with other keys of its packing."""
    return dry(**{f"grains__packing__{key}": value for key, value in keys.items()})


def pressed(**keys: Any) -> Any:
    """A periodic box full of grains under 500 Pa, no gravity."""
    given = {**BOX, "compress": True, "pressure": 500, "packing_fraction": 0.82, "diameter": 0.001, **keys}
    changes = {f"grains__packing__{key}": value for key, value in given.items()}
    return dry(**ROUND, **{"grains__packing__settle": None, "gravity": [0.0, 0.0], **changes})


@pytest.mark.parametrize("settle", [False, True])
def test_grains_follow_their_grading_curve(settle):
    gate = {"x": 0.008, "opens_at": 0.01, "lift_speed": 0.4} if settle else None
    keys = {"grading": CURVE, "diameter": None, "settle": settle}
    scene: Any = dry(gate=gate, **{f"grains__packing__{key}": value for key, value in keys.items()})
    assert derive(scene).grain_count == grains_of(scene).discs.count
    radius = grains_of(scene).discs.radius
    own = 100 * 0.0009**2 / np.sum((2 * radius) ** 2)  # a disc of the largest, of some seventy
    assert percent_finer(radius, np.array([0.0006]))[0] == pytest.approx(40.0, abs=own)
    assert scene.grains.packing.diameter == pytest.approx(2 * radius.mean(), rel=1e-12)


@pytest.mark.parametrize(("way", "large", "small"), [("settled", 3, 800), ("pressed", 6, 1500)])
def test_sizes_of_one_to_twenty_come_to_rest(way, large, small):
    given = {"sizes": [["3.2 mm", large], ["0.16 mm", small]], "diameter": None, "packing_fraction": None}
    if way == "pressed":
        grains = grains_of(pressed(**given))
    else:
        keys = {**BOX, **given, "settle": True}
        grains = grains_of(dry(gate=None, **{f"grains__packing__{key}": value for key, value in keys.items()}))
    radius = np.sort(grains.discs.radius)
    np.testing.assert_allclose(radius / radius[0], np.repeat([1.0, 20.0], [small, large]), rtol=1e-12)
    assert np.abs(grains.discs.velocity).max() == 0.0
    assert contacts(grains).count > len(radius)  # it stands, by more contacts than grains
    assert 0.5 * max_overlap(grains).share < DEEPEST


def test_lognormal_grains_and_void_ratio():
    scene = packed(log_spread=0.2, void_ratio=1.0, packing_fraction=None)
    assert scene.grains.packing.packing_fraction == 0.5
    radius = grains_of(scene).discs.radius
    assert 2 * radius.mean() == pytest.approx(0.0008, rel=1e-12)
    assert np.pi * np.sum(radius**2) / (0.004 * 0.0055) == pytest.approx(0.5, abs=0.02)  # whole discs of 2.7 %


SIZES = [["0.8 mm", 30], ["1.2 mm", 12]]


@pytest.mark.parametrize("way", ["placed", "settled", "pressed"])
def test_given_numbers_of_given_sizes_are_what_there_is(way):
    if way == "pressed":
        scene = pressed(sizes=[["0.8 mm", 80], ["1.2 mm", 33]], diameter=None, packing_fraction=None)
    else:
        gate = {"x": 0.008, "opens_at": 0.01, "lift_speed": 0.4} if way == "settled" else None
        keys = {"sizes": SIZES, "diameter": None, "packing_fraction": None, "settle": way == "settled", "left": 0,
                "width": 0.008, "height": 0.006}  # fmt: skip
        scene = dry(gate=gate, **{f"grains__packing__{key}": value for key, value in keys.items()})
    numbers = np.array([80, 33] if way == "pressed" else [30, 12])
    packing, radius = scene.grains.packing, np.sort(grains_of(scene).discs.radius)
    assert derive(scene).grain_count == len(radius) == numbers.sum()
    # Two sizes and nothing between; a pressed bed grows all of them by one factor, a few per cent at most.
    ratio = 0.0006 / 0.0004
    np.testing.assert_allclose(radius / radius[0], np.repeat([1.0, ratio], numbers), rtol=1e-12)
    assert radius[0] == pytest.approx(0.0004, rel=1e-12 if way != "pressed" else 0.05)
    area = np.pi * float(numbers @ np.array([0.0004, 0.0006]) ** 2)
    assert packing.packing_fraction == pytest.approx(area / (packing.width * packing.height), rel=1e-12)
    assert packing.diameter == pytest.approx(2 * float(numbers @ [0.0004, 0.0006]) / numbers.sum(), rel=1e-12)
    assert validate(Scene, scene_as_dict(scene)) == scene  # as a card holds it, with what follows
    assert len(radius) != derive(packed(diameter=packing.diameter)).grain_count  # the twin: a number that follows


@pytest.mark.parametrize(("keys", "said"), [
    ({"diameter": 0.001}, r"packing.diameter = 0.001 m: follows from sizes: 0.000914286; leave diameter or sizes out"),
    ({"packing_fraction": 0.5}, r"packing_fraction = 0.5: follows from sizes: 0.596"),
    ({"void_ratio": 0.3}, r"packing.void_ratio = 0.3: sizes and numbers of grains follow from sizes; leave one out"),
    ({"log_spread": 0.1}, r"packing.log_spread = 0.1: sizes and numbers of grains follow from sizes"),
    ({"grading": CURVE}, r"packing.grading: sizes and numbers of grains follow from sizes"),
    ({"sizes": [["1 mm", 2.5]]}, r"packing.sizes = .*: numbers of grains must be whole \(allowed: 1 to 300000"),
    ({"sizes": [["1 mm", 0]]}, r"packing.sizes = .*: numbers of grains must be whole"),
    ({"sizes": [["1 mm", 1e300]]}, r"packing.sizes = .*: numbers of grains must be whole"),
    ({"sizes": [["1 mm", 9], ["21 mm", 9]]}, r"packing.sizes: spans diameters of 1 to 21 \(allowed: 1 to 20\)"),
    ({"sizes": [[0, 9]]}, r"packing.sizes = .* is out of range"),
    ({"sizes": [["1 mm", 900]]}, r"packing.sizes: covers 14.7 of the rectangle \(allowed: <= 0.84\); change"),
])  # fmt: skip
def test_given_sizes_that_cannot_be_are_refused(keys, said):
    given = {
        "sizes": SIZES,
        "diameter": None,
        "packing_fraction": None,
        "left": 0,
        "width": 0.008,
        "height": 0.006,
        **keys,
    }
    with pytest.raises(InputError, match=said):
        derive(packed(**given))


def test_given_sizes_that_pressure_would_change_are_refused():
    with pytest.raises(InputError, match=r"sizes: covers 0.298 of the rectangle \(allowed: 0.7 to 0.84\)"):
        pressed(sizes=SIZES, diameter=None, packing_fraction=None)


def test_a_packing_is_compressed_to_its_pressure():
    scene = pressed(settling_friction=0.0)
    simulation: Any = build(scene)
    assert mean_stress(simulation.grains) == pytest.approx(500.0, rel=5e-3)
    start = simulation.grains.discs.position.copy()
    simulation.advance(200)
    assert np.median(np.hypot(*(simulation.grains.discs.position - start).T)) < 1e-3 * 0.001
    assert mean_stress(simulation.grains) == pytest.approx(500.0, rel=0.02)


def test_circles_of_a_file_are_grains_of_the_scene_and_of_its_card(tmp_path):
    position = np.array([(0.002, 0.0005), (0.004, 0.0005)])
    write_packing(tmp_path / "bed.csv", position, np.array([0.0005, 0.0004]))
    given = table(fluid=None, gate=None, grains={"density": 2500, "circles": {"file": "bed.csv", "left": 0.001}})
    scene: Any = validate(Scene, given, folder=tmp_path)
    assert [(it.x, it.y, it.diameter) for it in scene.grains.grain] == [(0.003, 0.0005, 0.001), (0.005, 0.0005, 0.0008)]
    again = validate(Scene, scene_as_dict(scene))  # elsewhere, without the file
    assert again == scene
    np.testing.assert_array_equal(grains_of(again).discs.radius, [0.0005, 0.0004])


def test_a_packing_kept_under_pressure_is_taken_up_again(tmp_path):
    first: Any = grains_of(pressed(settling_friction=0.0))
    write_packing(tmp_path / "bed.h5", first.discs.position % (0.012, 0.008), first.discs.radius)
    sides: dict[str, Any] = {**ROUND, "gravity": [0.0, 0.0], "fluid": None, "gate": None}
    given = table(**sides, grains={"density": 2500, "circles": {"file": "bed.h5"}})
    again = grains_of(validate(Scene, given, folder=tmp_path))
    assert mean_stress(again) == pytest.approx(500.0, rel=5e-3)  # springs along the contacts are not kept
    given["grains"]["overlap"] = 1e-4
    with pytest.raises(InputError, match=r"grains.grain.*overlaps grain"):
        grains_of(validate(Scene, given, folder=tmp_path))


@pytest.mark.parametrize(("keys", "said"), [
    ({"grading": [[0.0003, 0.0], [0.0006, 40.0]], "diameter": None}, r"grading.*0 to 100"),
    ({"grading": CURVE}, r"grains.packing.diameter.*follows from grading.*leave diameter or grading out"),
    ({"grading": CURVE, "diameter": None, "log_spread": 0.1}, r"log_spread.*leave one out"),
    ({"void_ratio": 0.2}, r"packing_fraction.*follows from void_ratio: 0.8333"),
    ({"pressure": 100.0, "settle": True}, r"settle.*compressed does not settle"),
    ({"pressure": 100.0, "settle": None}, r"packing.width.*fills the box.*as large as the box"),
    ({"log_spread": 0.9}, r"log_spread.*<= 0.599"),
])  # fmt: skip
def test_packings_that_contradict_themselves_are_refused(keys, said):
    with pytest.raises(InputError, match=said):
        derive(packed(**keys))


def test_a_spread_that_other_keys_take_the_place_of_is_said():
    said = " ".join(derive(packed(grading=CURVE, diameter=None, size_spread=0.3)).warnings)
    assert "grains.packing.size_spread = 0.3 is not used: diameters follow from grading" in said
    assert "follow from log_spread" in " ".join(derive(packed(log_spread=0.1, size_spread=0.3)).warnings)
    # The twins: either alone.
    for keys in ({"size_spread": 0.3}, {"log_spread": 0.1, "size_spread": None}):
        assert "is not used" not in " ".join(derive(packed(**keys)).warnings)


SMOOTH = {"contact__tangential_stiffness": 0.0, "contact__friction": 0.0}


@pytest.mark.parametrize("key", ["settling_friction", "settling_rolling_friction"])
def test_friction_of_compressing_without_a_spring_along_contacts_has_no_effect_and_is_refused(key):
    def smooth(**more: Any) -> Any:
        given = {**BOX, "pressure": 500, "diameter": 0.001, "settle": None}
        changes = {f"grains__packing__{name}": value for name, value in given.items()}
        return dry(**ROUND, **{"gravity": [0.0, 0.0], **SMOOTH, **changes, **more})

    given = {f"grains__packing__{key}": 0.3}
    line = f"grains.packing.{key} = 0.3: has no effect on what is compressed: contacts have no tangential_stiffness; "
    line += "give contact.tangential_stiffness, half of the normal one say, or leave it out"
    assert refusals(lambda: derive(smooth(**given))) == [line]
    derive(smooth(**given, contact__tangential_stiffness=1e5))
    derive(smooth(**{f"grains__packing__{key}": 0.0}))
    gate = {"x": 0.008, "opens_at": 0.01, "lift_speed": 0.4}
    derive(dry(gate=gate, grains__packing__settle=True, **SMOOTH, **given))  # settling has a law of its own
    plain = smooth()  # by default nothing is claimed, nor by the card of such a run, which has all keys
    derive(plain)
    assert derive(validate(Scene, scene_as_dict(plain))).grain_count == derive(plain).grain_count


def test_friction_of_compressing_acts_on_a_dashpot_along_contacts_and_by_material():
    keys = {"grains__packing__settling_friction": 0.3, "contact__tangential_damping": 1.0}
    box = {f"grains__packing__{name}": value for name, value in (BOX | {"pressure": 500, "settle": None}).items()}
    derive(dry(**ROUND, **SMOOTH, **box, **keys))
    materials = [{"name": "smooth"}, {"name": "rough", "tangential_stiffness": 1e5}]
    bare = {**ROUND, **SMOOTH, **box, "material": materials, "grains__packing__settling_friction": 0.3}
    derive(dry(**bare, grains__packing__material="rough"))
    (line,) = refusals(lambda: derive(dry(**bare, grains__packing__material="smooth")))
    assert line.startswith("grains.packing.settling_friction = 0.3: has no effect")


def test_a_section_of_circles_that_is_wrong_is_named():
    given = table(fluid=None, gate=None, grains={"density": 2500, "circles": {"file": "a.csv", "unit": "inch"}})
    with pytest.raises(InputError, match=r"grains.circles.unit"):
        validate(Scene, given)


def test_a_file_that_is_not_there_is_named(tmp_path):
    given = table(fluid=None, gate=None, grains={"density": 2500, "circles": {"file": "none.csv"}})
    with pytest.raises(InputError, match=r"grains.circles.file.*none.csv.*cannot be read"):
        validate(Scene, given, folder=tmp_path)


def test_a_void_ratio_that_is_asked_for_is_there():
    wanted = 0.25
    scene = pressed(pressure=None, packing_fraction=None, void_ratio=wanted, settling_friction=0.0)
    grains = grains_of(scene)
    solid = float(grains.discs.area.sum()) / (0.012 * 0.008)
    # Sizes are drawn to whole grains: half of one of 122 more or less, 0.4 % of the area; in the box they are as drawn.
    assert (1.0 - solid) / solid == pytest.approx(wanted, abs=0.5 / 122 * (1.0 + wanted) ** 2)
    region = Region((0.0, 0.0), (0.012, 0.008))
    pores = porosity(region, grains.discs.position, grains.discs.radius, grains.period)
    assert void_ratio(pores) == pytest.approx((1.0 - solid) / solid, rel=1e-11)


def test_friction_while_preparing_packs_loosely():
    dense, loose = (
        float(grains_of(pressed(settling_friction=friction)).discs.area.sum()) / (0.012 * 0.008)
        for friction in (0.0, 0.8)
    )
    # Random close packing of discs is at 0.84, what friction holds from 0.77 on; 120 discs scatter by 0.01.
    assert 0.82 < dense < 0.86
    assert 0.75 < loose < dense - 0.02


def test_rolling_friction_while_preparing_packs_more_loosely_if_it_stays():
    def solid(**contact):
        keys = {f"grains__packing__{key}": value for key, value in {**BOX, **PRESSED, **FREE}.items()}
        held = {f"contact__{key}": value for key, value in contact.items()}
        scene = dry(**ROUND, **{"grains__packing__settle": None, "gravity": [0.0, 0.0], **keys, **held})
        return float(grains_of(scene).discs.area.sum()) / (0.012 * 0.008)

    rolls, held = solid(), solid(rolling_friction=0.5, rolling_stiffness=5e4)
    # Of 400 grains rolling friction takes 0.012 to 0.014, and as much is what beds of 120 scatter by: here with the
    # same seed and sizes.
    assert held < rolls - 0.005
    assert rolls > 0.75  # the check that must fail: a law without rolling friction lets the bed fall together again


@pytest.mark.parametrize(("keys", "said"), [({"void_ratio": 0.5}, True), ({}, False)])
def test_a_void_ratio_that_settling_did_not_reach_is_said(keys, said):
    keys = {**keys, "settle": True} | ({"packing_fraction": None} if said else {})
    given = {f"grains__packing__{key}": value for key, value in keys.items()}
    scene = dry(gate={"x": 0.008, "opens_at": 0.01, "lift_speed": 0.4}, **given)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        grains = build(scene).grains
    found = [str(it.message) for it in caught if "void_ratio = 0.5 sets the number" in str(it.message)]
    assert bool(found) == said
    # Discs that rest lie between what rolling friction holds, 0.76, and hexagonal order, 0.907.
    assert 0.1 < settled_void_ratio(scene.grains.packing, grains) < 0.4


def test_a_packing_of_a_material_is_kept_and_found_again(monkeypatch):
    sand = {"name": "sand", "density": 2000, "friction": 0.3}
    steel = {"name": "steel", "density": 7800, "stiffness": 1e6}
    keys = {"material": [steel, sand], "gate": {"x": 0.008, "opens_at": 1.0}, "grains__packing__settle": True,
            "grains__packing__material": "sand", "contact__wall_material": "steel",
            "grains__grain": [{"x": 0.002, "y": 0.002, "diameter": 0.001}]}  # fmt: skip
    made = grains_of(dry(**keys))
    monkeypatch.setattr("porescale.dem.prepare.settle.settle", None)  # it must not be settled again
    found = grains_of(dry(**keys))
    assert found.material.tolist() == [1] * (found.discs.count - 1) + [0]
    np.testing.assert_allclose(found.discs.mass[:-1], 2000 * found.discs.area[:-1], rtol=1e-12)
    assert found.discs.mass[-1] == pytest.approx(7800 * found.discs.area[-1])
    for grains in (made, found):
        grains.step(1e-6, count=20)
    np.testing.assert_array_equal(found.discs.position, made.discs.position)
    keys["material"] = [steel, {**sand, "friction": 0.4}]
    with pytest.raises(TypeError):
        grains_of(dry(**keys))  # the twin: another friction is another packing


def test_circles_of_a_file_may_be_of_a_material(tmp_path):
    write_packing(tmp_path / "bed.csv", np.array([(0.002, 0.0005), (0.004, 0.0005)]), np.array([0.0005, 0.0004]))
    materials = [{"name": "sand"}, {"name": "steel", "density": 7800}]
    given = table(fluid=None, gate=None, material=materials,
                  grains={"density": 2500, "circles": {"file": "bed.csv", "material": "steel"}})  # fmt: skip
    grains = grains_of(validate(Scene, given, folder=tmp_path))
    assert grains.material.tolist() == [1, 1]
    np.testing.assert_allclose(grains.discs.mass, 7800 * grains.discs.area)


@pytest.mark.parametrize(
    ("keys", "line"),
    [
        (
            {"grading": [[1e-9, 0.0], [5e-9, 100.0]], "diameter": None},
            r"grains.packing.grading: makes about \S+ grains",
        ),
        ({"grading": [[1e300, 0.0], [5e300, 100.0]]}, r"grains.packing.grading = .*is out of range"),
        ({"log_spread": 0.4, "diameter": 1e-9}, r"grains.packing.diameter: makes about \S+ grains"),
    ],
)
def test_sizes_of_far_too_many_grains_are_refused_before_they_are_drawn(keys, line):
    with pytest.raises(InputError, match=line):
        packed(**keys)


@pytest.mark.parametrize("name", ["circles.csv", "circles.h5"])
def test_circles_are_read_from_a_file_of_fitting_size_only(tmp_path, name):
    os.mkfifo(tmp_path / name)
    keys = {"grains__packing": None, "grains__circles": {"file": str(tmp_path / name)}}
    with pytest.raises(InputError, match=r"grains.circles.file = .* cannot be read \(is no regular file\)"):
        dry(**keys)
    (tmp_path / name).unlink()
    with open(tmp_path / name, "wb") as file:
        file.truncate(2**29)  # of nothing: takes no room
    with pytest.raises(InputError, match="is too large: 512 MiB, 256 are allowed"):
        dry(**keys)


def test_a_number_of_grains_is_named_with_what_it_follows_from():
    with pytest.raises(InputError, match=r"packing.number = 3: unknown key; it follows from packing_fraction"):
        packed(number=3)


def test_sizes_span_no_more_than_twenty_to_one_and_pores_no_less_than_grains_leave():
    # (1 + 0.905)/(1 - 0.905) = 20; a packing of 1 to 2000 came to no end.
    with pytest.raises(
        InputError, match=r"packing.size_spread = 0.999: is out of range \(allowed: >= 0 and <= 0.905\)"
    ):
        packed(size_spread=0.999)
    assert packed(size_spread=0.905)
    with pytest.raises(InputError, match=r"packing.void_ratio = 1e-09: is out of range"):
        packed(packing_fraction=None, void_ratio=1e-9)
