"""Polygons cover exactly what they are, act as rigid bodies in fluid, and cost nothing where there are none."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from porescale.common.compiled.jit import set_threads
from porescale.common.core.errors import InputError
from porescale.coupling.coverage import polygon as shapes
from porescale.coupling.coverage.discs import cover
from porescale.coupling.coverage.interpenetration import depth
from porescale.coupling.coverage.polygon import Polygons
from porescale.coupling.coverage.rows import make_patches
from porescale.coupling.divergence_check import _lightest
from porescale.coupling.psm import SaturatedCells
from porescale.coupling.step import Coupled
from porescale.dem.bodies.clumps import Body
from porescale.dem.bodies.frames import chain, framed, polygon
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from porescale.lbm.scales import Scales
from porescale.validation.coupling import polygons as outlines
from porescale.validation.coupling import polygons_moving, setups
from tests.reference.coupling.polygons import fractions_of
from tests.reference.memory import growth

EPS = np.finfo(float).eps
WALLED = Fluid(64, 64, 0.8)
"""A box that polygons are asked to fit into."""


def turned(corners, degrees, x=0.0, y=0.0):
    """Corners (k, 2) turned about 0, then moved."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.asarray(corners) @ [[c, s], [-s, c]] + [x, y]


def patch_of(corners, centre=(0.0, 0.0), angle=0.0, shift=0.0, kernel=shapes.cover_polygons):
    """Corner and fractions (height, stride) of one polygon's patch."""
    body = Polygons([corners])
    body.centre[0], body.angle[0] = centre, angle
    cells = body.fit(WALLED, shift, 0)
    patches = make_patches(cells, cells, np.dtype(float))
    kernel(0, body.outline, body._begins[1], body.centre, body.angle, body._at, body._line, patches)
    size = int(patches.height[0] * patches.stride[0])
    return patches.corner[0].copy(), patches.fraction[:size].reshape(patches.height[0], -1).copy(), body


SHAPES = {
    "square": outlines.regular(4, 30.0, 45.0),
    "triangle": outlines.regular(3, 9.0),
    "speck": outlines.regular(5, 0.02),
    "plate": outlines.plate(9.0, 0.3),
    "many": outlines.regular(17, 12.0),
}


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("degrees", [0.0, 17.0, 45.0, 90.0, 163.0])
def test_a_polygon_covers_the_area_that_clipping_finds(name, degrees):
    corner, fraction, body = patch_of(SHAPES[name], (7.3, 6.6), math.radians(degrees))
    # The corners that the kernel keeps count from the patch's left side, and from the centre's cell upwards.
    rows = 6 - corner[1]
    moved = np.column_stack((body._at[:, 0], body._at[:, 1] + rows))
    exact = fractions_of(moved, *fraction.shape[::-1])
    # An edge's area is good to some ten roundings of places of up to ten cells, for each of 17 edges.
    np.testing.assert_allclose(fraction, exact, rtol=0, atol=17 * 10 * 10 * EPS)


def test_the_plain_kernel_does_the_same():
    compiled = patch_of(SHAPES["square"], (7.3, 6.6), 0.3)
    plain = patch_of(SHAPES["square"], (7.3, 6.6), 0.3, kernel=shapes.cover_polygons.py_func)
    np.testing.assert_array_equal(compiled[1], plain[1])
    np.testing.assert_array_equal(compiled[0], plain[0])


@given(
    st.integers(3, 12), st.floats(0.05, 12.0), st.floats(0.05, 1.0), st.floats(-20.0, 20.0),
    st.floats(-50.0, 90.0), st.floats(-50.0, 90.0),
)  # fmt: skip
def test_fractions_add_up_to_the_area_wherever_and_however_it_lies(count, size, flatness, angle, x, y):
    corners = outlines.regular(count, 1.0) * [size, size * flatness]
    _, fraction, body = patch_of(corners, (x, y), angle)
    assert 0.0 <= fraction.min() <= fraction.max() <= 1.0
    # What is left of two edges in each cell, 16 roundings of the extent (the kernel's own bound), all one way.
    assert abs(fraction.sum() - body.area[0]) <= 16 * EPS * max(24.0, 1.0) * fraction.size


