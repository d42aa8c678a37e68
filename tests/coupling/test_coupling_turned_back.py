"""Free bodies in cells that turn populations back: they hold, momentum closes, and a run goes on with the same bits."""

import copy

import numpy as np
import pytest

from porescale.benchmarks.stability_psm import fly
from porescale.coupling import immersed
from porescale.coupling.limits import FOR_NARROW_GAPS
from porescale.coupling.weighting.choose import fitting_weight
from porescale.validation.coupling.setups import Method, handful, momentum_error
from porescale.validation.coupling.towed import towed
from porescale.validation.lbm.channels import run

TURNED = Method(FOR_NARROW_GAPS)
LAW = f"{FOR_NARROW_GAPS} {fitting_weight(FOR_NARROW_GAPS, None)}"
EPS = float(np.finfo(float).eps)


def largest_root(p: float, ratio: float) -> float:
    """Growth of the change of sign in full cells a step: x² + (1 + 2p/s) x + 2 (1 - p)/s = 0."""
    return float(np.abs(np.roots([1.0, 1.0 + 2.0 * p / ratio, 2.0 * (1.0 - p) / ratio])).max())


@pytest.mark.parametrize("ratio", [1.25, 2.5, 100.0])
def test_the_part_of_two_steps_damps_what_the_load_of_one_drives(ratio):
    assert largest_root(immersed.NOW, ratio) < 1.0
    assert largest_root(1.0, ratio) == pytest.approx(1.0 + 2.0 / ratio)  # the check that must fail: without it


@pytest.mark.parametrize("ratio", [2.5, 0.8])
def test_a_free_disc_holds_and_runs_away_with_the_load_of_one_step(ratio, monkeypatch):
    assert fly(LAW, 0.3, ratio).stable
    monkeypatch.setattr(immersed, "NOW", 1.0)
    assert not fly(LAW, 0.3, ratio).stable


def test_the_load_of_a_held_disc_is_free_of_the_change_of_sign():
    # Set into motion at once, all full cells change sign, by a hundred times the drag.  What of it decays in a step, a
    # thousandth, is left in the mean of two: a tenth of the drag.
    coupled = towed((40, 40), [(20.3, 20.1)], 5.0, (0.01, 0.0), method=TURNED)
    run(coupled.advance, 300)
    drags = []
    for _ in range(4):
        coupled.advance()
        drags.append(coupled.fluid_force[0, 0])
    assert np.ptp(drags) < 0.1 * abs(np.mean(drags))
    raw = coupled.saturated.force[0, 0]
    coupled.advance()
    assert abs(coupled.saturated.force[0, 0] - raw) > 10 * abs(np.mean(drags))  # the check that must fail: of one step


def test_momentum_closes_with_what_is_under_way():
    # As coupling.momentum: 200 fluid and 800 contact steps round every velocity, all one way.
    assert momentum_error(handful(method=TURNED, acceleration=(0.0, -1e-5)), 200) < 1000 * EPS
    coupled = handful(method=TURNED)

    def without() -> np.ndarray:
        return coupled.momentum() - coupled.immersed.under_way[:, :2].sum(axis=0)

    assert momentum_error(coupled, 200, without) > 1e-4  # the check that must fail


def test_a_run_goes_on_with_the_same_bits():
    one, other = handful(method=TURNED), handful(method=TURNED)
    for _ in range(37):
        one.advance()
    state = copy.deepcopy(one.state())
    other.restore(state)
    lost = handful(method=TURNED)
    lost.restore(state)
    lost.immersed.under_way[:] = 0.0
    for coupled in (one, other, lost):
        for _ in range(20):
            coupled.advance()
    assert other.grains.discs.velocity.tobytes() == one.grains.discs.velocity.tobytes()
    assert lost.grains.discs.velocity.tobytes() != one.grains.discs.velocity.tobytes()  # the check that must fail
