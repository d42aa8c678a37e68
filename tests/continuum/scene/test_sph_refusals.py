"""What a scene of soil and water is refused for: ground that holds nothing, strips that keep no level, names given
twice."""

import pytest

from continuum_sph import build, check
from continuum_sph.builders.report import report
from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from continuum_sph.validation.tanks import tank_scene
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import validate

BLOCK = [[0.3, 0], [0.6, 0], [0.6, 0.4], [0.3, 0.4]]
FLAT = [[0.7, 0], [0.9, 0], [0.9, 0.02], [0.7, 0.02]]  # lower than the middle of the lowest row
WATER = {"sound_speed": 30.0, "column": [{"width": 0.3, "height": 0.3}]}
SUCTION = {"alpha": 4.0, "n": 3.0, "saturation": 0.5}


def scene(*outlines, soil=None, **changes):
    """A block of soil in a tank of 1 m by 0.5 m, with particles of 0.05 m; water where ``changes`` have some."""
    ground = {"body": [{"outline": it} for it in outlines or (BLOCK,)]} | (soil or {})
    return tank_scene(1.0, 0.5, 0.05, 0.1, lid=False, **{"soil": ground} | changes)


DRY, MOVING, HELD = {}, {"water": WATER}, {"water": WATER, "soil": {"held": True}}
MOIST = {"water": {"sound_speed": 30.0}, "soil": {"suction": SUCTION}}


@pytest.mark.parametrize("kind", [DRY, MOVING, HELD, MOIST], ids=["dry", "moving", "held", "moist"])
@pytest.mark.parametrize(("outlines", "number"), [((FLAT,), 0), ((BLOCK, FLAT), 1)])
def test_a_body_without_a_particle_is_refused_by_check_and_run(kind, outlines, number):
    for act in (report, Simulation):
        with pytest.raises(InputError, match=rf"soil\.body\[{number}\]\.outline .* holds no particle of soil"):
            act(scene(*outlines, **kind))
    report(scene(**kind))  # the check that fails: a body with particles passes


def test_every_empty_body_is_named_and_one_within_the_column_of_a_pile_is_empty():
    with pytest.raises(InputError) as caught:
        report(scene(FLAT, BLOCK, FLAT))
    assert [fault.key for fault in caught.value.faults] == ["soil.body[0].outline", "soil.body[2].outline"]
    beside = [[0.45, 0.1], [0.5, 0.1], [0.5, 0.4], [0.45, 0.4]]
    low = [[0, 0], [1, 0], [1, 0.1], [0, 0.1]]
    report(scene(low, beside))
    with pytest.raises(InputError, match=r"soil\.body\[1\]\.outline"):
        report(scene(low, beside, pile={"x": 0.475, "tip": 0.05}))


def test_a_tank_too_narrow_for_a_pile_is_refused_by_its_spacing_not_by_a_range_without_a_place():
    narrow = [[0, 0], [0.4, 0], [0.4, 0.2], [0, 0.2]]
    with pytest.raises(InputError) as caught:
        tank_scene(0.4, 0.5, 0.05, 0.1, lid=False, soil={"body": [{"outline": narrow}]}, pile={"x": 0.2, "tip": 0.1})
    assert [(fault.key, fault.allowed) for fault in caught.value.faults] == [("numerics.spacing", "<= 0.0444444")]
    with pytest.raises(InputError, match=r"pile\.x = 0\.19 m: .* \(allowed: 0\.225 to 0\.225 m\)"):
        tank_scene(0.45, 0.5, 0.05, 0.1, lid=False, soil={"body": [{"outline": narrow}]}, pile={"x": 0.19, "tip": 0.1})


POOL = {"name": "river", "left": 0.0, "right": 0.15, "level": 0.2}
DRAIN = {"left": 0.75, "right": 1.0, "level": 0.0}


def kept(*reservoirs, **changes):
    """A scene of a held block with reservoirs."""
    return scene(reservoir=list(reservoirs), **HELD | changes)