def test_cells_within_are_full_to_the_bit_and_cells_beyond_empty():
    corner, fraction, _ = patch_of(outlines.regular(4, 900.0, 45.0), (40.3, 41.7), math.radians(33.0))
    y, x = np.mgrid[: fraction.shape[0], : fraction.shape[1]] + 0.5 + np.array(corner[::-1])[:, None, None]
    away = turned(np.stack((x - 40.3, y - 41.7), -1).reshape(-1, 2), -33.0).reshape(*x.shape, 2)
    far = np.abs(away).max(axis=-1)
    assert np.all(fraction[far < 15.0 - math.sqrt(0.5)] == 1.0)
    assert np.all(fraction[far > 15.0 + math.sqrt(0.5)] == 0.0)


def test_whole_cells_and_whole_turns_move_the_patch_and_nothing_else():
    corner, fraction, _ = patch_of(SHAPES["triangle"], (7.25, 6.5), 0.5)
    moved, same, _ = patch_of(SHAPES["triangle"], (7.25 + 1024, 6.5 - 512), 0.5)
    np.testing.assert_array_equal(fraction, same)
    np.testing.assert_array_equal(moved - corner, [1024, -512])


def test_either_way_round_is_the_same_polygon():
    np.testing.assert_allclose(
        patch_of(SHAPES["many"], (7.3, 6.6))[1], patch_of(SHAPES["many"][::-1], (7.3, 6.6))[1], rtol=0, atol=100 * EPS
    )


def test_tips_add_what_a_whole_turn_lacks():
    for corners in SHAPES.values():
        _, fraction, body = patch_of(corners, (9.3, 9.6), 0.4, shift=0.28)
        assert body.covered_area[0] - body.area[0] == pytest.approx(2 * math.pi * 0.28, rel=1e-12)
        if body.area[0] > 1.0:  # a speck's tips are longer than itself: cells count no more than full
            assert fraction.sum() == pytest.approx(body.covered_area[0], rel=0.02)


def test_a_polygon_of_many_corners_is_the_disc_with_its_shift():
    radius, shift, count = 6.0, 0.28, 200
    corner, fraction, _ = patch_of(outlines.regular(count, math.pi * radius**2), (9.3, 9.6), 0.0, shift)
    width = np.array([int(2 * (radius + shift / radius)) + 2])
    disc = make_patches(width + 1, width, np.dtype(float))
    cover(np.array([[9.3, 9.6]]), np.array([radius + shift / radius]), disc, np.zeros((64, 7, 64)))
    round_one = disc.fraction.reshape(width[0], -1)
    down, left = corner[1] - disc.corner[0, 1], corner[0] - disc.corner[0, 0]
    part = round_one[down : down + fraction.shape[0], left : left + fraction.shape[1]]
    # Tips rise from 0 to twice the mean of shift/radius, and sides cut R (1 - cos(pi/n)): what is left in a cell is
    # less than one wave of tips, 2 shift/radius times half a side.
    side = 2 * math.pi * radius / count
    assert (
        np.abs(part - fraction[:, : part.shape[1]]).max()
        < 2 * shift / radius * 0.5 * side + radius * (math.pi / count) ** 2
    )


@pytest.mark.parametrize(
    ("corners", "said"),
    [
        ([(0, 0), (4, 0), (1, 1), (0, 4)], "turns inwards"),
        ([(0, 0), (4, 4), (4, 0), (0, 4)], "turns inwards"),
        (outlines.regular(5, 20.0)[[0, 2, 4, 1, 3]], "crosses itself"),
        ([(0, 0), (4, 0)], "no polygon"),
        ([(0, 0), (4, 0), (4, 0), (0, 4)], "one point"),
        ([(0, 0), (4, 0), (math.nan, 4)], "no polygon"),
    ],
)
def test_what_is_not_convex_is_refused(corners, said):
    with pytest.raises(InputError, match=said):
        Polygons([corners])


