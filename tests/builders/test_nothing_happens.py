"""What does not happen is not computed, and nothing else changes by that: to the bit."""

import numpy as np

from porescale import Scene
from porescale.builders.build import build
from porescale.builders.parts.gate import GatePart
from porescale.common.schema.sections import validate
from porescale.coupling.psm import SaturatedCells
from porescale.lbm.fluid import Fluid


def stirred(places: list[np.ndarray], anew: bool) -> tuple[np.ndarray, np.ndarray]:
    """Populations and loads of water about discs at these places, one step each; covered anew or as it happens."""
    fluid = Fluid(24, 20, 0.7)
    fluid.set_flow(0.03, 0.01)
    wet = SaturatedCells(fluid, np.array([3.0, 2.5]))
    for place in places:
        if anew:
            wet._placed[:] = np.nan
        wet.advance(fluid, place, np.zeros((2, 2)), np.zeros(2))
    return fluid.populations, np.column_stack((wet.force, wet.torque))


def test_discs_that_stand_are_covered_once():
    here = np.array([[7.3, 8.1], [16.2, 11.4]])
    places = [here, here, here + 0.2, here + 0.2, here]
    for one, other in zip(stirred(places, False), stirred(places, True), strict=True):
        assert np.array_equal(one, other)


def test_looking_at_the_cells_between_steps_changes_nothing():
    fluids = [Fluid(24, 20, 0.7) for _ in range(2)]
    place, still, spin = np.array([[7.3, 8.1]]), np.zeros((1, 2)), np.zeros(1)
    wets = [SaturatedCells(fluid, np.array([3.0])) for fluid in fluids]
    for step in range(4):
        for k, (fluid, wet) in enumerate(zip(fluids, wets, strict=True)):
            if k and step == 2:
                kept, wet.covering_radius = wet.covering_radius, wet.radius
                wet.cover(place, still, spin)
                wet.covering_radius = kept
            if step == 0:
                fluid.set_flow(0.02, 0.0)
            wet.advance(fluid, place, still, spin)
    assert np.array_equal(fluids[0].populations, fluids[1].populations)


def test_dry_steps_are_the_same_however_they_are_called():
    table = {
        "domain": {"width": 0.04, "height": 0.04}, "time": {"end": 1},
        "output": {"snapshot_interval": 1, "series_interval": 1},
        "grains": {"density": 2500, "grain": [{"x": 0.01, "y": 0.008, "diameter": 0.01, "velocity": [0.3, 0.1]},
                                              {"x": 0.022, "y": 0.006, "diameter": 0.01, "velocity": [-0.4, 0]}]},
        "contact": {"stiffness": 1e5, "tangential_stiffness": 2.5e4, "restitution": 0.5, "friction": 0.5},
        "gate": {"x": 0.03, "opens_at": 0.01},
    }  # fmt: skip
    one, other = (build(validate(Scene, table)) for _ in range(2))
    steps = round(0.03 / one.step_seconds)
    one.advance(steps // 2)  # until after the gate has gone
    one.advance(steps - steps // 2)
    for _ in range(steps):
        other.advance(1)
    assert one.part(GatePart).open
    assert one.step == other.step == steps
    assert one.time == other.time
    for name in ("position", "velocity", "spin", "force"):
        assert np.array_equal(getattr(one.grains.discs, name), getattr(other.grains.discs, name)), name
