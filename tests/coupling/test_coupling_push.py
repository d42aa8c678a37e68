"""What a body force on the fluid does to bodies: found anew after a restart, summed only where a body has moved.

Where none acts none is computed, and the bits are those of a force of nothing.
"""

import copy

import numpy as np
import pytest

from porescale.builders.build import build
from porescale.builders.scene import Scene
from porescale.coupling import psm
from porescale.coupling.coverage.polygon import Polygons
from porescale.coupling.coverage.rectangle import Rectangle
from porescale.coupling.psm import SaturatedCells
from porescale.coupling.step import Coupled
from porescale.lbm import fluid
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from porescale.validation.coupling import setups as lab


@pytest.mark.parametrize("steps", [0, 15])
def test_a_restored_run_has_the_push_of_a_body_force(steps):
    """That on discs that stand is the same to the bit, and so is what follows."""

    def made(force):
        sides = "periodic", "periodic"
        coupled = lab.immersed((40, 30), [(9.3, 8.1), (27.2, 19.6)], 4.7, 2.0, sides=sides, force=(force, 0.0))
        coupled.grains.hold([0, 1])
        return coupled

    whole, again, still = made(1e-4), made(1e-4), made(0.0)
    for _ in range(steps):
        whole.advance()
    for other in (again, still):
        other.restore(copy.deepcopy(whole.state()))
    np.testing.assert_array_equal(again.push, whole.push)
    assert bool(whole.push.any()) == bool(steps)
    if steps:  # the check that must fail: without a body force there is no push
        assert not np.array_equal(still.push, whole.push)
    for each in (whole, again):
        each.advance()
    np.testing.assert_array_equal(again.push, whole.push)
    np.testing.assert_array_equal(again.fluid.populations[:, 1:-1, 1:-1], whole.fluid.populations[:, 1:-1, 1:-1])


def test_the_loads_of_a_restored_scene_are_those_of_the_saved_one():
    def made():
        return build(Scene(
            domain={"width": 0.01, "height": 0.01, "left": "periodic", "right": "periodic"}, time={"end": 1.0},
            output={"snapshot_interval": 1.0, "series_interval": 1.0}, gravity=(0.0, 0.0),
            disc=[{"x": 0.005, "y": 0.004, "diameter": 0.003}], loads={"discs": [0]},
            fluid={
                "density": 1000, "viscosity": 1e-5, "spacing": 2.5e-4, "relaxation_time": 0.8, "body_force": (1.0, 0.0),
            },
        ))  # fmt: skip

    saved, again = made(), made()
    saved.advance(20)
    again.restore(copy.deepcopy(saved.state()))
    assert again.tables()["loads"] == saved.tables()["loads"]
    # The check that must fail: without the push, 1 N/m³ times the area, the force is another.
    lacking = saved.tables()["loads"]["disc 0 force x (N/m)"] - np.pi * 0.0015**2
    assert lacking < 0.9 * saved.tables()["loads"]["disc 0 force x (N/m)"]


@pytest.mark.parametrize("operator", ["exact-wall", "SC2"])
def test_the_push_follows_a_disc_that_moves_and_is_kept_for_one_that_stands(monkeypatch, operator):
    """What is kept is what a sum would find."""
    fluid = Fluid(40, 30, 0.8, force=(1e-4, 0.0), sides=Sides("wall", "wall", "wall", "wall"))
    cells, sums = SaturatedCells(fluid, np.array([4.0]), solid_operator=operator), []
    for name in ("covered_area", "held_area"):
        found = getattr(psm, name)
        monkeypatch.setattr(psm, name, lambda *given, found=found: sums.append(1) or found(*given))
    still, pushes = (np.zeros((1, 2)), np.zeros(1)), []
    for x in (10.0, 10.0, 2.0, 2.0, 10.0):  # at 2 a part of it lies beyond the wall
        cells.advance(fluid, np.array([(x, 15.0)]), *still)
        pushes.append(float(cells.push[0, 0]))
    assert len(sums) == 3
    assert pushes[0] == pushes[1] == pushes[4]
    # Beyond a chord at half the radius lie (pi/3 - sqrt(3)/4)/pi = 20 % of the disc.
    assert pushes[2] == pushes[3] < 0.9 * pushes[0]
    cells.cover(np.array([(2.0, 15.0)]), *still, bare=True)  # other patches, which no step may use
    cells.advance(fluid, np.array([(10.0, 15.0)]), *still)
    assert (len(sums), float(cells.push[0, 0])) == (4, pushes[0])


