"""Elastic moduli of a packing by the springs of its contacts."""

import numpy as np
import pytest

from porescale.dem.contact.linear import Linear
from porescale.dem.measures.network import LOOSE, elasticity, moduli
from porescale.validation.dem.bodies import VALIDATIONS, moduli_by_springs
from tests.reference.dem import springs as slow

SIDE = 4
APART = 2e-3
BOX = (SIDE * APART, SIDE * 0.75**0.5 * APART)


def thrown(seed=1):
    """Positions and radii (m) of discs about a triangular lattice in ``BOX``, pressed into their six neighbours."""
    rng = np.random.default_rng(seed)
    places = [((i + 0.5 * (j % 2)) * APART, j * BOX[1] / SIDE) for j in range(SIDE) for i in range(SIDE)]
    return np.array(places) + APART * rng.uniform(-0.02, 0.02, (SIDE**2, 2)), APART * rng.uniform(0.53, 0.56, SIDE**2)


def test_the_row_of_a_lattice_holds_and_a_lattice_of_another_stiffness_across_does_not():
    row = VALIDATIONS["dem.elastic_moduli_of_a_lattice"].run()
    assert row.passed, row
    assert abs(moduli_by_springs(0.501)[0] - moduli_by_springs(0.5)[0]) > 1e5 * row.tolerance


@pytest.mark.parametrize("rolling", [0.0, 0.1])
def test_moduli_are_those_of_the_smallest_energy(rolling):
    law = Linear(3e5, tangential_stiffness=1e5, friction=0.5)
    law = law.with_rolling(rolling, 2e5) if rolling else law
    position, radius = thrown()
    expected = slow.moduli(position, radius, BOX, law)
    # ties of LOOSE on discs that six springs hold, none softer than a third of k; a hundred times for their softest way
    assert moduli(position, radius, BOX, law) == pytest.approx(expected, rel=1e2 * LOOSE, abs=1e2 * LOOSE * 3e5)


def test_what_friction_and_rolling_do_not_hold_back_bears_nothing():
    position, radius = thrown()
    smooth = moduli(position, radius, BOX, Linear(3e5, tangential_stiffness=1e5))
    none = moduli(position, radius, BOX, Linear(3e5, friction=0.5))
    assert np.array_equal(smooth, none)
    rough = Linear(3e5, tangential_stiffness=1e5, friction=0.5)
    stiff = [elasticity(position, radius, BOX, it)[0] for it in (rough, rough.with_rolling(0.1, 2e5))]
    assert 1.01 * elasticity(position, radius, BOX, Linear(3e5))[0] < stiff[0] < stiff[1]


def test_a_packing_turned_by_a_quarter_has_its_axes_exchanged_and_the_same_elasticity():
    law = Linear(3e5, tangential_stiffness=1e5, friction=0.5)
    position, radius = thrown(2)
    turned = np.column_stack((BOX[1] - position[:, 1], position[:, 0]))
    one, other = moduli(position, radius, BOX, law), moduli(turned, radius, BOX[::-1], law)
    swapped = one[np.ix_((1, 0, 2), (1, 0, 2))] * np.outer((1, 1, -1), (1, 1, -1))
    assert other == pytest.approx(swapped, rel=1e-10, abs=1e-10 * 3e5)  # round-off of 16 discs, over the softest way
    assert elasticity(turned, radius, BOX[::-1], law) == pytest.approx(
        elasticity(position, radius, BOX, law), rel=1e-10
    )


def test_discs_that_nothing_holds_do_not_change_the_moduli():
    law = Linear(3e5, tangential_stiffness=1e5, friction=0.5)
    position, radius = thrown()
    held = moduli(position, radius, BOX, law)
    grid = np.stack(np.meshgrid(np.linspace(0, BOX[0], 200), np.linspace(0, BOX[1], 200)), axis=-1).reshape(-1, 2)
    way = grid[:, None] - position
    way -= np.array(BOX) * np.rint(way / BOX)
    free = (np.hypot(way[..., 0], way[..., 1]) - radius).min(axis=1)
    assert free.max() > 0.0
    # one more disc, in the widest pore
    more = np.vstack((position, grid[free.argmax()])), np.append(radius, 0.5 * free.max())
    # the ties go with the mean radius squared, which one disc of 17 changes by less than an eighth
    assert moduli(*more, BOX, law) == pytest.approx(held, rel=1e2 * LOOSE, abs=1e2 * LOOSE * 3e5)
