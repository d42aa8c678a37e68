"""Slow flow past periodic discs: against the Fourier series, published arrays, reciprocity and its own convergence."""

import math

import numpy as np
import pytest

from tests.reference.coupling.stokes_array import Array, hexagonal, periodic_point_forces, square

PAIR = Array(np.array([[0.4, 0.45], [1.1, 0.6]]), np.array([0.25, 0.15]), length=1.5, height=1.0)


def drag(array):
    """F/(mu U) on the first disc."""
    return array.loads([1.0, 0.0])[0][0, 0]


@pytest.mark.parametrize(("length", "height", "shift"), [(1.0, 1.0, 0.0), (1.5, 0.8, 0.0), (1.0, math.sqrt(0.75), 0.5)])
def test_point_forces_have_the_fourier_series_of_the_stokes_equations(length, height, shift):
    # 4 pi/(area k^2) (1 - k k/k^2), nothing at k = 0.  Midpoints of an n x n grid: ln r is wrong by O(1) in
    # the one cell around it, a share of 1/n^2.
    n = 120
    a, b = np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(n) + 0.5) / n)
    x, y = a * length + b * shift, b * height
    flow = periodic_point_forces(x, y, length, height, shift)
    for i, j in [(0, 0), (1, 0), (0, 1), (2, -1), (-1, 3)]:
        kx, ky = 2 * np.pi * i / length, 2 * np.pi * (j - i * shift / length) / height
        k2 = kx * kx + ky * ky
        for found, share in zip(flow, (ky * ky, -kx * ky, kx * kx), strict=True):
            exact = 4 * np.pi / (length * height) * share / k2**2 if k2 else 0.0
            assert np.mean(found * np.exp(-1j * (kx * x + ky * y))) == pytest.approx(exact, abs=2 * np.pi / n**2)


def test_point_forces_repeat_with_the_cell():
    x, y = np.array([0.31, -0.2]), np.array([0.12, 0.38])
    here = periodic_point_forces(x, y, 1.2, 0.9, 0.3)
    # round-off of a sum of some twenty rows
    for away in ((1.2, 0.0), (0.3, 0.9), (-0.9, -2.7)):
        for one, other in zip(here, periodic_point_forces(x + away[0], y + away[1], 1.2, 0.9, 0.3), strict=True):
            assert other == pytest.approx(one, abs=1e-14 * 20)


@pytest.mark.parametrize(
    ("fraction", "published", "digit"),
    # Sangani & Acrivos 1982, table 1 (0.01: same series); one unit of the last digit printed:
    # 1763.57 is found where they print 1.763e3.
    [
        (0.01, 7.982, 1e-3),
        (0.05, 15.56, 1e-2),
        (0.1, 24.83, 1e-2),
        (0.2, 51.53, 1e-2),
        (0.4, 217.89, 1e-2),
        (0.5, 532.55, 1e-2),
        (0.6, 1763.0, 1.0),
    ],
)
def test_drag_of_the_square_array_is_the_published_one(fraction, published, digit):
    assert abs(drag(square(fraction)) - published) < digit
    # twin: radii 1 % larger
    assert abs(drag(square(fraction * 1.01**2)) - published) > 3 * digit


def test_the_dilute_limit_has_the_constants_of_the_lattices():
    # 8 pi mu U/F = -ln c - C + 2 c + d c^2 ...: C = 1.476336 (square), 1.497505 (hexagonal), d = -1.774 and -1/2
    # (Hasimoto 1959; Drummond & Tahir 1984); half a unit of the last digit, and the next terms 4 c^3.
    for kind, constant, second in ((square, 1.476336, -1.774), (hexagonal, 1.497505, -0.5)):
        for c in (1e-4, 1e-3, 1e-2):
            rest = 8 * np.pi / drag(kind(c)) + np.log(c) + constant - 2 * c - second * c * c
            assert abs(rest) < 5e-7 + 5e-4 * c * c + 4.1 * c**3
    other = 8 * np.pi / drag(hexagonal(1e-2)) + np.log(1e-2) - 0.02
    assert abs(other + 1.476336) > 0.02  # the lattices are told apart


@pytest.mark.parametrize(
    ("kind", "closest", "factor"),
    [
        (square, np.pi / 4, 16 / (9 * np.pi * np.sqrt(2))),
        (hexagonal, np.pi / np.sqrt(12), 16 / (9 * np.pi * np.sqrt(6))),
    ],
)
def test_dense_arrays_resist_as_the_gaps_do(kind, closest, factor):
    # Gebart 1992: K/R^2 = factor (sqrt(closest/c) - 1)^(5/2), lubrication in the narrow gaps: right to a share gap/R.
    for gap in (0.2, 0.1, 0.06):
        array = kind(closest / (1 + gap / 2) ** 2, forces=200, inner=0.88)
        found = array.permeability()[0, 0] / array.radii[0] ** 2
        assert found == pytest.approx(factor * (gap / 2) ** 2.5, rel=gap)
    # twin: the same law with the square of the gap
    assert found != pytest.approx(factor * (gap / 2) ** 2, rel=gap)


