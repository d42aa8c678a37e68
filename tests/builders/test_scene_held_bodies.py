"""Held discs that functions of time move, and the ring: what they do, what is refused, none makes nothing."""

import math
import sys
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

from porescale import Scene
from porescale.builders.build import build
from porescale.builders.derive import derive
from porescale.builders.report import report
from porescale.common.record.checkpoint import read_checkpoint, write_checkpoint
from porescale.common.schema.sections import scene_as_dict, validate
from porescale.scene.time_function import TimeFunction
from tests.reference.scenes import column, dry, grain, refusals, warned, water

EPS = np.finfo(float).eps
H = 0.0002
SWING = {"amplitude": 0.02, "frequency": 50.0, "phase": 0.3, "mean": 0.004}
STEPS = [[0.002, 0.0], [0.004, 0.03], [0.01, -0.01]]
DISC: dict[str, Any] = {"x": 0.00604, "y": 0.00398, "diameter": 0.0016}
RING: dict[str, Any] = {"x": 0.00604, "y": 0.00398, "diameter": 0.0064}


def box(**changes: Any) -> Scene:
    """A closed box of 60 x 40 cells of water at rest."""
    given: dict[str, Any] = {"domain__left": "wall", "domain__right": "wall", "domain__top": "wall",
                             "fluid__body_force": None, "gravity": [0.0, 0.0]}  # fmt: skip
    return water(**{**given, **changes})


@pytest.mark.parametrize(
    "table",
    [{"mean": 3.0}, SWING, {"times": [it[0] for it in STEPS], "values": [it[1] for it in STEPS]}],
    ids=["constant", "sine", "table"],
)
def test_the_way_is_the_integral_of_the_velocity(table):
    function = TimeFunction(**table)
    for time in (0.0, 0.001, 0.0031, 0.01, 0.05):
        corners = [it for it in function.times if 0 < it < time]
        exact, _ = quad(function.value, 0.0, time, points=corners or None, epsabs=1e-15, epsrel=1e-13, limit=200)
        assert function.integral(time) == pytest.approx(exact, rel=1e-10, abs=1e-14)
    # The twin: the midpoint rule over the whole of it is not exact where the velocity bends.
    assert table == {"mean": 3.0} or abs(0.05 * function.value(0.025) - function.integral(0.05)) > 1e-5


@pytest.mark.parametrize("wet", [True, False])
def test_a_disc_is_where_its_functions_take_it(wet):
    moved = {**DISC, "velocity_x": SWING, "velocity_y": STEPS, "turning": {"amplitude": 30.0, "frequency": 70.0}}
    still = {**DISC, "x": 0.002, "diameter": 0.001}
    if wet:
        model = build(box(disc=[still, moved]))
    else:
        model = build(dry(grains__packing=None, grains__grain=[grain(0.0105, 0.007)], disc=[still, moved]))
    steps = math.ceil(0.012 / model.step_seconds)
    model.advance(steps)
    section, discs = model.scene.disc[1], model.grains.discs
    x, y, turned = section.travelled(steps * model.step_seconds)
    # A sum of ``steps`` ways: each of their roundings is one of the place.
    off = abs(discs.position[-1] - (section.x + x, section.y + y)).max()
    assert off < steps * EPS * 0.01
    assert discs.angle[-1] == pytest.approx(turned, abs=steps * EPS * 10)
    assert abs(x) > 5e-5 < abs(y)  # the twin: it has not stayed
    assert discs.position[-2].tolist() == [still["x"], still["y"]]


def test_a_resumed_oscillation_is_the_same_in_every_bit(tmp_path):
    given = box(disc=[{**DISC, "velocity_x": SWING, "turning": STEPS}], ring={**RING, "spin": 3.0},
                loads={"discs": [0], "ring": True})  # fmt: skip
    one, other = build(given), build(validate(Scene, scene_as_dict(given)))
    one.advance(37)
    write_checkpoint(tmp_path / "checkpoint.h5", one.state())
    other.restore(read_checkpoint(tmp_path / "checkpoint.h5"))
    one.advance(40)
    other.advance(40)
    assert np.array_equal(one.fluid.populations, other.fluid.populations)
    assert one.tables() == other.tables()
    assert other.tables()["loads"]["disc 0 force x (N/m)"] != 0.0
    changed = build(box(disc=[{**DISC, "velocity_x": {**SWING, "phase": 0.31}}], ring=RING, loads={"ring": True}))
    changed.advance(77)
    assert not np.array_equal(one.fluid.populations, changed.fluid.populations)  # the twin: it would be seen


