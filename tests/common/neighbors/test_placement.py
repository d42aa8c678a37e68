"""Placed discs never overlap, stay in the box, and are the same for the same seed."""

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.common.neighbors import place, square_lattice, triangular_lattice
from porescale.common.neighbors.placement import Standing, glide, repel
from tests.reference.dem.pairs import nearest_image


def smallest_gap(position, radius, size, periodic):
    """Smallest distance between surfaces of discs, and of discs and walls, m."""
    gaps = [np.inf]
    period = [size[a] if periodic[a] else 0.0 for a in (0, 1)]
    for i in range(len(position) - 1):
        d = [nearest_image(position[i, a] - position[i + 1 :, a], period[a]) for a in (0, 1)]
        gaps.append((np.hypot(*d) - radius[i] - radius[i + 1 :]).min())
    for a in (0, 1):
        if not periodic[a]:
            gaps.append((position[:, a] - radius).min())
            gaps.append((size[a] - position[:, a] - radius).min())
    return min(gaps)


# Clear by construction; what is left is the rounding of positions scaled to metres and back.
ROUNDING = 1e-12


@pytest.mark.parametrize("periodic", [(False, False), (True, True), (True, False)])
@pytest.mark.parametrize("fraction", [0.1, 0.6, 0.80])
def test_a_thousand_discs_at_any_fraction_are_clear_of_each_other(fraction, periodic):
    size = (0.09, 0.06)
    placed = place((0.0, 0.0), size, count=1000, packing_fraction=fraction, spread=0.2, periodic=periodic, seed=3)
    assert placed.position.shape == (1000, 2)
    assert smallest_gap(placed.position, placed.radius, size, periodic) > -ROUNDING
    assert placed.fraction == pytest.approx(fraction, rel=1e-9)  # 1e-12 taken off the diameter, and sums of 1000
    assert np.all(placed.position >= 0.0)
    assert np.all(placed.position <= size)


def test_random_start_does_overlap():  # the twin that must fail
    rng = np.random.default_rng(0)
    radius = np.full(1000, np.sqrt(0.6 / (1000 * np.pi)))
    assert smallest_gap(rng.uniform(0, 1, (1000, 2)), radius, (1.0, 1.0), (True, True)) < -radius[0]


def test_count_follows_from_the_fraction():
    placed = place((0.0, 0.0), (1.0, 1.0), diameter=0.05, spread=0.1, packing_fraction=0.5)
    assert abs(placed.fraction - 0.5) <= 0.5 * np.pi * placed.radius.max() ** 2  # the nearest whole number of discs
    assert placed.radius.min() >= 0.0225
    assert placed.radius.max() <= 0.0275


def test_fraction_follows_from_the_count_and_diameter():
    placed = place((1.0, 2.0), (2.0, 3.0), diameter=0.05, count=100)
    assert placed.fraction == pytest.approx(100 * np.pi * 0.025**2)
    assert np.all(placed.position[:, 1] >= 2.0)


def test_given_radii_are_kept():
    radii = np.linspace(0.01, 0.1, 20)
    placed = place((0.0, 0.0), (1.0, 1.0), radii=radii, seed=1)
    assert np.array_equal(placed.radius, radii)
    assert smallest_gap(placed.position, radii, (1.0, 1.0), (False, False)) > -ROUNDING


def test_same_seed_same_discs_other_seed_others():
    one, two, other = (
        place((0.0, 0.0), (1.0, 1.0), count=60, packing_fraction=0.7, spread=0.3, seed=s) for s in (5, 5, 6)
    )
    assert np.array_equal(one.position, two.position)
    assert np.array_equal(one.radius, two.radius)
    assert not np.array_equal(one.position, other.position)


def test_positions_do_not_depend_on_the_unit_of_length():
    small, large = (place((0.0, 0.0), (s, s), count=50, packing_fraction=0.6, seed=2) for s in (1.0, 1024.0))
    # A power of two scales exactly; only the mean's rounding can differ.
    np.testing.assert_allclose(large.position, 1024.0 * small.position, rtol=1e-9)


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"diameter": 0.1, "packing_fraction": 0.81}, "packing_fraction"),
        ({"count": 10, "packing_fraction": 0.9}, "packing_fraction"),
        ({"diameter": 0.5, "count": 5}, "packing_fraction"),
        ({"diameter": 1.5, "count": 1, "upper": (1.0, 9.0)}, "diameter"),
        ({"diameter": 0.1}, "exactly two"),
        ({"diameter": 0.1, "count": 3, "packing_fraction": 0.1}, "exactly two"),
        ({"diameter": -0.1, "count": 3}, "diameter"),
        ({"diameter": 0.1, "count": 3, "spread": 1.0}, "spread"),
        ({"radii": np.array([0.1, 0.0])}, "radii"),
        ({"radii": np.array([0.6]), "upper": (1.0, 9.0)}, "larger than the box"),
    ],
)
def test_impossible_wishes_are_refused_by_name(options, named):
    with pytest.raises(InputError, match=named):
        place((0.0, 0.0), **{"upper": (1.0, 1.0), **options})


