"""Motion that sound does not keep up with is damped wrongly, and `check` says so; a gate that thins the water, too."""

import math

import pytest

from porescale.builders.build import build
from porescale.builders.checks import own_laws
from porescale.builders.checks.limits import SOUND_WARN
from porescale.builders.checks.own_laws import inflow_rate
from porescale.builders.checks.sound import gate_suction, rate_of
from porescale.builders.derive import fluid_scales
from porescale.builders.scene import Scene
from porescale.common.schema.sections import load
from porescale.scene.time_function import TimeFunction
from porescale.validation.coupling.sound import SLOW, damping, turn
from tests.reference.folders import CASES
from tests.reference.scenes import warned
from tests.validation.tolerances import tolerance

SPACING = 3.75e-4


def water(**more):
    """A box of 96 cells of a viscous liquid."""
    size = 96 * SPACING
    return Scene(
        domain={"width": size, "height": size, "top": "slip"} | more.pop("domain", {}), time={"end": 1.0},
        output={"snapshot_interval": 1.0, "series_interval": 1.0}, gravity=(0.0, 0.0),
        fluid={"density": 1000, "viscosity": 1e-4, "spacing": SPACING, "step": 4.5e-5}, **more,
    )  # fmt: skip


def swinging(**course):
    return water(disc=[{"x": 0.018, "y": 0.018, "diameter": 5e-3, "velocity_x": course}])


SEEN = 0.01
"""Of 200 phases at random, one is within 0.1 rad of the steepest but for (1 - 0.2/pi)^200 = 2e-6, which loses 0.5 %;
the reach, from as many, loses as much at most."""


def waves(folder, frequency, end=1.0):
    """A box with a velocity at its left side that swings at ``frequency``, Hz."""
    (folder / "laws.py").write_text(
        "import math\nimport porescale as ps\n\n@ps.inflow\ndef wave(s, t):\n"
        f"    return 0.01 * math.sin(2 * math.pi * {frequency} * t), 0.0\n"
    )
    (folder / "scene.toml").write_text(
        '[domain]\nwidth = 0.036\nheight = 0.036\nright = { kind = "pressure", pressure = 0 }\n'
        f'left = {{ kind = "velocity", velocity = "laws.py:wave" }}\n[time]\nend = {end}\n'
        "[output]\nsnapshot_interval = 1\nseries_interval = 1\n"
        "[fluid]\ndensity = 1000\nviscosity = 1e-4\nspacing = 3.75e-4\nstep = 4.5e-5\n"
    )
    return load(folder, Scene)


def test_damping_is_lost_where_sound_is_too_slow():
    """The row holds at 0.24 rad a crossing; at 2.4 it misses by several times as much."""
    assert turn(SLOW) < SOUND_WARN
    assert turn(0.8) > SOUND_WARN
    assert abs(damping(0.8) - 1) > 4 * tolerance("coupling.damping_at_ten_cells")


def test_a_swing_is_judged_by_what_sound_crosses():
    # W f/c, c 4.81 m/s: 0.3 rad at 6.4 Hz.
    assert not warned(swinging(amplitude=0.01, frequency=6), "acoustic")
    assert "disc 0 swings at 7 Hz" in warned(swinging(amplitude=0.01, frequency=7), "acoustic")[0]


def test_a_table_is_judged_by_its_steepest_slope():
    def ramp(seconds):
        table = [(0.0, 0.0), (seconds, 0.01)]
        return water(disc=[{"x": 0.018, "y": 0.018, "diameter": 5e-3, "velocity_y": table}])

    slow, fast = ramp(0.1), ramp(0.01)
    assert not warned(slow, "acoustic")
    assert warned(fast, "acoustic")
    # From 3 to 5 in half a second: 4 1/s over half the range, 1.
    assert rate_of(TimeFunction(times=(0.0, 0.5, 1.0), values=(3.0, 3.0, 5.0))) == pytest.approx(4.0)
    assert rate_of(TimeFunction(mean=3.0)) == rate_of(TimeFunction(times=(0.0, 1.0), values=(2.0, 2.0))) == 0.0


def test_a_motion_has_one_rate_however_it_is_given(tmp_path):
    sine = rate_of(TimeFunction(mean=1.0, amplitude=0.01, frequency=5))
    times = [k / 1000 for k in range(1001)]
    table = rate_of(TimeFunction(times=times, values=[1 + 0.01 * math.sin(10 * math.pi * t) for t in times]))
    assert sine == pytest.approx(10 * math.pi)
    # A chord of a 200th of a turn from where it is steepest is less steep by (2 pi/200)²/6 = 1.6e-4.
    assert table == pytest.approx(sine, rel=2e-4)
    assert inflow_rate(waves(tmp_path, 5), "left", 4.5e-5) == pytest.approx(sine, rel=SEEN)


@pytest.mark.parametrize("end", [1.0, 7.0])
@pytest.mark.parametrize("frequency", [1, 100, 199, 200, 201, 987, 1000])
def test_the_rate_of_an_inflow_does_not_depend_on_how_often_it_was_looked_at(tmp_path, frequency, end):
    step = 4.5e-5
    chord = math.sin(math.pi * frequency * step) / (math.pi * frequency * step)
    seen = inflow_rate(waves(tmp_path, frequency, end), "left", step)
    assert seen == pytest.approx(2 * math.pi * frequency * chord, rel=SEEN)


def test_looks_in_a_rhythm_miss_what_has_it(tmp_path, monkeypatch):
    """The check that must fail: 201 times at even distances see 199 Hz as 1 Hz."""
    monkeypatch.setattr(own_laws, "times_of_looks", lambda end, step: [end * k / 200 for k in range(201)])
    assert inflow_rate(waves(tmp_path, 199), "left", 4.5e-5) == pytest.approx(2 * math.pi, rel=SEEN)


def test_an_inflow_of_a_user_is_judged_too(tmp_path):
    for frequency, late in ((10, True), (2, False)):
        found = warned(waves(tmp_path, frequency), "left side")
        assert bool(found) == late, found


def column(speed, **more):
    settings = [f"gate.lift_speed={speed}", *(f"{key.replace('__', '.')}={value}" for key, value in more.items())]
    return load(CASES / "column_collapse", Scene, overrides=settings)


def test_a_gate_that_thins_the_water_is_seen_before_the_run():
    # Runs of the case: 0.048 at 0.3 m/s, 0.034 at 0.25, 0.072 at 0.5, 0.017 with half the step.
    assert not warned(column(0.3), "lift_speed")
    assert "thinner by 0.075" in warned(column(0.5), "lift_speed")[0]
    assert not warned(column(0.5, fluid__step=2.25e-5), "lift_speed")
    assert not warned(load(CASES / "column_collapse", Scene), "lift_speed")  # a gate that vanishes draws nothing


def test_suction_at_the_edge_of_a_gate_is_that_of_a_run():
    scene = water(gate={"x": 48 * SPACING, "lift_speed": 0.5})
    scales, model, least = fluid_scales(scene.fluid), build(scene), 1.0

    def predicted(speed):
        return gate_suction(scene, scales, speed) / (scales.density * scales.sound_speed**2)

    for _ in range(12):  # the edge rises by a half of a cell, and sound goes seven
        model.advance(1)
        least = min(least, float(model.fluid.fields()[0].min()))
    # The two terms are fits to 10 %, and the run's start rings by as much.
    assert 1 - least == pytest.approx(predicted(0.5), rel=0.2)
    assert 1 - least != pytest.approx(predicted(0.25), rel=0.2)  # the check that must fail: half the speed
