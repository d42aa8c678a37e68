"""Inflows of a scene: what starts at once rings as a piston does."""

import numpy as np

from porescale.builders.build import build
from tests.reference.scenes import warned, water


def test_an_inflow_that_starts_at_once_rings_and_fluid_that_flows_already_does_not():
    channel = {
        "fluid__body_force": None, "gravity": [0, 0], "time__end": 0.12,
        "domain__left": {"kind": "velocity", "velocity": [0.01, 0.0]},
        "domain__right": {"kind": "pressure", "pressure": 0.0},
    }  # fmt: skip

    def flows(steps, **more):
        """Mean velocity in the middle over that of the inflow, after each step; what is said of it."""
        scene = water(**channel | more)
        simulation, found = build(scene), []
        for _ in range(steps):
            simulation.advance(1)
            found.append(simulation.field("velocity_x")[:, 35:45].mean() / 0.01)
        return np.array(found), warned(scene, "lets fluid in at once")

    at_once, (said,) = flows(420)
    assert "a pulse of 29 Pa goes to and fro at 60.1 Hz" in said  # as of a piston of that speed
    assert 1.8 < at_once.max() < 2.0
    assert at_once[300:].min() < 0.4
    flowing, silent = flows(420, fluid__velocity=[0.01, 0.0])
    assert not silent
    # Walls stop what lies on them at once: the front of that is some 0.1 of the flow of this narrow channel.
    assert np.abs(flowing - 1).max() < 0.2
    # The check that must fail: what flows the other way makes twice as much of it.
    assert "a pulse of 58 Pa" in flows(1, fluid__velocity=[-0.01, 0.0])[1][0]