@pytest.mark.parametrize("operator", ["exact-wall", "odd-SC1"])  # all but the exact wall have one share of the force
def test_cells_with_discs_in_undriven_fluid_have_the_same_bits(monkeypatch, operator):
    def run(law):
        coupled = lab.handful(acceleration=(1e-5, -5e-5))
        coupled = Coupled(
            coupled.fluid, coupled.grains, coupled.scales, hydraulic_ratio=0.8, contact_steps=4,
            acceleration=(1e-5, -5e-5), solid_operator=operator,
        )  # fmt: skip
        coupled.fluid.set_flow(0.03, -0.01)
        seen = []
        monkeypatch.setattr(fluid, "without_force", lambda own: seen.append(law(own)) or seen[-1])
        for _ in range(30):
            coupled.advance()
        return type(seen[-1]).__name__, coupled

    without_force = fluid.without_force
    plain, one = run(lambda own: own)
    free, other = run(without_force)
    assert (plain, free) == ("Trt", "TrtWithoutForce")
    for a, b in ((one.fluid.populations, other.fluid.populations), (one.force, other.force), (one.torque, other.torque),
                 (one.grains.discs.position, other.grains.discs.position)):  # fmt: skip
        np.testing.assert_array_equal(a, b)
    assert np.ptp(one.fluid.populations) > 1e-3
    _, driven = run(lambda own: own._replace(fx=own.fx + 1e-9))  # the twin: a force is seen
    assert not np.array_equal(driven.fluid.populations, other.fluid.populations)


PERIODIC = Sides("periodic", "periodic", "periodic", "periodic")
NO_DISCS = np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(0)


@pytest.mark.parametrize("kind", ["polygon", "rectangle"])
def test_a_force_of_every_cell_that_is_the_same_everywhere_does_what_a_uniform_one_does(kind):
    """To the bit: what it adds to loads at once is left out of the half-step correction of polygons and rectangles."""

    def made(force, field=None):
        fluid = Fluid(20, 16, 0.8, force=(force, 0.0), sides=PERIODIC)
        if field is not None:
            fluid.set_force_field(np.stack((np.full((16, 20), field), np.zeros((16, 20)))))
        outline = Polygons([[(-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0)]]) if kind == "polygon" else None
        given = {"polygons": outline} if outline else {"rectangles": [Rectangle((5.0, 5.0), (11.0, 11.0))]}
        cells = SaturatedCells(fluid, np.zeros(0), **given)
        if outline:
            outline.centre[:] = 8.3, 8.2
        for _ in range(20):
            cells.advance(fluid, *NO_DISCS)
        return cells.polygon_load[0, 0] if outline else cells.rectangle_force[0, 0]

    uniform = made(1e-5)
    assert made(0.0, 1e-5) == uniform
    assert made(0.0, 1.01e-5) > 1.005 * uniform  # the check that must fail: a hundredth more is seen


def test_a_disc_that_has_crossed_a_periodic_side_has_the_force_of_the_cells_it_is_in():
    fluid = Fluid(24, 16, 0.8, sides=PERIODIC)
    fluid.set_force_field(np.stack((np.tile(1e-5 * np.arange(24.0), (16, 1)), np.zeros((16, 24)))))
    cells, still, pushes = SaturatedCells(fluid, np.array([3.0])), (np.zeros((1, 2)), np.zeros(1)), []
    for x in (4.2, 28.2, -19.8, 5.2):
        cells.find_push(fluid, np.array([(x, 8.1)]), *still)
        pushes.append(float(cells.push[0, 0]))
    # The places of cells a period on differ by round-off of a coordinate, 24 eps of a cell.
    assert pushes[1:3] == pytest.approx([pushes[0]] * 2, rel=1e-13)
    assert pushes[3] == pytest.approx(1.25 * pushes[0], rel=1e-6)  # the check that must fail: a cell on it is more