def test_frames_that_are_no_convex_polygons_are_refused_in_fluid():
    fluid, box, scales = Fluid(32, 32, 0.8), Box((0.0, 0.0), (32.0, 32.0)), Scales(1.0, 1.0, 0.8, 1.0)

    def put(frame, **more):
        options = {"hydraulic_ratio": 1.0, "contact_steps": 4, "acceleration": (0.0, 0.0)} | more
        return Coupled(fluid, framed(None, [frame], setups.LAW, box), scales, **options)

    ell = np.array([(8, 8), (18, 8), (18, 12), (12, 12), (12, 20), (8, 20)], float)
    with pytest.raises(InputError, match="cut it into convex polygons"):
        put(polygon(ell, 0.2, 2.0))
    with pytest.raises(InputError, match="close it"):
        put(chain(ell[:3], 0.2, 2.0))
    square = turned(outlines.regular(4, 36.0), 0.0, 16.0, 16.0)
    with pytest.raises(InputError, match="centre of mass"):
        put(polygon(square, 0.2, 2.0, body=Body(72.0, (15.0, 16.0), 500.0, True, 36.0)))
    with pytest.raises(InputError, match="no films between polygons"):
        put(polygon(square, 0.2, 2.0), lubrication=True)
    with pytest.raises(ValueError, match="longer than the periodic box"):
        SaturatedCells(
            Fluid(16, 32, 0.8, sides=Sides("periodic", "periodic")),
            np.zeros(0),
            polygons=Polygons([outlines.plate(17, 3)]),
        )


def test_scenes_without_polygons_never_touch_their_code(monkeypatch):
    def never(*arguments, **more):
        raise AssertionError("called")

    for name in ("cover_polygons", "pointed", "convex"):
        monkeypatch.setattr(shapes, name, never)
    wet = SaturatedCells(Fluid(8, 8, 0.7), np.array([2.0]))
    wet.cover(np.array([[4.0, 4.0]]), np.zeros((1, 2)), np.zeros(1))
    assert wet.polygons is None
    assert wet.polygon_load.shape == (0, 3)


def flight(discs=True, steps=0, polygons=True):
    """A square, a triangle and two discs that fly at each other in a periodic box, after some steps."""
    bodies = [
        turned(outlines.regular(4, 60.0), 20.0, 12.3, 15.2),
        turned(outlines.regular(3, 50.0), 77.0, 28.0, 17.0),
    ]
    round_ones = make_discs([(8.0, 32.0), (32.0, 8.0)], [4.0, 4.0], 2.0, [(0.02, -0.02), (-0.02, 0.02)])
    coupled = polygons_moving.immersed_polygons(
        (48, 48), bodies if polygons else [], 2.0, velocity=[(0.04, 0.01), (-0.04, 0.0)], spin=[0.002, -0.004],
        discs=round_ones if discs else None, sides=("periodic", "periodic"),
    )  # fmt: skip
    for _ in range(steps):
        coupled.advance()
    return coupled


def test_a_state_of_polygons_goes_on_bit_for_bit():
    one, other = flight(steps=30), flight()
    other.restore(one.state())
    for coupled in (one, other):
        for _ in range(20):
            coupled.advance()
    np.testing.assert_array_equal(one.fluid.populations, other.fluid.populations)
    np.testing.assert_array_equal(one.polygons.position, other.polygons.position)
    np.testing.assert_array_equal(one.polygons.fluid_torque, other.polygons.fluid_torque)


def test_two_threads_give_the_bits_of_one():
    found = []
    for count in (1, 2):
        set_threads(count)
        coupled = flight(steps=30)
        found.append((coupled.fluid.populations.copy(), coupled.polygons.velocity.copy(), coupled.polygons.spin.copy()))
    for one, other in zip(*found, strict=True):
        np.testing.assert_array_equal(one, other)


def test_a_step_allocates_nothing_that_grows():
    coupled = flight(steps=4)
    assert (
        growth(coupled.advance, steps=5) < 18_432
    )  # views and numbers of a step; a field of the box has as many bytes


