"""Dry steps that nothing interrupts are done in one call: the same bits, loads and times as one after another."""

from typing import Any

import pytest

from porescale import Scene
from porescale.builders.build import build
from porescale.builders.parts.gate import GatePart
from tests.fingerprints.digest import fingerprint
from tests.reference.scenes import column, dry, grain

pytestmark = pytest.mark.filterwarnings("ignore:.*makes no bond")  # by then all that touches is bonded
STEPS = 600
"""Contact steps: 5 to 10 ms, in which the scenes below open, bond and press."""
SQUARE: dict[str, Any] = {"sides": 4, "diameter": 0.0015, "thickness": 1e-4, "at": [[0.002, 0.007]], "density": 2500.0}
DISC = {"x": 0.0074, "y": 0.001, "diameter": 0.001}
BLOCK: dict[str, Any] = {"lower": [0.006, 0.0], "upper": [0.0078, 0.004]}
PUSHED = {"polygon": 0, "y": {"velocity": -0.1}, "rotation": {"velocity": 30.0}, "record": True}
LATER = 4e-3

SCENES: dict[str, dict[str, Any]] = {
    "gate": {"gate": {"x": 0.008, "opens_at": LATER}},
    "lifted gate": {"gate": {"x": 0.008, "opens_at": LATER, "lift_speed": 0.5}, "output__energy": True},
    "polygon": {"polygon": [SQUARE], "output__energy": True},
    "driven polygon": {"polygon": [SQUARE], "control": [PUSHED]},
    "held disc": {"disc": [DISC]},
    "turning disc": {"disc": [{**DISC, "turning": 20.0}]},
    "bonds": {
        "grains__packing": None, "grains__overlap": 0.01,
        "grains__grain": [grain(0.003 + 0.000995 * k, 0.0005) for k in range(4)],
        "bonds": [{"at": 0.0, "bodies": ["grain 0", "grain 1"]}, {"at": LATER}],
    },
    "walls that move": {"wall": [{"x": 0.006, "y": 0.0, "normal": [1.0, 0.0], "velocity_x": 0.2}]},
    "cell": {
        "domain__left": "periodic", "domain__right": "periodic", "domain__bottom": "periodic",
        "domain__top": "periodic", "cell": {"rate_xy": 400.0}, "gravity": [0.0, 0.0],
    },
    "rectangle": {"rectangle": [{**BLOCK, "velocity": [0.2, 0.0]}]},
    "rectangle that stands": {"rectangle": [BLOCK]},
    "rectangle for a while": {"rectangle": [{**BLOCK, "velocity": [0.2, 0.0], "starts_at": 2e-3, "stops_at": LATER}]},
}  # fmt: skip


def scene_of(name: str) -> Scene:
    """The scene of that name."""
    return dry(**SCENES[name])


@pytest.mark.parametrize("name", SCENES)
def test_steps_at_once_have_the_bits_of_steps_one_by_one(name):
    one, many = build(scene_of(name)), build(scene_of(name))
    for count in (1, 2, 140, STEPS - 143):
        for _ in range(count):
            one.advance(1)
        many.advance(count)
        assert fingerprint(one.state()) == fingerprint(many.state())
        assert one.series() == many.series()
        assert one.tables() == many.tables()
        assert one.time == many.time
    assert one.step == STEPS


def test_parts_that_have_nothing_to_do_do_not_part_the_steps(monkeypatch):
    calls: list[int] = []
    for name in SCENES:
        model = build(scene_of(name))
        model.advance(1)
        step = model.grains.step
        monkeypatch.setattr(model.grains, "step", lambda *a, own=step, **k: calls.append(1) or own(*a, **k))
        calls.clear()
        model.advance(STEPS - 1)
        told = {"turning disc": STEPS - 1, "rectangle": STEPS - 1, "rectangle for a while": 2e-3 / model.step_seconds}
        least = told.get(name, 1)  # steps in which what moves is told its way
        assert least <= len(calls) <= least + 8, name


def test_a_gate_that_opens_late_gives_other_bits(monkeypatch):  # the twin that must fail
    one = build(scene_of("gate"))
    one.advance(STEPS)
    monkeypatch.setattr(
        GatePart, "acts_from", property(lambda self: 0.0 if self.open else LATER / one.step_seconds + 100)
    )
    late = build(scene_of("gate"))
    late.advance(STEPS)
    assert fingerprint(one.state()) != fingerprint(late.state())


def test_a_wet_scene_goes_step_by_step():
    assert not build(column()).stepper.takes_many
