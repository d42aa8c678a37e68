"""The step of the DEMseg tutorial, I-6: its stability limit is ours, and why a disc can bounce at half of it.

Leap-frog with the dashpot of the last half step, in contact: u2 = (2 - c dt/m - k dt^2/m) u1 + (c dt/m - 1) u0.  With
h = c/(2 sqrt(k m)) and s = dt sqrt(k/m) both roots of its characteristic equation lie in the unit circle while
s^2 + 4 h s - 4 < 0, so dt_cr = 2 sqrt(m/k) (sqrt(1 + h^2) - h).

A bounce without dashpot: with x the overlap of the last step before contact (< 0) and of all those in it, the recursion
keeps I = (x1 - x0)^2 + a x0 x1, a = s^2.  It begins with x0 <= 0 < x1 and ends with y1 > 0 >= y2, where the speeds are
v dt = x1 - x0 and v' dt = y1 - y2, so v'^2 - v^2 = a (x0 x1 - y1 y2)/dt^2: up to a/4 of v^2 goes, or of v'^2
comes, as the moment of touch falls.  Contacts whose phase advances by theta = 2 asin(s/2) = pi/N a step have y1 = -x0
and y2 = -x1: nothing comes or goes, at any moment.  dt_cr/2 is such a step, N = 3.  At theta = (1 + e) pi/N the y are
off by pi e A at the most, A = v dt/sin(theta) or less, so the share by a pi e (|y1| + |y2|) A/(v dt)^2 =
a pi e/sin(theta), to first order in e.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from porescale.demseg.deck import read_deck
from porescale.demseg.trace import trace
from porescale.validation.dem.setups import MASS, RADIUS, STIFFNESS, law_at, on_floor
from tests.reference.folders import CASES, script

UNIT = math.sqrt(math.pi * 4.0 * 2.5 / 1e8)
"""sqrt(m/k) of the tutorial's disc, s; twice that is dt_cr, 1.121e-3 (it prints 1.123e-3)."""
PRINTED = 0.5 * 1.123e-3
RATIOS = (0.0, 0.1, 0.25, 0.5, 0.75, 1.0, 2.0)


def largest_root(h, s, central=False):
    """Modulus of the larger root of the characteristic equation at damping ratio h, s = dt sqrt(k/m)."""
    if central:
        return float(np.abs(np.roots([1.0 + h * s, s * s - 2.0, 1.0 - h * s])).max())
    return float(np.abs(np.roots([1.0, -(2.0 - 2.0 * h * s - s * s), 1.0 - 2.0 * h * s])).max())


@pytest.mark.parametrize("h", RATIOS)
def test_both_roots_lie_in_the_unit_circle_up_to_the_limit(h):
    limit = 2.0 * (math.hypot(1.0, h) - h)
    assert largest_root(h, 0.999 * limit) <= 1.0 + 1e-12
    assert largest_root(h, 1.001 * limit) > 1.0 + 1e-4
    if h == 0.5:
        assert limit == pytest.approx(1.236068, abs=5e-7)  # as printed
    if h > 0.0:  # the twin: with central damping, footnote 2, the limit would be 2 at any h
        assert largest_root(h, 1.001 * limit, central=True) < 1.0
        assert largest_root(h, 2.001, central=True) > 1.0


@pytest.mark.parametrize(("h", "wrong"), [(0.0, 0.0), (0.3, 0.0), (1.0, 0.0), (0.3, 0.01)])
def test_a_step_here_is_that_of_the_tutorial(h, wrong):
    dt = 0.7 * math.sqrt(MASS / STIFFNESS)
    grains = on_floor(law_at(h, "overlap"), -1e-2 * RADIUS)
    grains.discs.velocity[0, 1] = -1e-3 * RADIUS / dt
    u = []
    for _ in range(4):
        u.append(RADIUS - float(grains.discs.position[0, 1]))
        grains.step(dt, np.zeros((1, 2)))
    c = 2.0 * (h + wrong) * math.sqrt(STIFFNESS * MASS)
    b = c * dt / MASS
    for k in (1, 2):
        made = (2.0 - b - STIFFNESS * dt**2 / MASS) * u[k] + (b - 1.0) * u[k - 1]
        if min(u[k], u[k + 1]) > 0.0:
            # Overlaps of 1e-2 RADIUS are differences of lengths of RADIUS: a few eps of RADIUS.
            assert (abs(made - u[k + 1]) < 1e-14 * RADIUS) == (wrong == 0.0)


@pytest.mark.parametrize("steps", [2, 3, 4, 5, 10])
def test_a_contact_of_whole_steps_gives_back_what_it_took(steps):
    share = math.sin(0.5 * math.pi / steps)  # of dt_cr = 2 sqrt(m/k)
    found = script("step_stability").gains(share)
    # Speeds of 1 and overlaps of 1e-3 RADIUS out of RADIUS: eps RADIUS/1e-5 at the most.
    assert np.abs(found).max() < 1e-9


def test_the_printed_step_is_nearly_one_of_those():
    s = PRINTED / UNIT
    theta = 2.0 * math.asin(0.5 * s)
    off = abs(theta / (math.pi / 3.0) - 1.0)
    assert off < 2.1e-3
    found = script("step_stability").gains(0.5 * s)
    assert 1e-4 < np.abs(found).max() < s * s * math.pi * off / math.sin(theta) * (1.0 + 10.0 * off)
    # The twin: a tenth less, and the moment of touch decides over a fifth of the energy.
    other, quarter = script("step_stability").gains(0.45), 0.25 * 0.9**2
    assert 0.1 < other.max() <= quarter / (1.0 - quarter)
    assert -0.1 > other.min() >= -quarter


def highest(dt):
    """Most that potential and kinetic energy of the tutorial's disc rise, over what it falls, in 11 s of its deck."""
    folder = CASES / "demseg_disc"
    steps = round(11.2 / dt / 100) * 100
    made = trace(folder, replace(read_deck(folder), dt=dt, nstep=steps, nprn1=steps, nprn2=10))
    energy = made.energy["enrg"] + made.energy["enva"]
    return float((energy - energy[0]).max() / (np.pi * 4.0 * 2.5 * 980.0 * 3.0))


@pytest.mark.slow
def test_a_disc_bounces_for_long_at_half_of_the_limit_and_not_at_six_tenths():
    # With weight, contacts that end within 2 g/w^2 = 6e-4 of touching last a step more: one in 70 touches, each with a
    # share of a 2 g dt/v = 1.4 % more or less; a score of bounces has one or none of them.
    assert highest(PRINTED) < 0.05
    assert highest(UNIT) < 0.05
    assert highest(1.2 * UNIT) > 100.0  # the twin, and what the tutorial says of dt_cr/2
