"""What a scene must not ask for is refused with one line that names key, value and repair; doubts are warnings."""

import dataclasses
from typing import Any

import pytest

from porescale import Scene, load
from porescale.builders import cost
from porescale.builders.build import build
from porescale.builders.derive import derive
from porescale.builders.report import report
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import validate
from tests.reference.folders import ROOT
from tests.reference.scenes import column, dry, grain, refusals, table, warned, water

TABLE1 = {"spacing": 1e-5, "relaxation_time": 0.8, "viscosity": 1e-4, "step": 1e-6}


def lines(**changes: Any) -> list[str]:
    """The refusals of the small column with changes."""
    return refusals(lambda: derive(column(**changes)))


def test_the_small_column_itself_is_not_refused():
    # The twin of every refusal below: the scene they change is accepted, and its parts are as stated.
    derived = derive(column())
    assert derived.cells == (60, 40)
    assert derived.gate_column == 40
    assert derived.grain_count == 31


def test_table_1_implies_what_the_specification_prints():
    said = lines(fluid=TABLE1)
    assert len(said) == 4
    # Kept three -> implied fourth, by nu = (tau - 1/2)/3 h²/dt.
    for key, given, implied in (
        ("spacing", "1e-05 m", "3.162e-05 m"),
        ("step", "1e-06 s", "1e-07 s"),
        ("relaxation_time", "0.8", "3.5"),
        ("viscosity", "0.0001 m^2/s", "1e-05 m^2/s"),
    ):
        (line,) = [it for it in said if it.startswith(f"fluid.{key} = ")]
        assert line.startswith(f"fluid.{key} = {given}: ")
        assert f"imply {implied}" in line
        assert f"leave {key} out, or give " in line


@pytest.mark.parametrize("left_out", list(TABLE1))
def test_each_repair_of_table_1_is_accepted(left_out):
    # Three of the four determine the fourth; that the scene may then be too costly or too fast is another matter.
    three = {name: value for name, value in TABLE1.items() if name != left_out}
    scene = validate(Scene, table(water_table(), fluid=three))
    assert getattr(scene.fluid, left_out) is None


def water_table() -> dict[str, Any]:
    return table(grains=None, contact=None, gate=None)


def test_four_that_agree_are_accepted_and_four_that_miss_by_a_percent_are_not():
    # tau = 0.5 + 3 * 2e-5 * 4e-5/(2e-4)^2 = 0.56
    four = {"viscosity": 2e-5, "spacing": 2e-4, "step": 4e-5}
    assert derive(column(fluid={**four, "relaxation_time": 0.56})).cells == (60, 40)
    assert len(lines(fluid={**four, "relaxation_time": 0.57})) == 4


@pytest.mark.parametrize(
    ("given", "missing", "repair"),
    [
        ({"viscosity": 1e-5, "spacing": 2e-4}, "step, relaxation_time", "add one of them"),
        ({"step": 1e-5}, "spacing, relaxation_time, viscosity", "add 2 of them"),
        ({}, "spacing, step, relaxation_time, viscosity", "add 3 of them"),
    ],
)
def test_fewer_than_three_are_refused_naming_what_is_missing(given, missing, repair):
    (line,) = lines(fluid=given)
    assert line.startswith(f"fluid.{missing}: three of spacing, step, relaxation_time, viscosity are needed")
    assert line.endswith(repair)


def test_the_hydraulic_radius_must_be_stated_by_grains_in_fluid():
    (line,) = lines(grains__hydraulic_radius_ratio=None)
    assert line.startswith("grains.hydraulic_radius_ratio: every scene with grains in fluid states it")
    assert "allowed: >= 0.01 and <= 1" in line
    assert "0.8 opens the pores" in line
    assert derive(dry()).grain_count == 31  # without fluid there is nothing to state


def test_a_hydraulic_radius_ratio_of_one_warns_that_it_seals_a_bed():
    (warning,) = warned(column(grains__hydraulic_radius_ratio=1.0), "seals")
    assert warning.startswith("hydraulic_radius_ratio = 1 seals a two-dimensional bed at rest")
    assert warning in report(column(grains__hydraulic_radius_ratio=1.0)).warnings
    assert not warned(column(), "seals")


EMPTY = {"density": 2500, "hydraulic_radius_ratio": 0.8}
BOTH = "contact.damping, restitution: exactly one of the two is needed; give one, leave the other out"
NOTHING = {"fluid": None, "grains": None, "contact": None, "gate": None}
TWICE = {"gate__x": 0.0081}, {"gate__x": 0.009}, {"grains__packing__left": 0.009}
"""A gate in the packing, or away from it, is at fault for that, too."""