def couette(cells: int, *, turning: str = "disc", ratio: float = 2.0) -> tuple[Scene, float]:
    """A disc of ``cells`` radius in a ring of twice that, and 4 pi mu W R1² R2²/(R2² - R1²), N m/m."""
    h, n, nu = 0.004 / cells, 4 * cells + 6, 1e-5
    step, inner, outer, spin = 0.1 * h**2 / nu, 0.004, 0.008, 0.1
    x, y, end = (n / 2 + 0.3) * h, (n / 2 + 0.1) * h, 3 * (outer - inner) ** 2 / nu
    table = {
        "domain": {"width": n * h, "height": n * h}, "gravity": [0, 0], "time": {"end": end},
        "output": {"snapshot_interval": end, "series_interval": end},
        "fluid": {"viscosity": nu, "spacing": h, "step": step, "density": 1000},
        "disc": [{"x": x, "y": y, "diameter": 2 * inner, "spin": spin * (turning == "disc")}],
        "ring": {"x": x, "y": y, "diameter": ratio * 2 * inner, "spin": spin * (turning == "ring")},
        "loads": {"discs": [0], "ring": True},
    }  # fmt: skip
    return validate(Scene, table), 4 * math.pi * 1000 * nu * spin * inner**2 * outer**2 / (outer**2 - inner**2)


def torques(*given: Any, **more: Any) -> tuple[float, float]:
    """Torque on the disc and on the ring over the exact one."""
    made, unit = couette(*given, **more)
    model = build(made)
    model.advance(round(made.time.end / model.step_seconds))
    row = model.tables()["loads"]
    return row["disc 0 torque (N m/m)"] / unit, row["ring torque (N m/m)"] / unit


def test_the_load_of_a_disc_has_the_films():
    """The control that moves a grain away from two held discs gives what loads.csv says that the fluid takes."""
    between = {"x": 0.006, "y": 0.004, "diameter": 0.0016}
    beside = [{**between, "x": x} for x in (0.00436, 0.00764)]
    given = {"x": {"velocity": 1e-4}, "y": {"velocity": 0.0}, "rotation": {"velocity": 0.0}}
    grains = {"density": 2500, "hydraulic_radius_ratio": 1, "grain": [between]}
    model = build(
        box(
            grains=grains, disc=beside, control=[{"grain": 0, "record": True, **given}], lubrication={},
            contact={"stiffness": 1e4, "restitution": 0.5}, loads={"discs": [0, 1], "grains": [0]},
        )
    )  # fmt: skip
    model.advance(20)
    tables = model.tables()
    loads = [tables["loads"][f"{name} force x (N/m)"] for name in ("grain 0", "disc 0", "disc 1")]
    # Contacts there are none; the film of a fifth of a cell is several times what the lattice bears.
    assert loads[0] == pytest.approx(-tables["control"]["grain 0 control force x (N/m)"], rel=1e-9)
    assert loads[0] == pytest.approx(-loads[1] - loads[2], rel=0.1)


def shift(cells: int, shift: float = 0.28) -> float:
    """What a disc and a hole that are wider by ``shift`` (cells²) over their radii change of the torque."""
    one, other = cells + shift / cells, 2 * cells + shift / (2 * cells)
    return one**2 * other**2 / (other**2 - one**2) / (4 / 3 * cells**2) - 1


def test_a_disc_that_turns_in_a_ring_bears_the_exact_torque_to_second_order():
    errors = {}
    for cells in (4, 8):
        disc, ring = torques(cells)
        # Not more than the whole shift of the radii, which suits drag and not torque (coupling.taylor_couette_torque).
        assert abs(disc + 1) < shift(cells)
        # What the fluid still takes up after three times (R2 - R1)²/nu: exp(-3 pi²), and the loss of mass by rounding.
        assert ring == pytest.approx(-disc, rel=1e-5)
        errors[cells] = abs(disc + 1)
    assert 2**1.5 < errors[4] / errors[8] < 2**2.6  # second order: 4; first order: 2