def test_a_strip_on_another_or_on_ground_is_refused_and_one_beside_them_is_not():
    kept(POOL, DRAIN)
    kept(POOL, DRAIN | {"left": 0.15, "right": 0.3})
    kept(POOL | {"bottom": 0.4, "left": 0.3, "right": 0.6, "level": 0.45})  # open water on the ground
    with pytest.raises(InputError, match=r"reservoir\[1\]: overlaps reservoir\[0\] by 0\.05 m"):
        kept(POOL, DRAIN | {"left": 0.1, "right": 0.3})
    with pytest.raises(InputError, match=r"reservoir\[0\]\.bottom = 0\.0 m: has ground in its strip, up to 0\.4 m"):
        kept(POOL | {"right": 0.35})
    # with suction no particles of water stand there
    scene(reservoir=[POOL | {"right": 0.4}], **MOIST)


def test_a_strip_that_is_narrow_or_beside_the_ground_is_doubted_and_one_of_two_spacings_is_whole():
    def said(strip):
        warnings = report(kept(strip)).warnings
        return [any(word in text for text in warnings) for word in ("spacings broad, at least 6", "closer than 3")]

    wide = {"numerics": {"spacing": 0.025}}
    assert said(POOL) == [True, False]
    assert said(POOL | {"right": 0.2}) == [True, True]
    assert not any("strip" in text for text in report(kept(POOL | {"right": 0.225}, **wide)).warnings)
    report(kept(DRAIN | {"left": 0.7, "right": 0.8}))  # 0.8 - 0.7 is less than 0.1 by round-off
    with pytest.raises(InputError, match="fewer than 2 particles"):
        kept(DRAIN | {"left": 0.7, "right": 0.79})


@pytest.mark.parametrize(
    ("key", "sections", "said"),
    [
        ("reservoir", [POOL, DRAIN | {"name": "river"}], r"reservoir\[1\]\.name = 'river': is that of another reser"),
        ("reservoir", [POOL | {"name": "reservoir 1"}, DRAIN], r"reservoir\[1\]\.name = 'reservoir 1'"),
        ("probe", [{"name": "a", "x": 0.1, "y": 0.1}] * 2, r"probe\[1\]\.name = 'a': is that of another probe"),
        ("probe", [{"name": "a\nb", "x": 0.1, "y": 0.1}], r"probe\[0\]\.name = 'a\\nb': has control characters"),
        ("level", [{"name": "a", "x": 0.1}] * 2, r"level\[1\]\.name = 'a': is that of another level"),
        ("level", [{"name": " ", "x": 0.1}], r"level\[0\]\.name = ' ': is blank"),
    ],
)
def test_names_that_would_lose_columns_are_refused(key, sections, said):
    with pytest.raises(InputError, match=said):
        scene(**HELD, **{key: sections})
    scene(**HELD, **{key: [it | {"name": f"n, é {k}"} for k, it in enumerate(sections)]})


def test_a_rise_takes_units_and_no_time_before_the_start():
    made = kept(POOL | {"level": None, "rise": [["0 s", "10 cm"], ["500 ms", 0.2]]})
    assert made.reservoir[0].table == ((0.0, 0.1), (0.5, 0.2))
    for rise, said in (
        ([[-1, 0.1], [1, 0.2]], r"rise\[0\]\[0\] = -1 s: is out of range \(allowed: >= 0 s\)"),
        ([["1 m", 0.1]], r"rise\[0\]\[0\] = '1 m'.* does not measure the same thing as s"),
        ([[0, 0.7]], r"reservoir\[0\]\.rise = 0\.7 m: .* over the tank"),
    ):
        with pytest.raises(InputError, match=said):
            kept(POOL | {"level": None, "rise": rise})


def test_a_water_table_over_the_tank_is_refused():
    kept(POOL, soil={"held": True, "water_table": 0.5})
    with pytest.raises(InputError, match=r"soil\.water_table = 5\.0 m: lies over the tank \(allowed: <= 0\.5 m\)"):
        kept(POOL, soil={"held": True, "water_table": 5})


def test_a_water_table_under_all_of_the_soil_is_refused():
    spacing = kept(POOL).numerics.spacing
    kept(POOL, soil={"held": True, "water_table": 0.5 * spacing})
    said = rf"soil\.water_table = 0\.0 m: lies under all particles of the soil \(allowed: >= {0.5 * spacing:g} m\)"
    with pytest.raises(InputError, match=said):
        kept(POOL, soil={"held": True, "water_table": 0})


