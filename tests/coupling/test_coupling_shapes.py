"""Rectangles and rings cover what they are, move what they displace, bear what acts on them, and may leave the box."""

import numpy as np
import pytest

from porescale.coupling.coverage import through_sides as crossing
from porescale.coupling.coverage.rectangle import Rectangle, fill_rectangle
from porescale.coupling.coverage.ring import Ring
from porescale.coupling.psm import SaturatedCells
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from porescale.validation.coupling import rings as lab
from tests.reference.coupling.shapes import POINTS, fractions

EPS = np.finfo(float).eps


def covered(nx=20, ny=17, kinds=("wall", "wall"), rectangles=(), rings=(), operator="odd-SC1"):
    """Fractions and velocity of the solid of these shapes."""
    fluid = Fluid(nx, ny, 0.7, sides=Sides(kinds[0], kinds[0], kinds[1], kinds[1]))
    wet = SaturatedCells(fluid, np.zeros(0), solid_operator=operator, rectangles=rectangles, rings=rings)
    wet.cover(*lab.NO_DISCS)
    return wet


PLACES = [
    ((3.25, 4.5), (9.75, 8.125)),
    ((3.0, 4.0), (4.0, 5.0)),  # one cell
    ((3.25, 4.25), (3.75, 4.5)),  # inside one cell
    ((-2.5, 3.0), (2.5, 30.0)),  # through two sides
    ((-9.0, 3.0), (-2.0, 30.0)),  # outside
    ((17.5, -4.0), (22.25, 1.5)),
    ((-5.0, -5.0), (30.0, 30.0)),  # all
]


@pytest.mark.parametrize(("lower", "upper"), PLACES)
def test_a_rectangle_covers_the_product_of_its_overlaps(lower, upper):
    # Corners on the grid of the points' squares: brute force is exact, and so must be the product of two lengths.
    e = fractions(lambda x, y: (lower[0] < x) & (x < upper[0]) & (lower[1] < y) & (y < upper[1]), 20, 17)
    np.testing.assert_array_equal(covered(rectangles=[Rectangle(lower, upper)]).solid, e)


@pytest.mark.parametrize("kinds", [("periodic", "periodic"), ("periodic", "wall"), ("wall", "periodic")])
@pytest.mark.parametrize("place", [*PLACES[:3], ((-2.5, 3.0), (2.5, 16.0)), ((0.0, 5.5), (20.0, 8.0))])
def test_a_rectangle_goes_on_through_periodic_sides(kinds, place):
    (left, low), (right, high) = place
    periodic = kinds[0] == "periodic", kinds[1] == "periodic"
    e = fractions(lambda x, y: (left < x) & (x < right) & (low < y) & (y < high), 20, 17, periodic)
    np.testing.assert_array_equal(covered(kinds=kinds, rectangles=[Rectangle(*place)]).solid, e)


def test_a_ring_covers_what_its_hole_leaves():
    hole = lambda x, y: (x - 9.3) ** 2 + (y - 8.6) ** 2 >= 6.2**2  # noqa: E731
    e = fractions(hole, 20, 17)
    # Points cut a cell's edge of the circle, at most sqrt(2) long, to half a point: sqrt(2)/2 in POINTS.
    np.testing.assert_allclose(covered(rings=[Ring((9.3, 8.6), 6.2)]).solid, e, rtol=0, atol=0.71 / POINTS)
    assert covered(rings=[Ring((9.3, 8.6), 6.2)]).solid.sum() == pytest.approx(20 * 17 - np.pi * 6.2**2, abs=1e-10)


def test_a_ring_with_exact_walls_is_wider_by_its_shift_and_a_rectangle_is_not():
    ring, fluid = Ring((9.5, 8.5), 6.0), Fluid(20, 17, 0.7)
    solid = covered(rings=[ring], operator="exact-wall").solid.sum()
    shift = SaturatedCells(fluid, np.array([6.0])).covering_radius[0] - 6.0
    assert shift > 0.01
    assert solid == pytest.approx(20 * 17 - np.pi * (6.0 + shift) ** 2, abs=1e-10)
    assert covered(rectangles=[Rectangle((3.25, 4.5), (9.75, 8.0))], operator="exact-wall").solid.sum() == 6.5 * 3.5


def test_shapes_move_as_their_owner_says():
    gate, ring = Rectangle((3.0, 2.0), (6.0, 5.0), (0.01, 0.02)), Ring((9.5, 8.5), 6.0, spin=1e-3)
    wet = covered(rectangles=[gate])
    np.testing.assert_array_equal(wet.covered[1], 0.01 * wet.solid)
    gate.lower += 1.25
    wet.cover(*lab.NO_DISCS)
    assert wet.solid[3, 4] == 0.75**2
    turning = covered(rings=[ring])
    y, x = np.mgrid[:17, :20] + 0.5
    # A few roundings of numbers up to 0.01.
    np.testing.assert_allclose(turning.covered[1], -1e-3 * (y - 8.5) * turning.solid, rtol=0, atol=8 * 0.01 * EPS)
    np.testing.assert_allclose(turning.covered[2], 1e-3 * (x - 9.5) * turning.solid, rtol=0, atol=8 * 0.01 * EPS)


