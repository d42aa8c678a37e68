"""Velocity sides that fluid passes fast: what convection adds to half-way bounce-back is given back, and no mass.

Flows with exact solutions, at the cell Reynolds number 3 (relaxation time 0.53): the side's delay is 6 steps.
"""

import numpy as np
import pytest

from porescale.lbm.boundary import velocity
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from porescale.validation.lbm.open_sides import inlet

PEAK, CELL_REYNOLDS = 0.03, 3


def through_four_sides(flow, n):
    """Root mean square error over that of ``flow(x, y)``, linear in place over a unit square of n by n cells whose
    sides give it, of the momentum: what a side sets is that."""
    x = (np.arange(n) + 0.5) / n
    ends = {"left": (0 * x, x), "right": (1 + 0 * x, x), "bottom": (x, 0 * x), "top": (x, 1 + 0 * x)}
    given = {f"{side}_velocity": PEAK * np.stack(flow(*at), 1) for side, at in ends.items()}
    fluid = Fluid(n, n, 0.5 + 3 * PEAK / CELL_REYNOLDS, sides=Sides(*["velocity"] * 4, **given))
    exact = PEAK * np.array(flow(*np.meshgrid(x, x)))
    fluid.set_flow(*exact)
    for _ in range(round(n**2 * CELL_REYNOLDS / PEAK / 10)):
        fluid.advance()
    density, ux, uy = fluid.fields()
    return float(np.sqrt(np.mean((density * np.array((ux, uy)) - exact) ** 2) / np.mean(exact**2)))


def stagnation(x, y):
    return 2 * x - 1, 1 - 2 * y


def rotation(x, y):
    return 1 - 2 * y, 2 * x - 1


def test_a_stagnation_flow_is_of_second_order(monkeypatch):
    # Linear, so that bounce-back is exact but for convection; corner links and the square of the Mach number are left.
    errors = [through_four_sides(stagnation, n) for n in (10, 20)]
    assert errors[0] < 0.004
    assert np.log2(errors[0] / errors[1]) > 1.8
    monkeypatch.setattr(velocity, "_turned", lambda *link: [])
    without = [through_four_sides(stagnation, n) for n in (10, 20)]
    assert without[1] > 8 * errors[1]
    assert np.log2(without[0] / without[1]) < 1


def test_a_rotation_is_the_flow_for_which_a_side_would_have_to_know_more(monkeypatch):
    # It has no strain rate, so that N = 0; the side knows du/dy alone and takes dv/dx for 0.  The limit of the method.
    assert 0.004 < through_four_sides(rotation, 20) < 0.008
    monkeypatch.setattr(velocity, "_turned", lambda *link: [])
    assert through_four_sides(rotation, 20) < 1e-4


def test_the_error_of_a_parabola_does_not_depend_on_the_cell_reynolds_number(monkeypatch):
    # 0.0081 at 8 cells.  The density's drop over the channel, 2 n of 24 nu peak/n², is 0.002: 0.001 of the velocity.
    slow, fast = inlet(8), inlet(8, 0.01, PEAK, memories=3)
    assert fast == pytest.approx(slow, rel=0.15)
    monkeypatch.setattr(velocity, "_turned", lambda *link: [])
    assert inlet(8, 0.01, PEAK, memories=3) > 1.5 * slow


def test_central_moments_are_late_by_the_shear_alone(monkeypatch):
    # They relax in the fluid's frame: tau - 1/2 = 0.009 steps, not 1/s - 1/2 = 1/2.
    def error(peak):
        return inlet(8, 0.003, peak, memories=1, operator="central")

    assert error(0.1) == pytest.approx(error(0.03), rel=0.05)
    monkeypatch.setattr("porescale.lbm.fluid.convective_delay", lambda law: 0.5)
    assert error(0.1) > 1.3 * error(0.03)


@pytest.mark.parametrize("across", ["wall", "periodic", "velocity"])
@pytest.mark.parametrize("lying", [False, True])
def test_what_is_given_back_has_no_mass(lying, across):
    names = ("bottom", "top", "left", "right") if lying else ("left", "right", "bottom", "top")
    kinds = dict(zip(names, ("velocity", "velocity", across, across), strict=True))
    fluid = Fluid(9, 9, 0.52, sides=Sides(**kinds))
    rng = np.random.default_rng(2)
    for side, kind in kinds.items():
        if kind == "velocity":
            fluid.set_side_velocity(side, 0.05 * rng.uniform(-1, 1, (9, 2)))
    ours = fluid.links
    whole = ours.added.copy()
    size, ours.velocity._turned = ours.velocity._turned, np.zeros_like(ours.velocity._turned)
    ours.velocity.write(ours.added)
    turn = whole - ours.added
    assert abs(turn.sum()) < 1e-15  # round-off of a hundred numbers of 0.003
    assert np.abs(turn).max() > 1e-4
    size[-1] *= 0.99
    ours.velocity._turned = size
    ours.velocity.write(ours.added)
    assert abs((ours.added - whole).sum()) > 1e-9  # one part is 1 % smaller