def test_a_spacing_too_large_for_a_side_is_what_is_wrong_with_its_face():
    full = {"water": {"sound_speed": 60.0}, "tank": {"width": 1.0, "height": 0.5}}
    full |= {"soil": {"held": True, "saturated": True, "body": [{"outline": [[0, 0], [1, 0], [1, 0.5], [0, 0.5]]}]}}
    face = {"side": "left", "head": 1.0}
    with pytest.raises(InputError, match=r"numerics\.spacing = 0\.5 m: leaves face\[0\] .* \(allowed: <= 0\.25 m\)"):
        scene(**full, face=[face], numerics={"spacing": 0.5})
    with pytest.raises(InputError, match=r"face\[0\]\.start = 0\.3 m"):  # the side has two rows, the face has not
        scene(**full, face=[face | {"start": 0.3}], numerics={"spacing": 0.25})


def test_a_tank_of_no_whole_spacings_is_the_only_fault_of_what_stands_at_its_side():
    """A strip that ends at the side, 1 m, was outside of the 0.99 m that whole spacings make, too."""
    strip = {"left": 0.7, "right": 1.0, "level": 0.3}
    with pytest.raises(InputError) as refused:
        scene(numerics={"spacing": 0.03}, reservoir=[strip])
    keys = [line.split(" = ")[0] for line in str(refused.value).splitlines()]
    assert keys == ["tank.width", "tank.height"]
    with pytest.raises(InputError, match=r"^reservoir\[0\]\.right = 1\.2 m"):  # as it is where the tank has them
        scene(reservoir=[strip | {"right": 1.2}])


WET = {"water": WATER, "soil": {"porosity": 0.4, "permeability": 0.01}}
IMAGES = {"tank": {"width": 1.0, "height": 0.5, "wall_particles": "images"}}
BUBBLE = {
    "inclusion": {"density": 500, "disc": [{"x": 0.15, "y": 0.15, "radius": 0.15}]},
    "numerics": {"spacing": 0.025},
}
UNFIT = [
    ({"water": WATER | {"sound_speed": 3.0}}, r"water\.sound_speed = 3\.0 m/s: makes the fall of the water Mach"),
    (WET | IMAGES, r"tank\.wall_particles.*cannot be with soil"),
    (WET | BUBBLE, r"inclusion.*cannot be with soil"),
]


@pytest.mark.parametrize(("changes", "said"), UNFIT, ids=["soft", "images", "inclusion"])
def test_what_check_refuses_is_not_built_either(changes, said):
    for act in (check, build):
        with pytest.raises(InputError, match=said):
            act(scene(**changes))
    assert build(scene(**WET)).step == 0  # the check that fails: without the change it is built


def test_a_reservoir_without_soil_is_refused_in_one_line_and_beside_soil_it_fills_an_empty_tank():
    given = scene().model_dump(mode="json", exclude_unset=True)
    empty = {key: given[key] for key in ("tank", "numerics", "time", "output")}
    with pytest.raises(InputError) as refused:
        validate(Scene, empty | {"reservoir": [POOL]})
    assert [fault.line() for fault in refused.value.faults] == ["reservoir = 'given': needs soil beside it; add [soil]"]
    with pytest.raises(InputError, match=r"^water\.column: is missing; give at least one rectangle of water$"):
        validate(Scene, empty)  # the check that fails: without the reservoir it is the column
    filled = build(scene(soil={"held": True}, reservoir=[POOL | {"level": None, "rise": [[0, 0], [0.1, 0.2]]}]))
    assert filled.series()["mass (kg/m)"] == 0.0
    while filled.time < 0.1:
        filled.advance(1)
    row = filled.series()
    # Three columns of particles, 2.5 kg/m each, and the level is known to a row: three of four rows at least.
    assert row["mass (kg/m)"] == row["river let in (kg/m)"] - row["river let out (kg/m)"] >= 3 * 3 * 2.5


