"""What drives the fluid acts on every body in it, whatever its shape, and would be missed."""

import math

import numpy as np
import pytest

from porescale.builders.build import build
from porescale.coupling.psm import SaturatedCells
from porescale.coupling.step import Coupled
from porescale.scene.scene import Scene
from porescale.validation.coupling import driven
from porescale.validation.coupling import setups as lab
from tests.validation.tolerances import tolerance

SPACING = 5e-4
SQUARE = [[-1e-3, -1e-3], [1e-3, -1e-3], [1e-3, 1e-3], [-1e-3, 1e-3]]


def without_push(monkeypatch):
    monkeypatch.setattr(SaturatedCells, "_push_bodies", lambda wet: None)


def test_without_the_push_a_disc_bears_less_than_what_drives(monkeypatch):
    assert driven.share_of_drive(0.4) == pytest.approx(1.0, abs=tolerance("coupling.drag_balances_what_drives"))
    without_push(monkeypatch)
    assert driven.share_of_drive(0.4) == pytest.approx(0.6, abs=0.01)  # the shift of the radius takes 0.4 % of the box


def test_without_the_push_neutral_discs_lag(monkeypatch):
    without_push(monkeypatch)
    _, discs = driven.start(1.0)
    assert 1 - discs > 10 * tolerance("coupling.neutral_discs_start_with_the_water")


def test_a_disc_at_rest_in_a_closed_box_bears_nothing():
    def left(coupled):
        return abs(driven.on_disc(coupled)) / (1e-6 * coupled.saturated.covering_radius[0] ** 2 * math.pi)

    coupled = lab.immersed((24, 24), [(12.3, 12.1)], 5.0, 1.0, force=(1e-6, 0.0))
    coupled.grains.hold(0)
    for _ in range(3000):
        coupled.advance()
    # What covered cells exchange among themselves halves every 1400 steps here, from 1e-5 on: 1e-5 after 3000.
    assert left(coupled) < 1e-5
    coupled.push[:] = 0.0
    assert left(coupled) > 0.9


def scene(**more):
    """A periodic box of 8 mm, driven by 1 N/m^3 along x."""
    sides = dict.fromkeys(("left", "right", "bottom", "top"), "periodic")
    return Scene(
        domain={"width": 8e-3, "height": 8e-3} | sides, time={"end": 1.0},
        output={"snapshot_interval": 1.0, "series_interval": 1.0}, gravity=(0.0, 0.0),
        fluid={"density": 1000.0, "viscosity": 2.5e-5, "spacing": SPACING, "relaxation_time": 0.8,
               "body_force": (1.0, 0.0)}, **more,
    )  # fmt: skip


BODIES = {
    "disc": {"disc": [{"x": 4.1e-3, "y": 4.05e-3, "diameter": 3e-3}], "loads": {"discs": [0]}},
    "rectangle": {
        "rectangle": [{"lower": (2.6e-3, 2.1e-3), "upper": (5.3e-3, 5.2e-3)}], "loads": {"rectangles": [0]},
    },
}  # fmt: skip


@pytest.mark.parametrize("body", BODIES)
def test_the_loads_of_a_run_are_what_drives_the_box(body):
    model = build(scene(**BODIES[body]))
    model.advance(6000)
    row = model.tables()["loads"]
    # steady to exp(-nu pi² t/L²), and 0.2 % as required
    assert row[f"{body} 0 force x (N/m)"] == pytest.approx(8e-3**2 * 1.0, rel=2e-3)
    assert row[f"{body} 0 force y (N/m)"] == pytest.approx(0.0, abs=2e-3 * 8e-3**2)


def test_momentum_of_free_bodies_and_water_grows_by_all_that_drives():
    """Discs of any density, spinning and flying, at lambda 1: dp/dt = F N in every step, but for what cells share."""
    coupled = lab.handful(ratio=1.0)
    force = 1e-6
    coupled = lab.Coupled(
        lab.Fluid(60, 40, 0.6, force=(force, 0.0), sides=lab.PERIODIC), coupled.grains, coupled.scales,
        hydraulic_ratio=1.0, contact_steps=4, acceleration=(0.0, 0.0),
    )  # fmt: skip
    before, steps = coupled.momentum()[0], 40
    pushed = 0.0
    for _ in range(steps):
        coupled.advance()
        pushed += float(np.sum(coupled.push[:, 0]))
    grown = coupled.momentum()[0] - before
    assert grown == pytest.approx(force * 60 * 40 * steps, rel=2e-3)
    assert pushed > 0.1 * grown  # the twin: without it as much would lack


def test_a_clump_is_pushed_by_its_union(monkeypatch):
    allowed = tolerance("coupling.neutral_clumps_start_with_the_water")
    assert driven.clump_start() == pytest.approx(1.0, abs=allowed)
    monkeypatch.setattr(Coupled, "_join", lambda *given: None)  # the twin: the area of both members
    assert driven.clump_start() == pytest.approx(1.028, abs=0.002)