def test_shapes_that_cannot_be_are_refused():
    with pytest.raises(ValueError, match="right of and above"):
        Rectangle((3.0, 2.0), (3.0, 5.0))
    with pytest.raises(ValueError, match="two numbers"):
        Rectangle((3.0, 2.0), (4.0, 5.0), (1.0, 2.0, 3.0))
    with pytest.raises(ValueError, match="longer than the periodic box"):
        covered(kinds=("periodic", "wall"), rectangles=[Rectangle((3.0, 2.0), (23.5, 5.0))])
    with pytest.raises(ValueError, match="not periodic"):
        covered(kinds=("periodic", "wall"), rings=[Ring((9.5, 8.5), 6.0)])
    with pytest.raises(ValueError, match="radius above a cell"):
        Ring((9.5, 8.5), 0.5)


def test_absent_shapes_build_nothing():
    wet = SaturatedCells(Fluid(8, 8, 0.7), np.array([2.0]))
    assert wet.bodies is None
    assert "bodies" not in wet.state()
    assert wet.rectangle_force.shape == wet.ring_force.shape == (0, 2)
    assert wet.ring_torque.shape == (0,)
    assert wet.mass_through_sides == wet.restore_mass(Fluid(8, 8, 0.7)) == 0.0


def test_kernels_are_right_as_plain_python():
    found = np.full((3, 16), 9.0)
    fill_rectangle.py_func(3.25, 4.5, 5.5, 6.0, 3, 4, 4, found)
    np.testing.assert_array_equal(found[:, :4], np.outer([0.5, 1.0, 0.0], [0.75, 1.0, 0.5, 0.0]))
    assert not found[:, 4:].any()
    fluid, shape = Fluid(12, 10, 0.7), Rectangle((-2.0, -2.0), (5.5, 4.0), (0.01, 0.02))
    wet = SaturatedCells(fluid, np.zeros(0), rectangles=[shape])
    wet.cover(*lab.NO_DISCS)
    links, added = crossing.side_links(fluid), fluid.links.added.copy()
    motion = np.array([[1.75, 1.0]]), np.array([[0.01, 0.02]]), np.zeros(1)
    for kernel in (crossing.move_sides, crossing.move_sides.py_func):
        touching = np.zeros(1, bool)
        mass = kernel(0, (12, 10, False, False), wet._patches, *motion, links, added, touching)
        assert touching[0]
        # 4 cells high through the left side, 5.5 wide through the bottom; sums of some 30 numbers of 0.01.
        assert mass == pytest.approx(0.01 * 4 + 0.02 * 5.5, abs=30 * 0.01 * EPS)


def test_momentum_goes_from_a_moving_rectangle_to_the_fluid():
    # In a periodic box nothing else gives or takes: sum rho u - A U, the fluid inside taken along, changes by the load.
    fluid = Fluid(24, 18, 0.7, sides=Sides("periodic", "periodic", "periodic", "periodic"))
    body = Rectangle((5.3, 4.2), (11.1, 9.9))
    wet = SaturatedCells(fluid, np.zeros(0), rectangles=[body])
    given, worst, area = np.zeros(2), 0.0, 5.8 * 5.7
    for step in range(200):
        body.velocity[:] = 0.01 * np.sin(0.05 * step), 0.02 * np.sin(0.03 * step)
        wet.advance(fluid, *lab.NO_DISCS)
        body.lower += body.velocity
        given -= wet.rectangle_force[0]
        worst = max(worst, float(np.abs(np.array(fluid.momentum()) - area * body.velocity - given).max()))
    # Each of 200 steps rounds the momentum 0.02 of some 400 cells, all one way.
    assert worst < 200 * 400 * 0.02 * EPS
    assert np.abs(given).max() > 0.1


@pytest.mark.parametrize("relaxation_time", [0.6, 0.8, 1.5])
@pytest.mark.parametrize("gap", [6.0, 6.25, 6.5, 6.9])
def test_couette_flow_is_exact_wherever_the_moving_face_lies_in_a_cell(gap, relaxation_time):
    # exact-wall solves a linear profile exactly; exp(-36) of the start is left, and round-off of some thousand steps.
    velocity, drag = lab.couette_error(gap, relaxation_time)
    assert velocity < 1e-12
    assert drag < 1e-10


def test_couette_flow_of_the_older_operator_depends_on_where_the_face_lies():
    assert lab.couette_error(6.5, 0.8, solid_operator="odd-SC1", weighting="B2")[1] > 1e-3