@pytest.mark.parametrize(
    ("changes", "start", "more"),
    [
        ({"fluid": {"relaxation_time": 0.5, "spacing": 2e-4, "step": 4e-5}}, "fluid.relaxation_time = 0.5", "> 0.5"),
        ({"contact__damping": 1.0}, BOTH, None),
        ({"contact__restitution": None}, BOTH, None),
        ({"gate__x": 0.013}, "gate.x = 0.013 m: is outside the box (allowed: < 0.012 m)", ""),
        # The repair is a spacing that divides it and both sides of the box.  And it stands in the packing.
        ({"gate__x": 0.0081},
         "gate.x = 0.0081 m: is 40.5 cells of 0.0002 m, not a whole number", "0.0001 m divides it and the rest"),
        ({"gate__x": 0.009}, "gate.x = 0.009 m: stands in the packing, which reaches from 0.008 to 0.012 m", ""),
        ({"domain__width": 0.0121},
         "domain.width = 0.0121 m: is 60.5 cells of 0.0002 m, not a whole", "number; 0.012 m would be"),
        ({"domain__height": 0.0081},
         "domain.height = 0.0081 m: is 40.5 cells of 0.0002 m, not a whole", "number; a spacing of"),
        ({"domain__left": "periodic", "gate": None},
         "domain.left = 'periodic': but right is wall; make both sides periodic, or none", None),
        (NOTHING, "fluid, grains: nothing to simulate; add [fluid], [grains] or both", None),
        ({"contact": None}, "contact: grains need a contact law", ""),
        ({"grains": None}, "contact: there are no grains to touch", ""),
        ({"grains": EMPTY}, "grains", "holds no grain; add [grains.packing] or [[grains.grain]]"),
        ({"grains__packing__left": 0.009}, "grains.packing.left = 0.009 m: ", "0.012"),
        ({"grains__packing__height": 0.0085}, "grains.packing.height = 0.0085 m: ", ""),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_by_key_with_a_repair(changes, start, more):
    line, *others = lines(**changes)
    assert line.startswith(start)
    assert line == start if more is None else more in line
    assert len(others) == (changes in TWICE)


def test_a_gate_in_a_periodic_box_is_refused():
    sides = {"domain__left": "periodic", "domain__right": "periodic", "grains__packing__settle": False}
    (line,) = lines(**sides)
    assert line == "gate: stands in a periodic box; give the box walls"
    assert lines(fluid=None, grains__hydraulic_radius_ratio=None, **sides) == [line]
    derive(column(gate=None, **sides))  # the box itself is fine


@pytest.mark.parametrize(("side", "ends", "word"), [("width", "left right", "wide"), ("height", "bottom top", "high")])
@pytest.mark.parametrize("wet", [True, False], ids=["wet", "dry"])
def test_a_periodic_box_in_which_a_grain_meets_another_twice_is_refused(side, ends, word, wet):
    # Twice the cutoff d + skin, with a skin of half the radius: 2.5 d = 4 mm for equal grains of 1.6 mm.
    grains = {"density": 2500, "hydraulic_radius_ratio": 0.8, "grain": [grain(0.0019, 0.0019, 0.0016)]}
    narrow = {"grains": grains, "gate": None} | {f"domain__{end}": "periodic" for end in ends.split()}
    if not wet:
        narrow |= {"fluid": None, "grains__hydraulic_radius_ratio": None}
    line = f"domain.{side} = 0.0038 m: is periodic and so short that a grain would be in contact with another twice "
    line += f"(allowed: >= 0.004 m); make the box 0.004 m {word}, or the grains smaller"
    assert lines(**narrow, **{f"domain__{side}": 0.0038}) == [line]
    assert build(validate(Scene, table(**narrow, **{f"domain__{side}": 0.004}))).grains.discs.count == 1
    for width in (0.001, 0.002):  # narrower than a disc, and than two
        assert lines(**narrow, **{f"domain__{side}": width}) == [line.replace("0.0038", str(width))]


def test_all_faults_of_a_scene_are_said_at_once():
    said = lines(domain__width=0.0121, gate__x=0.0081, grains__packing__height=0.0085)
    assert [line.partition(" ")[0] for line in said] == ["domain.width", "gate.x", "grains.packing.height", "gate.x"]


def test_a_contact_step_beyond_stability_is_refused_without_fluid():
    scene = dry()
    limit = derive(scene).contact_limit
    (line,) = refusals(lambda: derive(dry(contact__step=1.01 * limit)))
    assert line.startswith("contact.step = ")
    assert f"< {limit:.3g} s" in line
    assert "leave it out (it would be" in line
    assert derive(dry(contact__step=0.99 * limit)).contact_step == 0.99 * limit


def test_a_contact_step_divides_the_fluid_step():
    # A wish of 1.9e-5 s in a fluid step of 4e-5 s: three steps of 1.33e-5 s, never longer than asked.
    derived = derive(column(contact__step=1.9e-5))
    assert derived.contact_steps == 3
    assert derived.contact_step == pytest.approx(4e-5 / 3, rel=1e-15)
    assert derive(column(contact__step=2e-5)).contact_steps == 2


def test_a_contact_step_longer_than_that_of_the_fluid_is_said_to_be_cut():
    def said(step: float | None) -> list[str]:
        return [it for it in derive(column(contact__step=step)).warnings if it.startswith("contact.step")]

    cut = derive(column(contact__step=9e-5))
    assert (cut.contact_steps, cut.contact_step) == (1, 4e-5)
    line = "contact.step = 9e-05 s is longer than a step of the fluid, in which the grains do at least one: "
    assert said(9e-5) == [line + "4e-05 s is used; leave contact.step out"]
    assert said(4e-5 * (1 + 1e-6)) != []
    assert said(4e-5 * (1 + 1e-12)) == said(4e-5) == said(1.9e-5) == said(None) == []  # as long, shorter, none


def test_a_mach_number_above_a_tenth_warns_and_above_three_tenths_is_refused():
    # The speed to expect is given: a grain that starts with it.  The sound speed is 5/sqrt(3) m/s.
    def moving(speed: float) -> dict[str, Any]:
        grains = {"density": 2500, "hydraulic_radius_ratio": 1.0, "grain": [grain(0.006, 0.004, velocity=[speed, 0])]}
        return {"grains": grains, "gate": None}

    sound = 5 / 3**0.5
    assert not derive(column(**moving(0.099 * sound))).warnings
    (warning,) = derive(column(**moving(0.2 * sound))).warnings
    assert "Mach 0.2" in warning
    # A tenth of the speed of sound, less a margin of a tenth: step * 0.9 * 0.1/0.2.
    assert "a step of 1.8e-05 s keeps it below 0.1" in warning
    (line,) = lines(**moving(0.31 * sound))
    assert line.startswith("fluid.step = 4e-05 s: a speed of")
    assert "Mach 0.31" in line


def test_the_weight_of_a_column_warns_and_then_refuses_through_the_pore_pressure():
    # 3 (rho_s - rho) g phi H/(rho c^2) = 3 * 1500 * 9.81 * 0.7 * 0.0055/(1000 * 25) = 0.0068 as it stands; the
    # density of the grains sets it, in a fluid viscous enough that the speed stays out of the matter.
    viscous = {"fluid__viscosity": 1e-4}
    still = derive(column(**viscous))
    assert still.density_variation == pytest.approx(3 * 1500 * 9.81 * 0.7 * 0.0055 / 25e3, rel=1e-4)
    heavy = {"grains__density": 1000 + 1500 * 0.1 / still.density_variation, **viscous}
    warnings = warned(column(**heavy), "pore pressure")
    assert "density by 0.1;" in warnings[0]
    heavier = {"grains__density": 1000 + 1500 * 0.31 / still.density_variation, **viscous}
    assert any(
        "pore pressure under the packing can change the fluid's density by 0.31" in it for it in lines(**heavier)
    )


def test_the_repair_of_the_pore_pressure_removes_the_warning():
    viscous = {"fluid__viscosity": 1e-4, "grains__density": 15000.0}
    (warning,) = warned(column(**viscous), "pore pressure")
    step = float(warning.partition("a step of ")[2].partition(" s")[0])
    assert not warned(column(fluid__step=step, **viscous), "pore pressure")


def test_doubts_about_resolution_and_relaxation_time_are_warnings():
    assert any("3.2 cells per diameter" in it for it in derive(column()).warnings)
    low = derive(column(fluid__viscosity=1e-6)).warnings  # tau = 0.503
    assert any(it.startswith("relaxation time 0.5030") for it in low)
    high = derive(column(fluid__viscosity=6e-4)).warnings  # tau = 2.3
    assert any(it.startswith("relaxation time 2.3: above 2") for it in high)


def hand(*grains: dict[str, Any], **changes: Any) -> Scene:
    """A dry box with grains placed by hand."""
    return dry(grains={"density": 2500, "grain": list(grains)}, **changes)


@pytest.mark.parametrize("command", [build, report], ids=["run", "check"])
def test_grains_outside_or_in_each_other_are_named(command):
    out, overlap = refusals(lambda: command(hand(grain(0.003, 0.004), grain(0.0036, 0.004), grain(0.0118, 0.004))))
    assert out.startswith("grains.grain[2] = '(0.0118, 0.004)': reaches out of the box")
    assert overlap.startswith("grains.grain[1]: overlaps grain 0 by 0.0004 m; move one of them")
    assert "grains.overlap" not in overlap  # 0.4 of a diameter, where a tenth may be allowed


def test_grains_that_touch_are_accepted():
    assert build(hand(grain(0.003, 0.0005), grain(0.004, 0.0005))).grains.discs.count == 2


def test_grains_across_a_periodic_side_are_inside_and_overlap_through_it():
    sides = {"domain__left": "periodic", "domain__right": "periodic"}
    assert build(hand(grain(0.0118, 0.004), **sides)).grains.discs.count == 1
    with pytest.raises(InputError, match="overlaps grain 0"):
        build(hand(grain(0.0118, 0.004), grain(0.0002, 0.004), **sides))


def test_a_grain_placed_into_another_beside_a_packing_is_named_by_its_own_number():
    packing = table()["grains"]["packing"] | {"settle": False, "packing_fraction": 0.6}
    placed = [grain(0.003, 0.004), grain(0.01, 0.0025), grain(0.0105, 0.0025)]
    (line,) = refusals(lambda: build(dry(grains={"density": 2500, "packing": packing, "grain": placed})))
    assert line.startswith("grains.grain[2]: overlaps grain 1 by 0.0005 m")


def test_a_packing_needs_head_room_to_settle_from():
    # Placed at an area fraction of 0.75: 0.8 * 0.0075/0.75 + 0.0008 m high.
    (line,) = lines(grains__packing__height=0.0075, grains__packing__packing_fraction=0.8)
    assert line.startswith("grains.packing.height = 0.0075 m: is placed up to 0.0088 m before it settles")
    derive(dry(grains__packing__height=0.0075, grains__packing__packing_fraction=0.8))  # left in place, it needs none


def test_discs_are_not_placed_denser_than_they_can_be():
    assert derive(column(grains__packing__packing_fraction=0.81)).grain_count > 31  # settled: its mean, not its start
    (line,) = refusals(lambda: derive(dry(grains__packing__packing_fraction=0.81)))
    assert line.startswith("grains.packing.packing_fraction = 0.81: ")
    assert "(allowed: <= 0.8)" in line


def test_a_placement_that_jams_is_named_by_its_key():
    jams = {"packing_fraction": 0.8, "height": 0.005, "size_spread": 0}
    line, *_ = refusals(lambda: build(dry(**{f"grains__packing__{key}": value for key, value in jams.items()})))
    assert line.startswith("grains.packing.packing_fraction")


def test_a_grain_across_the_gate_is_named():
    said = refusals(lambda: derive(hand(grain(0.003, 0.004), grain(0.0076, 0.004), gate={"x": 0.008})))
    assert said == ["grains.grain[1] = '(0.0076, 0.004)': stands across the gate by 0.0001 m; move one of them"]


def test_a_packing_settles_straight_down_and_only_if_it_sinks():
    (line,) = lines(gravity=[9.81, 0.0])
    assert line.startswith(
        "gravity = '[9.81, 0]': a packing settles straight down (allowed: [any, -1e-06 or below] m/s^2)"
    )
    assert line.endswith("or set grains.packing.settle = false")
    (line,) = lines(grains__density=1000.0)
    assert line.startswith("grains.density = 1000.0 kg/m^3: the grains do not sink")
    assert "(allowed: > 1000 kg/m^3)" in line
    derive(column(grains__density=1000.0, gravity=[0.0, 0.0], grains__packing__settle=False))


def test_a_packing_is_held_while_it_settles():
    (line,) = lines(gate=None)
    assert line.startswith("grains.packing.left = 0.008 m: nothing holds the packing on its left while it settles")
    (line,) = lines(domain__width=0.02, gate=None)
    assert "on its left and right while" in line
    _, line = lines(domain__bottom="periodic", domain__top="periodic", domain__left="wall", fluid=None)  # and the gate
    assert line.startswith("domain.bottom = 'periodic': there is no floor to settle on")
    alone = {"gate": None, "grains__packing__settle": False}
    derive(column(domain__width=0.02, **alone))  # left where it is placed, it needs no hold
    derive(column(gate=None, domain__width=0.004, grains__packing__left=0.0))  # between two walls
    sides = {"domain__left": "periodic", "domain__right": "periodic"}
    derive(column(gate=None, domain__width=0.004, grains__packing__left=0.0, **sides))  # a full period
    (line,) = lines(gate=None, **sides)
    assert "on its left and right" in line


def test_a_lattice_beyond_the_memory_is_refused_with_a_spacing_that_fits(monkeypatch):
    scene = column()
    derived = derive(scene)
    cost.require_memory(scene, derived)
    monkeypatch.setattr(cost, "ALWAYS", 0.0)
    monkeypatch.setattr(cost, "memory_bytes", lambda: 4096)
    line, *_ = refusals(lambda: cost.require_memory(scene, derived))
    assert line.startswith("fluid.spacing = ")
    assert "takes half of the memory" in line


def test_fields_of_grains_beyond_the_memory_are_refused_with_a_distance_of_points_that_fits():
    scene = column(coarse_graining={"spacing": 1e-8})
    line, *_ = refusals(lambda: cost.require_memory(scene, derive(scene)))
    assert line.startswith("coarse_graining.spacing = 1e-08 m: needs ")
    coarse = column(coarse_graining={"spacing": float(line.partition("points ")[2].split()[0])})
    assert cost.memory(coarse, derive(coarse)) < 0.6 * cost.memory_bytes()


def test_a_channel_is_judged_by_the_speed_that_its_force_drives():
    # Plane Poiseuille: G H^2/(8 rho nu) = 10 * 0.008^2/(8 * 1000 * 2e-5) m/s.
    walls = {"domain__top": "wall", "time__end": 100.0}
    assert derive(water(**walls)).speed == pytest.approx(10 * 0.008**2 / 0.16, rel=1e-12)
    with pytest.raises(InputError, match="Mach"):
        derive(water(**walls, fluid__body_force=[3000.0, 0.0]))


def test_derived_numbers_are_absent_where_parts_are():
    without = dataclasses.asdict(derive(water()))
    for name in ("law", "wall_law", "contact_limit", "contact_step", "contact_steps", "diameters", "gate_column"):
        assert without[name] is None
    assert derive(dry()).scales is None
    assert derive(dry()).cells is None


def test_table_1_as_a_file_is_refused_by_load():
    assert len(refusals(lambda: load(ROOT / "cases" / "column_collapse_table1"))) == 4


def test_snapshots_that_no_disk_holds_are_refused_and_many_are_warned_of():
    def said(interval: float, end: float, key: str = "snapshot_interval") -> Any:
        return report(dry(time__end=end, **{f"output__{key}": interval}))

    (row,) = [it for it in said(0.005, 0.1).groups["Cost"] if it.name == "snapshots"]
    assert row.value == 21
    for key in ("snapshot_interval", "series_interval"):
        line = rf"(?m)^output\.{key} = 1e-12 s: makes \S+ .*, about \S+ GiB; lengthen it$"
        with pytest.raises(InputError, match=line):
            said(1e-12, 1e6, key)
    (doubt,) = [it for it in said(1e-12, 10.0).warnings if "snapshot_interval" in it]
    assert "snapshots, about" in doubt


@pytest.mark.parametrize("section", ["probe", "flux", "line", "region"])
def test_two_measurements_of_one_name_are_refused_and_two_without_one_are_not(section):
    place = {
        "probe": {"x": 0.004, "y": 0.003}, "region": {"lower": [0.001, 0.001], "upper": [0.004, 0.003]},
    }.get(section, {"start": [0.001, 0.001], "end": [0.004, 0.003]})  # fmt: skip
    derive(column(**{section: [place, place]}))
    twice = [place | {"name": "one"}, place | {"name": "one"}]
    (line,) = lines(**{section: twice})
    assert line.startswith(f"{section}[1].name = 'one': is that of another ")
    (line,) = lines(**{section: [place | {"name": "one\ntwo"}]})
    assert "has control characters" in line


@pytest.mark.parametrize("key", ["contact__friction", "contact__wall_friction"])
def test_friction_without_a_spring_or_dashpot_along_the_contact_has_no_effect_and_is_refused(key):
    smooth = {"contact__friction": 0.0, "contact__tangential_stiffness": 0.0, "gate__friction": 0.0}
    derive(column(**smooth))
    (line,) = lines(**{**smooth, key: 0.3})
    assert line.startswith("contact.tangential_stiffness: is needed where there is friction")
    derive(column(**{**smooth, key: 0.3, "contact__tangential_damping": 1.0}))