def test_discs_that_cannot_fit_say_how_far_they_got():
    # Three discs of 0.45 in a strip one disc high need 1.35 of length, the area alone would do: 0.64.
    with pytest.raises(InputError, match=r"overlap by .* mean diameters .*; lower the fraction"):
        place((0.0, 0.0), (1.3, 0.5), radii=np.full(3, 0.225))


def test_no_discs_at_all():
    assert place((0.0, 0.0), (1.0, 1.0), radii=np.empty(0)).position.shape == (0, 2)


def test_square_lattice_fills_the_box():
    x = square_lattice((1.0, 2.0), (2.0, 4.0), 0.1)
    assert x.shape == (200, 2)
    np.testing.assert_allclose(x.mean(axis=0), [1.5, 3.0])
    np.testing.assert_allclose(x.min(axis=0), [1.05, 2.05])


def test_triangular_lattice_touches_without_overlap():
    x = triangular_lattice((0.0, 0.0), (1.0, 1.0), 0.1)
    assert smallest_gap(x, np.full(len(x), 0.05), (1.0, 1.0), (False, False)) == pytest.approx(0.0, abs=1e-12)
    # rows 0.0866 apart: floor((1 - 0.1)/0.0866) + 1 = 11, of 10 and 9 discs in turn
    assert len(x) == 6 * 10 + 5 * 9
    assert triangular_lattice((0.0, 0.0), (1.0, 0.05), 0.1).shape == (0, 2)


def test_springs_obey_newtons_third_law_in_plain_python_too():
    x = np.array([[0.5, 0.5], [1.0, 0.6], [1.0, 0.6]])
    grown = np.full(3, 0.4)
    start, partner = np.array([0, 2, 3, 3]), np.array([1, 2, 2], np.int32)
    forces = []
    for run in (repel, repel.py_func):
        force = np.empty((3, 2))
        worst, power = run(x, grown, grown, start, partner, 9.0, 9.0, 9.0, 9.0, np.ones((3, 2)), force, 3)
        forces.append(force)
        assert worst == pytest.approx(0.8)
        assert abs(force.sum()) < 1e-15  # three additions of numbers below 1
        assert power == pytest.approx(0.0, abs=1e-15)
    np.testing.assert_allclose(*forces, rtol=1e-14)
    velocity = np.zeros((3, 2))
    glide.py_func(x, velocity, forces[0], 0.1, 0.1)
    # from rest the turn leaves the velocity along the force
    np.testing.assert_allclose(velocity, 0.1 * forces[0], rtol=1e-12)


def test_discs_that_stand_are_not_moved_and_what_they_overlap_of_each_other_does_not_count():
    x = np.array([[0.5, 0.5], [1.0, 0.6], [1.0, 0.6]])
    grown = np.full(3, 0.4)
    start, partner = np.array([0, 2, 3, 3]), np.array([1, 2, 2], np.int32)
    for run in (repel, repel.py_func):
        force = np.empty((3, 2))
        worst, _ = run(x, grown, grown, start, partner, 9.0, 9.0, 9.0, 9.0, np.ones((3, 2)), force, 1)
        assert worst == pytest.approx(0.8 - np.hypot(0.5, 0.1))  # of the first with either, not 0.8
        assert not force[1:].any()
        np.testing.assert_allclose(force[0], 2 * worst * np.array([-0.5, -0.1]) / np.hypot(0.5, 0.1), rtol=1e-12)


def test_discs_are_placed_among_what_stands():
    size, radii = (0.03, 0.02), np.full(300, 4e-4)
    at, radius = np.array([[0.01, 0.008], [0.011, 0.008], [-0.001, 0.01]]), np.array([0.003, 0.003, 0.003])

    def beside(points):
        """A wall along x = 25 mm, solid to the right."""
        return [(0.025 - points[:, 0], np.tile([-1.0, 0.0], (len(points), 1)))]

    start = np.random.default_rng(3).uniform((0.004, 0.0121), (0.024, 0.0199), (300, 2))

    def deepest(standing):
        """How deep a disc lies in what stands."""
        x = place((0.0, 0.0), size, radii=radii, start=start, standing=standing).position
        apart = np.hypot(*np.moveaxis(x[:, None] - at, -1, 0)) - radii[:, None] - radius
        return max(float(-apart.min()), float((x[:, 0] + radii).max()) - 0.025)

    assert deepest(Standing(at, radius, 2e-4, beside)) <= 0.0
    assert deepest(None) > 1e-4  # the twin: they spread over it
    with pytest.raises(InputError, match="denser than random placement"):
        place((0.0, 0.0), size, radii=radii, start=start, standing=Standing(at, radius, 0.75 * 6e-4, beside))