def test_a_piston_pushes_out_what_it_displaces():
    # It captures fluid at the density before it: 1 + 3 p, p the drop along channel and gap, in parts of 1: measured
    # below 0.4 % at this speed.  0.5 % for that, and 0.1 % for sound of the start.
    channel, gap, taken_in = lab.piston_flux()
    assert channel == pytest.approx(1.0, abs=6e-3)
    assert gap == pytest.approx(1.0, abs=6e-3)
    assert taken_in == pytest.approx(1.0, abs=1.2e-2)


@pytest.mark.parametrize("lid", ["wall", "slip"])
def test_a_gate_leaves_through_the_lid_and_the_book_knows_what_it_took(lid):
    left = lab.lift_gate(lid=lid)
    # Round-off: 3000 steps in each of 720 cells, of populations of 0.13 * 4/9 at most, all one way.
    assert left.off_the_book < 3000 * 720 * 0.06 * EPS
    # Its area, less half a row at the floor and at the lid each (1/24), and a few per cent of densities on the way.
    assert left.lost == pytest.approx(1 - 1 / 24, abs=0.03)
    assert left.highest < 1.02
    # Nothing is caught or lost: waves of the last lift-off, 6/0.01 steps before, have gone.
    assert left.spread < 1e-3


def test_a_gate_may_leave_the_pressure_as_it_was():
    left = lab.lift_gate(made_good=True)
    assert abs(left.lost) < 1e-12
    assert left.spread < 1e-3
    assert left.highest < 1.02


def test_a_lid_that_rests_is_run_into():
    left = lab.lift_gate(carried=False)
    assert left.highest > 1.2


def set_off(rest, *, one_sided=False):
    """Flow along x six steps after a gate through a slip lid set off, having rested for some.

    one_sided: with links of the lid that know only the cell that they leave.
    """
    fluid = Fluid(20, 12, 0.8, sides=Sides(top="slip"))
    gate = Rectangle((8.3, -60.0), (12.0, 200.0))
    wet = SaturatedCells(fluid, np.zeros(0), rectangles=[gate])
    if one_sided:
        wet.bodies._links.share[:] = 0.0
    for step in range(rest + 6):
        gate.velocity[1] = 0.01 * (step >= rest)
        wet.advance(fluid, *lab.NO_DISCS)
        gate.lower += gate.velocity
    return fluid.fields()[1]


def test_a_gate_through_a_slip_lid_may_set_off_at_an_even_step_or_at_an_odd(monkeypatch):
    # A mirrored link goes the one way in even steps and the other in odd ones.  Left out: that density inside is led
    # back every other step.
    monkeypatch.setattr("porescale.coupling.coverage.bodies.DENSITY_SHARE", 0.0)
    np.testing.assert_allclose(set_off(0), set_off(1), rtol=0, atol=1e-14)
    assert np.abs(set_off(0, one_sided=True) - set_off(1, one_sided=True)).max() > 1e-3


@pytest.mark.parametrize("turning", ["disc", "ring"])
def test_the_torque_between_disc_and_ring_is_that_of_couette(turning):
    # The shift that suits drag best is 0.28, torque wants 0.07 (tau 0.8): 2 (R2²/R1² - R1²/R2²)/(R2² - R1²) times the
    # difference of 0.21, 2.1 % here; a quarter more for the place in the cell.
    disc, ring = lab.couette_torque(5.0, 10.0, 0.8, turning=turning)
    assert abs(disc) == pytest.approx(1.0, abs=0.027)
    # What one gets the other loses: steady to exp(-30), and odd links of the rim to a hundredth of the flow squared.
    assert disc + ring == pytest.approx(0.0, abs=1e-5)


def test_a_state_goes_on_bit_for_bit():
    def made():
        fluid = Fluid(20, 16, 0.7)
        gate = Rectangle((8.2, 1.0), (11.4, 20.0), (0.0, 0.01))
        return (
            fluid,
            gate,
            SaturatedCells(fluid, np.array([2.0]), rectangles=[gate], rings=[Ring((10.0, 8.0), 7.5, spin=1e-4)]),
        )

    disc = np.array([[4.8, 8.0]]), np.zeros((1, 2)), np.zeros(1)
    fluid, gate, wet = made()
    for _ in range(7):
        wet.advance(fluid, *disc)
        gate.lower += gate.velocity
    other, twin, again = made()
    other.restore(fluid.state())
    again.restore(wet.state())
    twin.lower[:] = gate.lower
    for f, g, w in ((fluid, gate, wet), (other, twin, again)):
        for _ in range(5):
            w.advance(f, *disc)
            g.lower += g.velocity
    np.testing.assert_array_equal(fluid.populations, other.populations)
    np.testing.assert_array_equal(wet.rectangle_force, again.rectangle_force)
    assert wet.mass_through_sides == again.mass_through_sides
