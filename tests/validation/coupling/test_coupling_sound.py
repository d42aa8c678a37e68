"""Motion that sound does not keep up with is damped wrongly, and `check` says so; a gate that thins the water, too."""

import math

import pytest

from porescale.builders.build import build
from porescale.builders.checks.limits import DENSITY_WARN, SOUND_WARN
from porescale.builders.checks.sound import gate_suction, rate_of
from porescale.builders.derive import derive, fluid_scales
from porescale.builders.scene import Scene
from porescale.common.schema.sections import load
from porescale.scene.time_function import TimeFunction
from porescale.validation.coupling.sound import SLOW, damping, turn
from tests.reference.folders import CASES
from tests.validation.tolerances import tolerance

pytestmark = pytest.mark.usefixtures("one_thread")
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


def told(scene, word):
    return [it for it in derive(scene).warnings if word in it]


def test_damping_is_lost_where_sound_is_too_slow():
    """The row holds at 0.24 rad a crossing; at 2.4 it misses by several times as much."""
    assert turn(SLOW) < SOUND_WARN
    assert turn(0.8) > SOUND_WARN
    assert abs(damping(0.8) - 1) > 4 * tolerance("coupling.damping_at_ten_cells")


def test_a_swing_is_judged_by_what_sound_crosses():
    # W f/c, c 4.81 m/s: 0.3 rad at 6.4 Hz.
    assert not told(swinging(amplitude=0.01, frequency=6), "acoustic")
    assert "disc 0 swings at 7 Hz" in told(swinging(amplitude=0.01, frequency=7), "acoustic")[0]


def test_a_table_is_judged_by_its_steepest_slope():
    def ramp(seconds):
        table = [(0.0, 0.0), (seconds, 0.01)]
        return water(disc=[{"x": 0.018, "y": 0.018, "diameter": 5e-3, "velocity_y": table}])

    slow, fast = ramp(0.1), ramp(0.01)
    assert not told(slow, "acoustic")
    assert told(fast, "acoustic")
    assert rate_of(TimeFunction(times=(0.0, 0.5, 1.0), values=(3.0, 3.0, 5.0))) == pytest.approx(2.0)
    assert rate_of(TimeFunction(mean=3.0)) == rate_of(TimeFunction(times=(0.0, 1.0), values=(2.0, 2.0))) == 0.0


def test_an_inflow_of_a_user_is_judged_too(tmp_path):
    (tmp_path / "laws.py").write_text(
        "import math\nimport porescale as ps\n\n@ps.inflow\ndef wave(s, t):\n"
        "    return 0.01 * math.sin(2 * math.pi * 10 * t), 0.0\n\n@ps.inflow\ndef slow(s, t):\n"
        "    return 0.01 * math.sin(2 * math.pi * 2 * t), 0.0\n"
    )
    (tmp_path / "scene.toml").write_text(
        '[domain]\nwidth = 0.036\nheight = 0.036\nright = { kind = "pressure", pressure = 0 }\n'
        'left = { kind = "velocity", velocity = "laws.py:NAME" }\n[time]\nend = 1\n'
        "[output]\nsnapshot_interval = 1\nseries_interval = 1\n"
        "[fluid]\ndensity = 1000\nviscosity = 1e-4\nspacing = 3.75e-4\nstep = 4.5e-5\n"
    )
    text = (tmp_path / "scene.toml").read_text()
    for name, warned in (("wave", True), ("slow", False)):
        (tmp_path / "scene.toml").write_text(text.replace("NAME", name))
        found = told(load(tmp_path, Scene), "left side")
        assert bool(found) == warned, found


def column(speed, **more):
    settings = [f"gate.lift_speed={speed}", *(f"{key.replace('__', '.')}={value}" for key, value in more.items())]
    return load(CASES / "column_collapse", Scene, overrides=settings)


def test_a_gate_that_thins_the_water_is_seen_before_the_run():
    # Runs of the case: 0.048 at 0.3 m/s, 0.034 at 0.25, 0.072 at 0.5, 0.017 with half the step.
    assert not told(column(0.3), "lift_speed")
    assert "thinner by 0.075" in told(column(0.5), "lift_speed")[0]
    assert not told(column(0.5, fluid__step=2.25e-5), "lift_speed")
    assert not told(load(CASES / "column_collapse", Scene), "lift_speed")  # a gate that vanishes draws nothing


def test_suction_at_the_edge_of_a_gate_is_that_of_a_run():
    scene = water(gate={"x": 48 * SPACING, "lift_speed": 0.5})
    scales, model, least = fluid_scales(scene.fluid), build(scene), 1.0
    for _ in range(12):  # the edge rises by a half of a cell, and sound goes seven
        model.advance(1)
        least = min(least, float(model.fluid.fields()[0].min()))
    expected = gate_suction(scene, scales, 0.5) / (scales.density * scales.sound_speed**2)
    # The two terms are fits to 10 %, and the run's start rings by as much.
    assert 1 - least == pytest.approx(expected, rel=0.2)
    assert abs(1 - least - expected / 2) > 0.2 * expected  # the twin: half the speed
    assert expected < DENSITY_WARN
    assert math.isfinite(expected)
