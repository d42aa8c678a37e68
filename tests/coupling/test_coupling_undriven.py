"""Where no body force acts none is computed, beside discs too, and the bits are those of a force of nothing."""

import numpy as np
import pytest

from porescale.coupling.step import Coupled
from porescale.lbm import fluid
from porescale.validation.coupling import setups as lab


@pytest.mark.parametrize("operator", ["exact-wall", "SC2"])
def test_cells_with_discs_in_undriven_fluid_have_the_same_bits(monkeypatch, operator):
    def run(law):
        coupled = lab.handful(acceleration=(1e-5, -5e-5))
        coupled = Coupled(
            coupled.fluid, coupled.grains, coupled.scales, hydraulic_ratio=0.8, contact_steps=4,
            acceleration=(1e-5, -5e-5), solid_operator=operator,
        )  # fmt: skip
        coupled.fluid.set_flow(0.03, -0.01)
        seen = []
        monkeypatch.setattr(fluid, "without_force", lambda own: seen.append(law(own)) or seen[-1])
        for _ in range(30):
            coupled.advance()
        return type(seen[-1]).__name__, coupled

    without_force = fluid.without_force
    plain, one = run(lambda own: own)
    free, other = run(without_force)
    assert (plain, free) == ("Trt", "TrtWithoutForce")
    for a, b in ((one.fluid.populations, other.fluid.populations), (one.force, other.force), (one.torque, other.torque),
                 (one.grains.discs.position, other.grains.discs.position)):  # fmt: skip
        np.testing.assert_array_equal(a, b)
    assert np.ptp(one.fluid.populations) > 1e-3
    _, driven = run(lambda own: own._replace(fx=own.fx + 1e-9))  # the twin: a force is seen
    assert not np.array_equal(driven.fluid.populations, other.fluid.populations)