def test_a_ring_that_turns_carries_the_disc():
    disc, ring = torques(4, turning="ring")
    assert abs(disc - 1) < shift(4)
    assert abs(ring + 1) < shift(4)


def test_another_ring_is_told_apart():  # the twin that must fail
    disc, _ = torques(4, ratio=2.2)  # a torque of 0.945
    assert abs(disc + 1) > 0.01
    assert abs(disc / -0.945 - 1) < shift(4)


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"ring": {**RING, "x": 0.002}},
         "ring.x = 0.002 m: the ring reaches out of the box (allowed: 0.0032 to 0.0088 m)"),
        ({"ring": {**RING, "diameter": 0.0125}},
         "ring.x = 0.00604 m: the ring reaches out of the box; make ring.diameter 0.012 m at most"),
        ({"ring": {**RING, "radius": 1}}, "ring.radius = 1: unknown key"),
        ({"ring": RING, "disc": [{**DISC, "x": 0.003}]}, "disc[0]: stands in the ring"),
        ({"ring": RING, "disc": [{**DISC, "velocity": [0.4, 0]}]}, "disc[0]: runs into the ring after 0.006"),
        ({"ring": RING, "disc": [{**DISC, "velocity_y": {"amplitude": 1.0, "frequency": 50}}]},
         "disc[0]: runs into the ring after 0.00"),
        ({"ring": RING, "domain__left": "periodic", "domain__right": "periodic"},
         "domain.left = 'periodic': a ring stands in a closed box"),
        ({"ring": RING, "gate": {"x": 0.006}}, "ring: does not go with [gate]"),
        ({"ring": RING, "rectangle": [{"lower": [0.005, 0.003], "upper": [0.006, 0.004]}]},
         "ring: does not go with [rectangle]"),
        ({"ring": {**RING, "diameter": 0.0007}}, "ring.diameter = 0.0007 m: is 3.5 cells wide (allowed: >= 0.0008 m)"),
        ({"loads": {"ring": True}}, "loads.ring = True: there is no [ring]"),
        ({"loads": {}}, "loads.discs, grains, rectangles: name no body"),
        ({"disc": [{**DISC, "velocity_x": SWING, "velocity": [0.1, 0]}]},
         "disc[0].velocity_x: and velocity cannot both be given"),
        ({"disc": [{**DISC, "turning": SWING, "spin": 1}]}, "disc[0].turning: and spin cannot both be given"),
        ({"disc": [{**DISC, "velocity_y": 2e4}]}, "disc[0].velocity_y = 20000.0 m/s: is out of range"),
        ({"disc": [{**DISC, "velocity_x": {"amplitude": 1}}]},
         "disc[0].velocity_x.frequency = 0: is needed for a sine"),
        ({"disc": [{**DISC, "velocity_x": {"mean": 0.01, "phase": 1.0}}]},
         "disc[0].velocity_x.phase = 1.0 rad: is of a sine; give amplitude and frequency, too"),
        ({"disc": [{**DISC, "velocity_x": {"times": [0, 1], "values": [0, 0.01], "phase": 1.0}}]},
         "disc[0].velocity_x.times: a course is a table or a sine"),
        ({"disc": [{**DISC, "velocity_x": {"amplitude": 2.0, "frequency": 50}}]}, "fluid.step = 4e-05 s: a speed of 2"),
        ({"disc": [{**DISC, "velocity_x": {"amplitude": 0.5, "frequency": 50}}],
          "rectangle": [{"lower": [0.0075, 0.003], "upper": [0.008, 0.005]}]},
         "disc[0]: and rectangle 0 run into each other"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused(changes, line):
    lines = refusals(lambda: report(box(**changes)))
    assert any(it.startswith(line) for it in lines), lines


def test_what_is_near_is_not_refused():
    swing = {"amplitude": 0.1, "frequency": 50}
    report(box(ring=RING, disc=[{**DISC, "velocity_x": swing, "turning": swing}]))
    report(box(disc=[{**DISC, "velocity_x": swing}], rectangle=[{"lower": [0.0075, 0.003], "upper": [0.008, 0.005]}]))


def test_grains_and_dry_scenes_have_no_ring():
    lines = refusals(lambda: dry(ring=RING))
    assert any(it.startswith("ring: stands in fluid") for it in lines)
    assert any(it.startswith("ring: does not go with [grains]") for it in lines)


def test_speed_and_sound_of_an_oscillation_are_judged():
    quiet, loud = ({**DISC, "velocity_x": {"amplitude": 0.05, "frequency": f}} for f in (5.0, 50.0))
    assert derive(box(disc=[quiet])).speed == pytest.approx(0.05)
    assert derive(box(disc=[{**DISC, "turning": {"amplitude": 100, "frequency": 5}}])).speed == pytest.approx(0.08)
    corner = math.hypot(RING["x"], 0.008 - RING["y"])
    assert derive(box(ring={**RING, "spin": 10})).speed == pytest.approx(10 * corner)
    said = {k: warned(box(disc=[d]), "swings") for k, d in enumerate((quiet, loud))}
    assert said[0] == []  # the twin
    assert said[1][0].startswith("disc 0 swings at 50 Hz, by 1.3 rad while sound crosses the box")


def test_a_rotation_faster_than_steps_is_judged():
    def said(frequency):
        disc = {**DISC, "turning": {"amplitude": 1.0, "frequency": frequency}}
        return warned(box(disc=[disc]), "turns to and fro")

    step = derive(box(disc=[DISC])).scales.step
    assert said(0.04 / step) == []  # 0.25 rad a step
    (line,) = said(100 / step)  # whole periods a step: every step sees the same spin
    assert line.startswith("disc 0 turns to and fro at ")
    assert ", by 628 rad of its oscillation a step: a step of" in line.replace("6.3e+02", "628")


def test_a_body_that_is_moved_at_one_speed_does_not_swing():
    def said(way):
        grains = {
            "density": 2500,
            "hydraulic_radius_ratio": 1.0,
            "grain": [{"x": 0.006, "y": 0.004, "diameter": 0.001}],
        }
        given = {"gate": None, "grains": grains, "gravity": [0.0, 0.0]}
        return warned(column(**given, control=[{"grain": 0, "x": {"displacement": way}}]), "swings")

    assert said([[0.0, 0.0], [0.004, 2e-4]]) == []
    assert said([[0.0, 0.0], [0.002, 1e-4], [0.004, 1e-4]]) == []
    (line,) = said([[0.0, 0.0], [0.004, 2e-4], [0.008, 0.0]])  # the check that must fail: it comes back
    assert line.startswith("what control 0 moves swings at 79.6 Hz")


def test_nothing_of_it_is_built_where_there_is_none():
    sys.modules.pop("porescale.builders.parts.discs", None)
    model = build(box(disc=[{**DISC, "velocity": [0.01, 0.0]}]))
    assert "porescale.builders.parts.discs" not in sys.modules
    assert [type(it).__name__ for it in model.parts].count("DiscsPart") == 0
    assert len(model.coupled.ring_load) == 0
    assert model.coupled.saturated.bodies is None
    moved = build(box(disc=[{**DISC, "velocity_x": SWING}], ring=RING))  # the twin
    assert [type(it).__name__ for it in moved.parts].count("DiscsPart") == 1
    assert moved.coupled.saturated.bodies is not None


def test_a_constant_function_is_a_towed_disc():
    # Means over a step of a constant are that constant to a rounding of t, some 1e-12 of it.
    one, other = (build(box(disc=[{**DISC, **it}])) for it in ({"velocity": [0.01, 0]}, {"velocity_x": 0.01}))
    for model in (one, other):
        model.advance(50)
    fields = [it.fields()[1] for it in (one, other)]
    assert np.abs(fields[0] - fields[1]).max() < 1e-10 * 0.01 / EPS**0.25
    assert np.abs(fields[0]).max() > 0.005
