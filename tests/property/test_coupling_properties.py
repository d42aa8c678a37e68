"""Coverage holds its area and its symmetries wherever the disc lies."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from porescale.coupling.psm import SaturatedCells
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid

EPS = np.finfo(float).eps
N = 24

place = st.floats(0.0, float(N))
radius = st.floats(0.05, N / 2 - 0.03)  # as the fluid sees it, half a box at most


def coverage(x, y, r, mirrored=False):
    fluid = Fluid(N, N, 0.7, sides=Sides("periodic", "periodic", "periodic", "periodic"))
    wet = SaturatedCells(fluid, np.array([r]))
    wet.cover(np.array([[x, y]]), np.zeros((1, 2)), np.zeros(1))
    return wet.solid[:, ::-1] if mirrored else wet.solid


def tolerance(r):
    """Areas of r² from differences of four terms, and fractions below 1e-12 that count as none."""
    return 16 * EPS * max(r, 1) ** 2 + 1e-12


@settings(max_examples=150)
@given(place, place, radius)
def test_coverage_adds_up_to_the_disc_and_fills_no_cell_twice(x, y, r):
    e = coverage(x, y, r)
    seen = float(SaturatedCells(Fluid(N, N, 0.7), np.array([r])).covering_radius[0])
    assert abs(e.sum() - math.pi * seen**2) <= 4 * (r + 1) ** 2 * tolerance(r)
    assert e.min() >= 0.0
    assert e.max() <= 1.0 or 2 * seen > N - 2  # a disc that all but fills the box meets itself


@given(place, place, radius, st.integers(-N, N), st.integers(-N, N))
def test_coverage_moves_with_the_disc(x, y, r, across, along):
    # Where a centre is moved by whole cells it is rounded: at most 2 N eps = 1e-14, of a rim that passes fast through
    # a cell as sqrt(2 r d) at most.
    there = coverage(x + across, y + along, r)
    here = np.roll(coverage(x, y, r), (along, across), axis=(0, 1))
    assert np.abs(there - here).max() <= tolerance(r) + math.sqrt(2 * r * 2 * N * EPS) * 2 * N * EPS + 4 * N * EPS


@given(place, place, radius)
def test_coverage_mirrors(x, y, r):
    np.testing.assert_allclose(
        coverage(N - x, y, r, mirrored=True), coverage(x, y, r), rtol=0, atol=tolerance(r) + 4 * N * EPS
    )