def test_a_hexagonal_lattice_is_the_same_in_two_cells_and_in_two_directions():
    single = hexagonal(0.5, forces=120)
    radius, height = single.radii[0], math.sqrt(3)
    double = Array(np.array([[0.3, 0.2], [0.8, 0.2 + height / 2]]), np.array([radius] * 2), height=height, forces=120)
    along, across = single.loads([1.0, 0.0])[0], single.loads([0.0, 1.0])[0]
    # Slip of 1e-11 U on every disc is a force of 400 times that: 1e-11 of the drag; a thousand for the condition.
    assert along[0] == pytest.approx([across[0, 1], 0], abs=1e-8 * across[0, 1])
    assert double.loads([1.0, 0.0])[0] == pytest.approx(np.array([along[0], along[0]]), abs=1e-8 * along[0, 0])


def test_error_falls_geometrically_with_the_forces():
    exact = drag(square(0.4, forces=120))
    error = [abs(drag(square(0.4, forces=n)) / exact - 1) for n in (16, 24, 32)]
    # Each force adds a mode that the ring damps by its share 0.7 in half of them: at least 0.7^(8/2) for 8 more.
    assert error[1] < 0.7**4 * error[0]
    assert error[2] < 0.7**4 * error[1]


def test_slip_tells_forces_that_are_too_few():
    assert square(0.6, forces=30).loads([1.0, 0.0])[2] > 1e-2
    assert square(0.6, forces=120).loads([1.0, 0.0])[2] < 1e-6


def resistance(array):
    """Forces and torques of all discs for unit velocities and spins of each: (3 n, 3 n)."""
    n = len(array.radii)
    columns = []
    for k in range(3 * n):
        unit = np.eye(3 * n)[k]
        force, torque, _ = array.loads([0.0, 0.0], unit[: 2 * n].reshape(n, 2), unit[2 * n :])
        columns.append(np.concatenate([force.ravel(), torque]))
    return np.array(columns).T


def test_two_unequal_discs_resist_reciprocally():
    matrix = resistance(PAIR)
    # Lorentz 1896; to round-off of least squares of some hundred unknowns, condition 1e5 after truncation
    assert np.abs(matrix - matrix.T).max() < 1e-9 * np.abs(matrix).max()
    assert np.linalg.eigvalsh(-(matrix + matrix.T) / 2).min() > 0
    # Together with the flow nothing is felt; alone against it, what the flow does.
    together = PAIR.loads([0.3, -0.2], [[0.3, -0.2]] * 2)
    assert np.abs(together[0]).max() == 0.0
    fixed = PAIR.loads([1.0, 0.0])[0]
    towed = matrix[:4] @ np.array([-1.0, 0, -1.0, 0, 0, 0])
    assert towed == pytest.approx(fixed.ravel(), rel=1e-8, abs=1e-8)
    # twin: what a disc alone does to the other is not what it feels itself
    assert abs(matrix[0, 0] - matrix[2, 2]) > 0.1 * abs(matrix[0, 0])


def test_permeability_of_a_pair_is_symmetric_and_lies_between_those_of_its_directions():
    k = PAIR.permeability()
    assert abs(k[0, 1] - k[1, 0]) < 1e-9 * k[0, 0]
    assert np.linalg.eigvalsh(k).min() > 0
    assert abs(k[0, 1]) > 1e-3 * k[0, 0]  # the pair lies askew


def test_a_lattice_of_spinning_discs_is_held_back_by_its_own_counterflow():
    # All spin alike without net circulation: the fluid turns back at c/(1 - c) of the spin, so
    # T = 4 pi mu R^2 w/(1 - c); the next harmonic that the lattice has, four- or six-fold, comes back at c^4, c^6.
    for kind, power in ((square, 4), (hexagonal, 6)):
        rest = []
        for c in (0.1, 0.2):
            array = kind(c)
            torque = -array.loads([0.0, 0.0], spin=[1.0])[1][0]
            rest.append(torque / (4 * np.pi * array.radii[0] ** 2) - 1 / (1 - c))
        assert 0 < rest[0] < 10 * 0.1**power
        assert np.log2(rest[1] / rest[0]) == pytest.approx(power, abs=0.2 * power)  # the next order: c times as much