@pytest.mark.parametrize(
    ("section", "line"),
    [
        ({"soil": {}}, "soil.body: is missing; add [[soil.body]] (pieces of ground)"),
        ({"inclusion": {}}, "inclusion.disc: is missing; add [[inclusion.disc]] (discs of the second fluid)"),
        ({"tank": None}, "tank: is missing; add [tank]"),
    ],
)
def test_a_list_of_tables_that_is_missing_is_asked_for_as_one(section, line):
    """With [soil.body] the next run was refused again."""
    table = {
        "tank": {"width": 1.0, "height": 0.5},
        "water": WATER,
        "numerics": {"spacing": 0.05},
        "time": {"end": 0.1},
        "output": {"snapshot_interval": 0.1, "series_interval": 0.1},
    }
    with pytest.raises(InputError) as refused:
        validate(Scene, {name: it for name, it in (table | section).items() if it is not None})
    assert [fault.line() for fault in refused.value.faults] == [line]


def test_a_wrong_entry_of_a_list_is_the_only_fault():
    """The list was called too short as well, by words of pydantic."""
    with pytest.raises(InputError) as refused:
        scene(soil={"body": [{"outline": BLOCK, "permeability": 0.0}]})
    assert [fault.key for fault in refused.value.faults] == ["soil.body[0].permeability"]
    with pytest.raises(InputError) as refused:
        scene(soil={"body": []})
    line = "soil.body: holds 0 of the 1 that it needs; add [[soil.body]] (pieces of ground)"
    assert [fault.line() for fault in refused.value.faults] == [line]


def test_shares_in_warnings_are_written_out():
    """They were "late by 1e+02 %" and "strains it by 2.1e+02 %"."""
    soft = {"stiffness": 4e3}
    told = report(scene(soil=soft)).warnings
    assert any("strains it by 116 %: raise soil.stiffness" in it for it in told)
    stiff = {"stiffness": 1e11}
    for kind in (
        {"water": WATER, "soil": stiff},
        {"water": {"sound_speed": 30.0}, "soil": stiff | {"suction": SUCTION}},
    ):
        assert any("late by 100 %" in it for it in report(scene(**kind)).warnings)


@pytest.mark.parametrize(
    "kind", [DRY, {"soil": {"saturated": True}, "water": {"sound_speed": 30.0}}], ids=["dry", "wet"]
)
def test_check_warns_of_soil_that_its_weight_strains_by_more_than_two_percent(kind):
    """Of soil with water in its pores it said nothing, of dry soil from 1 % on."""

    def told(stiffness):
        out = report(scene(**kind | {"soil": kind.get("soil", {}) | {"stiffness": stiffness}}))
        strain = next(row.value for rows in out.groups.values() for row in rows if row.name.startswith("strain under"))
        return strain, [it for it in out.warnings if "weight strains it by" in it]

    strain, (line,) = told(1e4)
    assert strain == pytest.approx(told(1e6)[0] * 100.0)
    enough = int(line.split("soil.stiffness to ")[1].split(" Pa")[0])
    assert told(enough)[1] == []
    assert told(0.99 * enough)[1] != []


def test_soil_under_water_is_strained_by_its_buoyant_weight():
    def strain(**kind):
        out = report(scene(**kind))
        return next(row.value for rows in out.groups.values() for row in rows if row.name.startswith("strain under"))

    full = strain(soil={"saturated": True}, water={"sound_speed": 30.0})
    # γ'/γ = 1 - (1 - n) ρ_w/ρ of the default soil, ρ = 1590, n = 0.4; at the lowest particle, 7.5 of 8 rows deep
    assert full == pytest.approx(strain() * (1.0 - 600.0 / 1590.0) * 7.5 / 8.0, rel=1e-9)


@pytest.mark.filterwarnings("error")
def test_soil_without_stress_loses_none_in_a_centrifuge():
    """Its buoyancy was divided by next to nothing, and numpy told of an overflow."""
    wet = {"saturated": True, "stress": "none"}
    build(scene(soil=wet, gravity=1e6, water={"density": 1e5, "sound_speed": 1e4}))


def test_air_is_refused_beside_water_of_no_viscosity():
    air = {"water": WATER | {"viscosity": 0.0}, "air": {}}
    with pytest.raises(InputError, match=r"water\.viscosity = 0\.0 Pa s: leaves the drag on air .*allowed: > 0 Pa s"):
        scene(**air)
    scene(**air | {"water": WATER | {"viscosity": 1e-6}})  # the check that fails: with any there is a measure
