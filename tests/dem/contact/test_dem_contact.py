"""The linear law: its restitution, contact time and limits."""

import math

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.dem.contact.law import Relative, contact, coulomb
from porescale.dem.contact.linear import Linear
from porescale.dem.timestep import packing_limit, stable_step

# Table 1 of Saito et al.: mass per metre of a grain, of 1.5 mm and 2500 kg/m3, and its contact law.
GRAIN = math.pi * 0.75e-3**2 * 2500.0
PAPER = Linear(5e6, 2.0, 1.25e6, 1.0, 0.5)


def at(h, release):
    return Linear(1.0, 2.0 * h, release=release)


@pytest.mark.parametrize(
    ("h", "release", "e"),
    [
        (0.2155, "overlap", 0.500),
        (0.2155, "force", 0.550),
        (1.0, "overlap", 0.0),
        (1.0, "force", math.exp(-2)),
        (2.0, "force", (2 + math.sqrt(3)) ** (-4 / math.sqrt(3))),  # ((h+s)/(h-s))^(-h/s), (h+s)(h-s) = 1
    ],
)
def test_restitution_depends_on_how_a_contact_ends(h, release, e):
    assert at(h, release).restitution(1.0) == pytest.approx(e, abs=5e-4)  # three digits given


def test_restitution_and_contact_time_are_smooth_through_critical_damping():
    # phase = 2 + 2(1 - h)/3 near h = 1; the branches lose (1e-16/1e-7)^(1/2) relative to s = sqrt(2e-7).
    for h in (1 - 1e-7, 1.0, 1 + 1e-7):
        assert at(h, "force").contact_time(1.0) == pytest.approx(2 + 2 * (1 - h) / 3, rel=1e-9)


def test_the_force_vanishes_at_the_end_of_the_contact():
    for h in (0.1, 0.7, 1.0, 3.0):  # overlap of the free oscillator at T: k d + c d' = 0
        t = at(h, "force").contact_time(1.0)
        root = np.sqrt(complex(h * h - 1)) if h != 1 else 1e-6
        overlap = (np.exp(-h * t) * np.sinh(root * t) / root).real
        closing = (np.exp(-h * t) * np.cosh(root * t)).real - h * overlap
        assert overlap + 2 * h * closing == pytest.approx(0.0, abs=1e-11)  # (1e-6)^2 at h = 1


@pytest.mark.parametrize("release", ["force", "overlap"])
@pytest.mark.parametrize("e", [1.0, 0.97, 0.5, 0.1, 1e-3])
def test_damping_from_restitution_gives_that_restitution(release, e):
    law = Linear.from_restitution(e, 3e-3, 4e6, release=release)
    # exp of a root found to 1e-14 relative, -ln e = 7 at most
    assert law.restitution(3e-3) == pytest.approx(e, rel=1e-12)


def test_dead_contact_is_critical_damping_when_it_lasts_to_zero_overlap():
    law = Linear.from_restitution(0.0, 1.0, 1.0, release="overlap")
    assert law.damping_ratio(1.0) == 1.0
    assert law.restitution(1.0) == 0.0
    assert law.contact_time(1.0) == math.inf


def test_table_1_of_the_paper_implies_the_numbers_of_the_specification():
    assert pytest.approx(4.42e-3, rel=1e-3) == GRAIN
    assert PAPER.damping_ratio(GRAIN / 2) == pytest.approx(0.0095, abs=5e-5)
    assert PAPER.restitution(GRAIN / 2) == pytest.approx(0.97, abs=5e-3)
    assert PAPER.critical_step(GRAIN / 2) == pytest.approx(4.2e-5, rel=0.02)
    # In a packing: 2.11e-5 with its damping, on the safe side of the estimate 2.5e-5 and within a fifth of it.
    assert 0.8 * 2.5e-5 < packing_limit(PAPER, GRAIN) < 2.5e-5


def test_a_lone_pair_limit_is_no_limit_for_a_packing():  # the twin that must fail
    assert packing_limit(PAPER, GRAIN) < 0.55 * PAPER.critical_step(GRAIN / 2)


def test_safe_step_respects_stability_and_resolves_the_contact():
    assert stable_step(PAPER, GRAIN, safety=0.5, steps_per_contact=0.0) == 0.5 * packing_limit(PAPER, GRAIN)
    fine = stable_step(PAPER, GRAIN, steps_per_contact=50.0)
    assert fine == pytest.approx(PAPER.contact_time(GRAIN / 2) / 50.0)
    stiff = Linear(4 * PAPER.stiffness)
    assert stable_step([PAPER, stiff], GRAIN) == stable_step(stiff, GRAIN)


def at_contact(law, overlap, closing, slip=0.0, spring=0.0, dt=1e-3, compiled=True):
    """(normal, tangential, spring) of a contact of unit mass and radius."""
    function = contact if compiled else contact.py_func
    kind = law.kernel(law.row()[None, None], 1.0, None)
    seen = Relative(overlap, closing, slip, 0.0, 1.0)
    normal, tangential, _, spring, _ = function(seen, spring, 0.0, 1.0, dt, law.row(), kind)
    return normal, tangential, spring


@pytest.mark.parametrize("compiled", [True, False])
def test_only_release_at_zero_overlap_attracts(compiled):
    def force(closing, release="force"):
        return at_contact(Linear(1e3, 1.0, release=release), 1e-3, closing, compiled=compiled)[0]

    assert force(-10.0) == 0.0
    assert force(-10.0, "overlap") == -9.0
    assert force(10.0) == 11.0


@pytest.mark.parametrize("compiled", [True, False])
def test_friction_saturates_and_the_spring_with_it(compiled):
    friction = coulomb if compiled else coulomb.py_func
    assert friction(0.01, 2.0, 50.0, 0.01, 100.0, 0.01, 5.0) == (-(100.0 * 0.03 + 5.0 * 2.0), 0.03)  # sticks
    assert friction(0.01, 2.0, 4.0, 0.01, 100.0, 0.01, 5.0) == (-4.0, 0.03)  # slides by its dashpot: spring apart
    assert friction(0.01, -2.0, 0.5, 0.01, 100.0, 0.01, 5.0) == (0.5, -0.005)  # slides: spring back on the limit
    assert friction(0.01, 2.0, 50.0, 0.01, 0.0, 0.0, 5.0) == (-10.0, 0.0)  # springless


def test_attraction_carries_no_friction():
    law = Linear(1e3, 1.0, 100.0, 5.0, 0.5, release="overlap")
    assert at_contact(law, 1e-3, -10.0, 3.0, 0.01, compiled=False) == (-9.0, -0.0, 0.0)


@pytest.mark.parametrize(
    ("wrong", "key"),
    [
        ({"stiffness": 0.0}, "contact.stiffness"),
        ({"stiffness": 1.0, "friction": -0.1}, "contact.friction"),
        ({"stiffness": 1.0, "damping": math.nan}, "contact.damping"),
        ({"stiffness": 1.0, "release": "never"}, "contact.release"),
    ],
)
def test_a_law_that_makes_no_sense_is_refused_by_name(wrong, key):
    with pytest.raises(InputError, match=key):
        Linear(**wrong)


@pytest.mark.parametrize(("e", "release"), [(0.0, "force"), (1.1, "overlap"), (-0.1, "force")])
def test_a_restitution_out_of_range_is_refused(e, release):
    with pytest.raises(InputError, match="restitution"):
        Linear.from_restitution(e, 1.0, 1.0, release=release)