def test_corners_share_force_torque_and_weight_of_their_polygon():
    coupled = flight(discs=False, steps=3)
    p, discs, clumps = coupled.polygons, coupled.grains.discs, coupled.grains.steering.clumps
    for n in range(2):
        own = clumps.discs_of(n)
        # Shares of the mass are good to 1e-13 of their sum (dem/bodies/clumps.py).
        np.testing.assert_allclose(coupled.force[own].sum(axis=0), p.force[n], rtol=1e-12, atol=0)
        np.testing.assert_allclose(coupled.fluid_force[own].sum(axis=0), p.fluid_force[n], rtol=1e-12, atol=0)
        arm, force = discs.position[own] - p.position[n], coupled.force[own]
        torque = coupled.torque[own].sum() + np.sum(arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0])
        reach = float(np.abs(p.force[n]).max() * np.abs(arm).max())
        assert torque == pytest.approx(p.torque[n], rel=1e-12, abs=1e-12 * reach)
        area = float(p.inner_mass[n])
        assert clumps.mass[n] == pytest.approx(2.0 * area, rel=1e-12)
        assert p.inner_inertia[n] == pytest.approx(0.5 * clumps.inertia[n], rel=1e-12)


def test_buoyancy_is_that_of_the_outline():
    for density, sign in ((2.0, -1), (1.0, 0), (0.5, 1)):
        coupled = polygons_moving.immersed_polygons(
            (40, 40),
            [turned(outlines.regular(4, 60.0), 20.0, 20.0, 20.0)],
            density,
            acceleration=(0.0, -1e-5),
        )
        assert coupled.polygons.weight[0, 1] == pytest.approx((1.0 - density) * 60.0 * 1e-5, abs=1e-15)
        coupled.advance()
        assert np.sign(np.round(coupled.polygons.velocity[0, 1], 12)) == sign


def test_fields_show_the_outline_without_its_tips():
    coupled = flight(discs=False, steps=1)
    assert coupled.fields()[3].sum() == pytest.approx(110.0, rel=1e-12)
    assert coupled.saturated.solid.sum() == pytest.approx(110.0, rel=1e-12)
    coupled.advance()
    shift = coupled.saturated.polygons.covered_area - coupled.saturated.polygons.area
    np.testing.assert_allclose(shift, 2 * math.pi * 1.5 * 3 / 16, rtol=1e-12)


def test_the_least_width_of_polygons():
    assert shapes.least_width(outlines.plate(9.0, 0.3, 31.0)) == pytest.approx(0.3, rel=1e-12)
    assert shapes.least_width(outlines.regular(3, math.sqrt(3.0))) == pytest.approx(math.sqrt(3.0), rel=1e-12)  # side 2


def test_a_run_that_went_wrong_knows_how_light_and_thin_its_polygons_are():
    plate = turned(outlines.plate(12.0, 3.0), 20.0, 20.0, 20.0)
    ratio, across = _lightest(polygons_moving.immersed_polygons((40, 40), [plate], 0.4))
    assert ratio == pytest.approx(0.4, rel=1e-12)
    assert across == pytest.approx(3.0, rel=1e-12)


SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
TURNED = (SQUARE - 0.5) @ np.array([(1.0, 1.0), (-1.0, 1.0)]) / np.sqrt(2.0)


def test_the_depth_of_polygons_within_each_other_is_the_way_out():
    assert depth(SQUARE, SQUARE + np.array((0.75, 0.0))) == pytest.approx(0.25, rel=1e-15)
    assert depth(SQUARE, SQUARE + np.array((0.75, 0.9))) == pytest.approx(0.1, rel=1e-14)  # of 1.9 - 1, rounded at 2
    assert depth(SQUARE, SQUARE) == pytest.approx(1.0)
    assert depth(SQUARE, 0.2 * SQUARE + 0.4) == pytest.approx(0.6)  # wholly within: no corner meets a side
    assert depth(SQUARE, np.array([(0.3, 0.5)])) == pytest.approx(0.3)


def test_polygons_apart_have_no_depth():
    assert depth(SQUARE, SQUARE + np.array((1.01, 0.0))) < 0.0
    # A corner beside a corner: shadows on the first one's sides overlap, on the other's they do not.
    assert depth(SQUARE, TURNED + np.array((1.4, 1.4))) < 0.0
    assert depth(SQUARE, np.array([(1.1, 0.5)])) < 0.0
