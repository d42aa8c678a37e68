"""Bishop's simplified method beside published factors, the endless slope and hydrostatics."""

import math

import numpy as np
import pytest

from continuum_sph.validation.unsaturated.slices import Circle, Slope, factor, least

# Fredlund & Krahn, Can. Geotech. J. 14 (1977) 429, figure 9: 2 : 1, 40 ft; lb, ft
GROUND = np.array([[0.0, 60.0], [60.0, 60.0], [140.0, 20.0], [250.0, 20.0]])
PUBLISHED = Circle(120.0, 90.0, 80.0)


def pressed(share):
    return lambda x, y: share * 120.0 * (np.interp(x, *GROUND.T) - y)


@pytest.mark.parametrize(("share", "published"), [(0.0, 2.080), (0.25, 1.766)])  # cases 1 and 3
def test_published_factors_of_fredlund_and_krahn(share, published):
    slope = Slope(GROUND, 120.0, 600.0, math.radians(20.0), pressed(share))
    # other programs differ from the published by 0.1 to 0.3 %, of slices by hand (MacSlope: 2.078, 1.761)
    assert factor(slope, PUBLISHED, 400) == pytest.approx(published, rel=0.005)


def test_slices_converge_to_the_second_order():
    slope = Slope(GROUND, 120.0, 600.0, math.radians(20.0))
    one, two, four = (factor(slope, PUBLISHED, slices) for slices in (40, 80, 640))
    assert abs(two - four) < 0.5 * abs(one - four) < 0.01


@pytest.mark.parametrize("beta", [15.0, 25.0])
@pytest.mark.parametrize(("cohesion", "share"), [(0.0, 0.0), (0.0, 0.3), (2000.0, 0.2)])
def test_a_long_shallow_circle_is_an_endless_slope(beta, cohesion, share):
    angle, phi, weight = math.radians(beta), math.radians(30.0), 2e4
    ground = np.array([[0.0, 1000.0 * math.tan(angle)], [1000.0, 0.0]])
    slope = Slope(ground, weight, cohesion, phi, lambda x, y: share * weight * (slope.top(x) - y))
    half, deep = 100.0, 1.0  # of the chord, along the slope; depth across it in the middle
    radius = (half**2 + deep**2) / (2.0 * deep)
    middle = np.array([500.0, slope.top(np.array([500.0]))[0]])
    centre = middle + (radius - deep) * np.array([math.sin(angle), math.cos(angle)])
    found = factor(slope, Circle(*centre, radius), 2000)
    # Σ over a parabola of depth: mean depth 2/3 of the deepest; its slope against the ground's is 2 deep/half at most
    friction = (1.0 - share / math.cos(angle) ** 2) * math.tan(phi) / math.tan(angle)
    cling = cohesion / (weight * 2.0 / 3.0 * deep / math.cos(angle) * math.sin(angle) * math.cos(angle))
    assert found == pytest.approx(friction + cling, rel=0.03)


def test_a_slope_under_still_water_has_the_factor_of_its_buoyant_weight():
    water, whole = 62.4, 120.0
    under = Slope(GROUND, whole, 200.0, math.radians(20.0), lambda x, y: water * (80.0 - y),
                  lambda x: np.full(len(x), 80.0), water)  # fmt: skip
    buoyant = Slope(GROUND, whole - water, 200.0, math.radians(20.0))
    # moments of pressure on straight pieces of ground, by the middles of 400 slices
    assert factor(under, PUBLISHED, 400) == pytest.approx(factor(buoyant, PUBLISHED, 400), rel=1e-3)


def test_slopes_to_the_left_are_those_to_the_right_seen_in_a_mirror():
    slope = Slope(GROUND, 120.0, 600.0, math.radians(20.0))
    mirrored = Slope(np.column_stack((-GROUND[::-1, 0], GROUND[::-1, 1])), 120.0, 600.0, math.radians(20.0))
    left = factor(mirrored, Circle(-120.0, 90.0, 80.0, right=False))
    assert left == pytest.approx(factor(slope, PUBLISHED), rel=1e-12)


def test_suction_holds_and_pressure_loosens():
    factors = [
        factor(Slope(GROUND, 120.0, 0.0, math.radians(20.0), lambda x, y, u=u: np.full(len(x), u)), PUBLISHED)
        for u in (-300.0, 0.0, 300.0)
    ]
    assert factors[0] > factors[1] > factors[2]
    # ψ tan φ of suction is a cohesion
    cling = Slope(GROUND, 120.0, 300.0 * math.tan(math.radians(20.0)), math.radians(20.0))
    assert factors[0] == pytest.approx(factor(cling, PUBLISHED), rel=1e-12)


def test_the_least_factor_is_one_of_a_circle_through_the_slope():
    slope = Slope(GROUND, 120.0, 300.0, math.radians(20.0))
    centres = [(x, y) for x in (100.0, 120.0, 140.0) for y in (80.0, 100.0, 130.0)]
    found, circle = least(slope, centres, (0.0, 10.0, 15.0), shallow=5.0)
    assert found <= factor(slope, Circle(120.0, 80.0, 70.0))
    assert found == factor(slope, circle)
    with pytest.raises(ValueError, match="no circle"):
        least(slope, [(500.0, 80.0)], (10.0,))


def test_a_circle_that_cuts_no_soil_has_no_factor_and_level_ground_no_need_of_one():
    slope = Slope(GROUND, 120.0, 600.0, math.radians(20.0))
    assert math.isnan(factor(slope, Circle(120.0, 200.0, 50.0)))
    level = Slope(np.array([[0.0, 10.0], [100.0, 10.0]]), 120.0, 600.0, math.radians(20.0))
    assert factor(level, Circle(50.0, 15.0, 10.0)) > 1e6  # round-off drives
