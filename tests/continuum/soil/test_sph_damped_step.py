"""A step follows the damping of zig-zags of velocity, whatever their strength."""

import numpy as np
import pytest

from continuum_sph.soil import flow, parameters
from continuum_sph.soil.stress import Straining
from continuum_sph.validation.soil.slopes import NEAR, layer
from porescale.common.core.errors import Unstable


def taken(ratio):
    """Largest rate over α c/h of damping, over waves on a square lattice, h = ``ratio`` spacings, Wendland C2."""
    h, reach = ratio, int(np.ceil(2 * ratio))
    a, b = np.meshgrid(np.arange(-reach, reach + 1.0), np.arange(-reach, reach + 1.0))
    to = np.column_stack((a.ravel(), b.ravel()))
    r = np.hypot(*to.T)
    to, r = to[(r > 0) & (r < 2 * h)], r[(r > 0) & (r < 2 * h)]
    slope = -35.0 / (4.0 * np.pi * h**4) * (1.0 - 0.5 * r / h) ** 3  # (1/r) dW/dr
    k = np.linalg.inv(np.einsum("n,na,nb->ab", -slope, to, to))
    largest = 0.0
    for wave in np.stack(np.meshgrid(*2 * [np.linspace(0.0, np.pi, 21)]), axis=-1).reshape(-1, 2):
        phase = np.exp(1j * (to @ wave))
        gradient = -np.einsum("n,na->a", (phase - 1.0) * slope, to) @ k
        left = (1.0 - phase) + 0.5 * (1.0 + phase) * (to @ gradient)  # w of a pair over v, x_ij = -to
        matrix = np.einsum("n,na,nb->ab", h * left * slope / (r * r + 0.01 * h * h), to, to)
        largest = max(largest, -np.linalg.eigvals(matrix).real.min())
    return largest * h


@pytest.mark.parametrize("ratio", [1.0, 1.3, 1.6, 2.0])
def test_a_step_takes_less_than_twice_any_wave(ratio):
    # A tenth is left for particles that crowd.
    assert taken(ratio) * parameters.DAMPED < 0.9 * 2.0


def swiftest(alpha):
    """Largest speed, m/s, ever reached in 0.1 s of an endless layer, damped by ``alpha``, below its limit."""
    flow, most = layer(NEAR, 20, damping=alpha), 0.0
    while flow.time < 0.1:
        flow.advance()
        most = max(most, flow.max_speed)
    return most


FREE = 9.8 * np.sin(np.radians(NEAR)) * 0.1
"""Speed (m/s) that nothing of the layer exceeds, but by half for its swing: that of free fall along the slope."""


def test_strong_damping_lets_nothing_swing():
    assert swiftest(4.5) < 1.5 * FREE


def test_damping_beyond_what_a_step_follows_is_weaker(monkeypatch):
    # a step of sound alone, α c Δt/h = 1.1: as where particles crowd in one that damping allows
    monkeypatch.setattr(parameters, "DAMPED", np.inf)
    assert swiftest(4.5) < 1.5 * FREE


def test_a_step_of_sound_alone_lets_it_swing_ever_wider(monkeypatch):  # the twin of both that must fail
    monkeypatch.setattr(parameters, "DAMPED", np.inf)
    monkeypatch.setattr(flow, "Straining", lambda *given: Straining(*given)._replace(damping=0.0))
    assert swiftest(4.5) > 1.5 * FREE


def test_damping_shortens_the_step_only_beyond_what_sound_allows():
    weak, strong = (layer(NEAR, 20, damping=alpha) for alpha in (3.0, 6.4))
    assert weak.law.share == 0.25
    assert strong.law.share == pytest.approx(0.125)
    assert strong.next_step == pytest.approx(0.5 * weak.next_step, rel=1e-12)


def test_a_layer_whose_step_falls_to_nothing_is_unstable():
    # Acceleration allows 0.25 √(h/|a|), sound 0.25 h/c: with |a| = c²/h as much, with 1e8 times that a ten thousandth.
    moving = layer(NEAR, 20, damping=3.0)
    material, h = moving.law.materials[0], moving.law.smoothing.length
    alike = material.column_modulus / material.density / h
    moving.soil.acceleration[7] = 0.9e8 * alike, 0.0
    moving.end(0.0)
    moving.soil.acceleration[7] = 1.1e8 * alike, 0.0
    with pytest.raises(Unstable, match=r"particle 7 .* limited by acceleration"):
        moving.end(0.0)
