"""What a slip of the hand makes of a scene is said before it runs: angles for coefficients, gates that stay shut, and
contacts that cannot bear the packing."""

import math

import pytest

from porescale.builders.build import build
from porescale.builders.derive import derive
from porescale.common.core.errors import Unstable
from porescale.dem.measures.survey import max_overlap
from tests.reference.scenes import column, dry, warned, water

STANDS = {"left": 0.008, "width": 0.004, "height": 0.006, "diameter": 0.0008, "packing_fraction": 0.8}
"""A bed behind a gate, 7 grains high."""
GATE = {"x": 0.008, "opens_at": 0.0}


def bed(stiffness, **contact):
    """A bed that settles dry behind its gate."""
    law = {"stiffness": stiffness, "tangential_stiffness": 0.5 * stiffness, "restitution": 0.5, "friction": 0.5}
    return dry(grains={"density": 2500, "packing": STANDS}, contact={**law, **contact}, gate=GATE, time__end=0.1)


@pytest.mark.parametrize("value", [30, 30.0, 17.5])
@pytest.mark.parametrize("key", ["contact__friction", "contact__wall_friction", "gate__friction"])
def test_a_friction_that_looks_like_an_angle_is_asked_about(key, value):
    (line,) = warned(column(**{key: value}), "is a coefficient")
    assert line.startswith(f"{key.replace('__', '.')} = {value:g} is a coefficient; if an angle of {value:g} degrees")
    assert line.endswith(f"its tangent is {math.tan(math.radians(value)):.3g}")


@pytest.mark.parametrize("value", [0.0, 0.5, 2.0, 1000.0])
def test_a_friction_of_a_surface_or_of_one_that_never_slides_is_not(value):
    assert not warned(column(contact__friction=value), "is a coefficient")


def test_a_gate_that_opens_after_the_run_or_lets_no_grain_pass_is_said_to_stay_shut():
    end = column().time.end
    (line,) = warned(column(gate__opens_at=10.0), "stays shut")
    assert line == f"gate.opens_at = 10 s: the run ends before, at {end:g} s, and the gate stays shut"
    (line,) = warned(column(gate__opens_at=0.0, gate__lift_speed=1e-6), "lets none pass")
    assert f"it has risen by {1e-6 * end:.2g} m" in line
    vanishes = {"gate": {"x": column().gate.x, "opens_at": 0.0}}  # at once
    assert not warned(column(**vanishes), "stays shut")
    assert not warned(column(**vanishes), "lets none pass")


def test_a_rectangle_that_starts_after_the_run_is_said_to_stand_still():
    late = {"lower": [0.007, 0.002], "upper": [0.008, 0.008], "velocity": [0.01, 0.0], "starts_at": 5.0}
    (line,) = warned(water(rectangle=[late]), "stands still")
    assert line == f"rectangle[0].starts_at = 5 s: the run ends before, at {water().time.end:g} s, and it stands still"
    assert not warned(water(rectangle=[late | {"starts_at": 0.0}]), "stands still")
    closed = {"domain__left": "wall", "domain__right": "wall", "fluid__body_force": None}
    gate = {"x": 0.006, "opens_at": 5.0}
    assert len(warned(water(**closed, gate=gate), "stays shut")) == 1  # of a gate without grains, too
    assert not warned(water(rectangle=[late | {"velocity": [0.0, 0.0]}]), "stands still")


def test_contacts_that_cannot_bear_the_packing_are_warned_of_with_how_stiff_they_should_be():
    assert not warned(bed(2e5), "too soft for the packing")
    (line,) = warned(bed(50.0), "too soft for the packing")
    times = float(line.partition("; ")[2].split()[0])
    # 4 times the weight above a diameter of width, 0.8 * 2500 g * 5.2 mm * 0.8 mm, is 5 % of 0.8 mm at 8160 N/m.
    assert 50.0 * times == pytest.approx(8160.0, rel=0.05)  # two digits
    assert not warned(bed(1.06 * 50.0 * times), "too soft for the packing")
    with pytest.raises(Unstable):
        build(bed(50.0))
    model = build(bed(1.06 * 50.0 * times))
    assert 0.01 < 0.5 * max_overlap(model.grains).share < 0.05  # the strongest is 2 to 4 times the mean


def test_the_same_by_hertz():
    def hertz(young):
        law = {"law": "hertz", "young": young, "poisson": 0.3, "restitution": 0.5, "friction": 0.5}
        return dry(grains={"density": 2500, "packing": STANDS}, contact=law, gate=GATE, time__end=0.1)

    (line,) = warned(hertz(3e4), "too soft for the packing")
    times = float(line.partition("; ")[2].split()[0])
    assert times > 1.0
    assert not warned(hertz(1.06 * 3e4 * times), "too soft for the packing")
    assert warned(hertz(0.94 * 3e4 * times), "too soft for the packing")
    model = build(hertz(1.06 * 3e4 * times))
    assert 0.01 < 0.5 * max_overlap(model.grains).share < 0.05


GRAIN = {"x": 0.005, "y": 0.004, "diameter": 8e-4}
FLOOR = {"chain": [[0.002, 0.001], [0.008, 0.001]], "thickness": 2e-4}
LAW = {"stiffness": 1e5, "restitution": 0.5}


def one(**sections):
    """A grain in a box of its own."""
    return dry(grains={"density": 2500, "grain": [GRAIN]}, contact=LAW, time__end=0.01, **sections)


def test_a_displacement_that_leaps_is_said_to_need_many_steps():
    def moved(within):
        return one(control=[{"grain": 0, "x": {"displacement": [[0, 0], [within, 1e-3]]}}])

    (line,) = warned(moved(1e-9), "times as many as contacts need")
    assert "what moves at 1e+06 m/s" in line
    assert not warned(moved(1e-2), "times as many as contacts need")


def test_the_speed_to_expect_of_a_container_is_that_of_its_end_farthest_from_the_pivot():
    def speed(pivot):
        return derive(one(container=[FLOOR | {"pivot": pivot, "rotation": {"velocity": 100}}])).speed

    assert speed([5.002, 0.001]) == pytest.approx(500)
    assert speed([0.005, 0.001]) == pytest.approx(0.6)  # no less than its own length: as it was before


def test_what_a_cell_presses_together_is_judged_by_its_rate_and_the_largest_grains():
    sides = dict.fromkeys(("left", "right", "bottom", "top"), "periodic")
    d = dry()

    def cell(rate):
        packing = {"left": 0, "bottom": 0, "width": d.domain.width, "height": d.domain.height, "diameter": 8e-4,
                   "packing_fraction": 0.5, "settle": False}  # fmt: skip
        own = {"gravity": [0, 0], "grains": {"density": 2500, "packing": packing}, "contact": LAW}
        return dry(**{f"domain__{side}": word for side, word in sides.items()}, **own, cell={"rate_xy": rate})

    strained = derive(cell(-10.0))
    assert strained.diameters[2] > 8e-4
    assert strained.speed == pytest.approx(10 * strained.diameters[2], rel=1e-12)
    assert warned(cell(1e5), "contacts are too soft")
    assert not warned(cell(1.0), "contacts are too soft")
