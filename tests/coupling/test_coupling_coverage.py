"""Coverage is the exact common area of disc and cell, and a cell is never more than full."""

import math

import numpy as np
import pytest

from porescale.coupling.coverage import discs as coverage
from porescale.coupling.coverage import rows as coverage_rows
from porescale.coupling.coverage.rows import BLOCK
from porescale.coupling.psm import BAND_HEIGHT, SaturatedCells
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from tests.reference.coupling import psm as twin

EPS = np.finfo(float).eps


def covered(discs, nx=20, ny=17, kinds=("wall", "wall"), motion=(0.0, 0.0, 0.0)):
    """The saturated cells of discs (x, y, r)."""
    fluid = Fluid(nx, ny, 0.7, sides=Sides(kinds[0], kinds[0], kinds[1], kinds[1]))
    discs = np.array(discs, float)
    wet = SaturatedCells(fluid, discs[:, 2], solid_operator="odd-SC1")  # which sees the radius as it is
    u, v, w = motion
    wet.cover(discs[:, :2].copy(), np.tile((float(u), float(v)), (len(discs), 1)), np.full(len(discs), float(w)))
    return wet


def area_error(r):
    """An area of r² known to a few roundings and, where it is cancelled to nothing, the 1e-12 below which it is."""
    return 16 * EPS * max(r, 1) ** 2 + 1e-12


PLACES = [
    (8.3, 9.1, 4.2),  # anywhere
    (8.0, 9.0, 4.0),  # tangent to grid lines on all sides
    (8.5, 9.5, 4.0),  # centred in a cell
    (8.3, 9.1, 0.3),  # inside one cell
    (8.0, 9.0, 0.3),  # smaller than a cell, on a node
    (8.3, 9.1, 0.5),
    (8.0 + 1e-9, 9.0, 4.0),  # the least beyond a grid line
    (8.0, 9.0, math.sqrt(13.0)),  # through nodes (3, 2)
    (10.1, 8.3, 7.9),
]


@pytest.mark.parametrize("disc", PLACES)
def test_coverage_is_the_common_area_of_disc_and_cell(disc):
    e, _, _ = twin.coverage(*disc, 20, 17)
    np.testing.assert_allclose(covered([disc]).solid, e, rtol=0, atol=area_error(disc[2]))


@pytest.mark.parametrize("disc", PLACES)
def test_coverage_adds_up_to_the_disc(disc):
    cells = 4 * (disc[2] + 1) ** 2
    assert covered([disc]).solid.sum() == pytest.approx(math.pi * disc[2] ** 2, abs=cells * area_error(disc[2]), rel=0)


def test_the_linear_rule_does_not_add_up():
    # clamp(1/2 + sqrt(r² - 1/12) - |x - X|): the cheap linear rule
    x, y, r = 8.3, 9.1, 4.2
    cy, cx = np.mgrid[:17, :20] + 0.5
    e = np.clip(0.5 + math.sqrt(r * r - 1 / 12) - np.hypot(cx - x, cy - y), 0, 1)
    assert abs(e.sum() - math.pi * r * r) > 1e-3
    assert np.abs(e - covered([(x, y, r)]).solid).max() > 0.01


@pytest.mark.parametrize(
    "kinds", [("periodic", "periodic"), ("periodic", "wall"), ("wall", "periodic"), ("wall", "wall")]
)
@pytest.mark.parametrize("at", [(0.2, 0.4), (19.9, 16.8), (-3.0, 8.0), (8.0, 16.9), (43.1, -20.3)])
def test_coverage_wraps_on_periodic_sides_and_ends_at_walls(kinds, at):
    periodic = kinds[0] == "periodic", kinds[1] == "periodic"
    e, _, _ = twin.coverage(*at, 3.3, 20, 17, periodic)
    np.testing.assert_allclose(
        covered([(*at, 3.3)], kinds=kinds).solid, e, rtol=0, atol=area_error(3.3) + 50 * EPS * 50
    )


def test_a_disc_as_wide_as_the_periodic_box_touches_itself():
    wet = covered([(3.3, 4.1, 5.0)], nx=10, ny=10, kinds=("periodic", "periodic"))
    assert wet.solid.sum() == pytest.approx(25 * math.pi, abs=100 * area_error(5))
    with pytest.raises(ValueError, match="wider"):
        covered([(3.3, 4.1, 5.01)], nx=10, ny=10, kinds=("periodic", "periodic"))


def test_cells_far_inside_are_full_and_far_outside_empty_to_the_bit():
    wet = covered([(8.3, 9.1, 4.2)])
    cy, cx = np.mgrid[:17, :20] + 0.5
    distance = np.hypot(cx - 8.3, cy - 9.1)
    assert np.all(wet.solid[distance < 4.2 - math.sqrt(0.5)] == 1.0)
    assert np.all(wet.solid[distance > 4.2 + math.sqrt(0.5)] == 0.0)


@pytest.mark.parametrize("gap", [0.0, 1e-3, -0.3])
def test_shared_cells_are_never_more_than_full(gap):
    wet = covered([(6.3, 8.2, 3.5), (13.3 + gap, 8.2, 3.5)])
    assert wet.weights().max() <= 1.0
    e = sum(twin.coverage(x, 8.2, 3.5, 20, 17)[0] for x in (6.3, 13.3 + gap))
    full = e >= 1
    np.testing.assert_allclose(wet.weights()[full], 1.0, rtol=0, atol=10 * area_error(3.5))  # dB/de = 1/k + 1 < 10


def test_the_contact_of_two_discs_is_as_tight_as_one_solid():
    # Two halves make a full cell: B = 1 for e = 1/2 + 1/2, where the sum of each one's own B would be 0.17 at tau 0.6.
    k = 0.1
    assert twin.weight(1.0, 0.6) == 1.0
    assert 2 * twin.weight(0.5, 0.6) == pytest.approx(2 * 0.5 * k / (0.5 + k))
    from porescale.coupling.weighting.choose import choose_weight
    from porescale.coupling.weighting.law import weight

    law = choose_weight("B2", 0.6, float)
    assert weight(0.5 + 0.5, 0.0, 0.0, 0.0, law) == 1.0
    assert weight(1.7, 0.0, 0.0, 0.0, law) == 1.0
    assert weight(0.0, 0.0, 0.0, 0.0, law) == 0.0


def test_the_solid_moves_like_the_disc_in_every_cell():
    u, v, w = 0.03, -0.02, 0.01
    wet = covered([(8.3, 9.1, 4.2)], motion=(u, v, w))
    e, rx, ry = twin.coverage(8.3, 9.1, 4.2, 20, 17)
    np.testing.assert_allclose(wet.covered[1], e * (u - w * ry), rtol=0, atol=area_error(4.2))
    np.testing.assert_allclose(wet.covered[2], e * (v + w * rx), rtol=0, atol=area_error(4.2))


def test_a_disc_that_has_gone_leaves_nothing_behind():
    wet = covered([(8.3, 9.1, 4.2)])
    none = np.zeros((1, 2))
    wet.cover(np.array([[15.2, 4.3]]), none, np.zeros(1))
    np.testing.assert_array_equal(wet.solid, covered([(15.2, 4.3, 4.2)]).solid)


def stepped(monkeypatch, height):
    """Flow and loads after three steps of discs that share cells and cross sides, in bands of ``height`` rows."""
    monkeypatch.setattr("porescale.coupling.psm.BAND_HEIGHT", height)
    fluid = Fluid(20, 17, 0.7, sides=Sides("periodic", "periodic", "wall", "slip"))
    fluid.set_flow(0.02, -0.01)
    wet = SaturatedCells(fluid, np.array([3.5, 3.6, 2.2]))
    for _ in range(3):
        wet.advance(fluid, np.array([(6.3, 8.2), (13.1, 8.2), (19.7, 16.9)]), np.full((3, 2), 0.01), np.full(3, 0.002))
    return fluid.populations[:, 1:-1, 1:-1].copy(), wet.force, wet.torque


@pytest.mark.parametrize("height", [1, 3, 100])
def test_loads_and_flow_do_not_depend_on_the_bands(monkeypatch, height):
    assert height != BAND_HEIGHT
    for usual, other in zip(stepped(monkeypatch, BAND_HEIGHT), stepped(monkeypatch, height), strict=True):
        np.testing.assert_array_equal(usual, other)


def test_every_band_is_done_once():
    for rows in (1, 8, 9, 64, 1000):
        wet = SaturatedCells(Fluid(4, rows, 0.7), np.zeros(0))
        np.testing.assert_array_equal(np.sort(wet._band_order), np.arange(-(-rows // BAND_HEIGHT)))


def test_bands_at_the_bottom_are_spread_over_the_threads():
    # 16 of 64 bands hold grains; each of four threads takes a quarter of the order.
    order = SaturatedCells(Fluid(4, 64 * BAND_HEIGHT, 0.7), np.zeros(0))._band_order
    share = [int(np.sum(part < 16)) for part in np.split(order, 4)]
    assert max(share) <= 5
    assert sorted(share) != [0, 0, 0, 16]  # in their natural order one thread would do it all


def listed(wet, band):
    """Rows of the patches that a band lists, body and row, and the rows of the lattice that they lie in."""
    bands, found = wet._bands, []
    for k in range(bands.start[band], bands.start[band + 1]):
        lines = range(*coverage_rows.lines_inside.py_func(k, band, bands, wet._patches))
        low = int(coverage_rows.row_of.py_func(k, bands, wet._patches))
        found += [(int(bands.body[k]), j, low + j) for j in lines]
    return found


@pytest.mark.parametrize("kind", ["wall", "periodic"])
def test_bands_list_each_row_of_each_disc_once(kind):
    discs = [(6.3, 8.2, 3.5), (13.1, 8.2, 3.6), (9.7, 15.9, 2.2), (3.0, -0.1, 1.5), (5.0, 8.3, 8.4)]
    wet = covered(discs + [(5.0, 40.0, 2.0), (5.0, -9.0, 2.0)] * (kind == "wall"), kinds=("wall", kind))
    corner, height, rows = wet._patches.corner, wet._patches.height, []
    for band in range(len(wet._bands.start) - 1):
        here = listed(wet, band)
        assert np.all(np.diff([n for n, _, _ in here]) >= 0)  # in index order
        assert all(band * BAND_HEIGHT <= y < (band + 1) * BAND_HEIGHT for _, _, y in here)
        rows += here
    every = [(n, j, corner[n, 1] + j) for n in range(len(height)) for j in range(height[n])]
    if kind == "periodic":
        assert sorted(rows) == sorted((n, j, y % 17) for n, j, y in every)
    else:
        assert sorted(rows) == sorted((n, j, y) for n, j, y in every if 0 <= y < 17)
    assert len(set(rows)) == len(rows)


@pytest.mark.parametrize("kind", ["wall", "periodic"])
def test_bodies_that_stay_in_their_room_are_listed_as_if_anew(kind):
    rng = np.random.default_rng(5)
    discs = np.column_stack((rng.uniform(0.0, 20.0, 40), rng.uniform(-3.0, 43.0, 40), rng.uniform(0.4, 5.0, 40)))
    none, still = np.zeros((40, 2)), np.zeros(40)
    moving, kept = covered(discs, 20, 40, ("wall", kind)), 0
    for _ in range(60):
        discs[:, 1] += rng.uniform(-0.15, 0.15, 40)
        before = moving._bands.listed.copy()
        moving.cover(discs[:, :2], none, still)
        listed_before = np.array_equal(moving._bands.listed, before)
        kept += listed_before and not np.array_equal(before, moving._patches.corner[:, 1])
        anew = covered(discs, 20, 40, ("wall", kind))
        np.testing.assert_array_equal(moving.covered, anew.covered)
        for band in range(len(anew._bands.start) - 1):
            assert listed(moving, band) == listed(anew, band)
    assert kept > 5  # lists that were not those of the corners now


def test_beyond_its_room_a_body_is_missed(monkeypatch):  # the twin that must fail
    wet = covered([(8.0, 14.0, 3.0)], 20, 40)
    none = np.zeros((1, 2))
    for unseen in (False, True):
        wet.cover(np.array([[8.0, 14.0]]), none, np.zeros(1))
        low = wet._patches.corner[0, 1]
        if unseen:
            wet._bands.listed[0] = low + 12  # as if it had been listed where it goes
        wet.cover(np.array([[8.0, 26.0]]), none, np.zeros(1))
        assert np.isclose(wet.solid.sum(), 9.0 * np.pi) != unseen


@pytest.mark.parametrize("r", [0.3, 6.02, 400.0])
def test_the_area_under_a_quarter_circle_is_good_to_the_last_digits(r):
    a = r * np.concatenate((np.linspace(0, 1, 2001), 1 - np.logspace(-15, -1, 200), np.logspace(-15, -1, 200)))
    h = np.sqrt((r - a) * (r + a))
    exact = 0.5 * (a * h + r * r * np.arctan2(a, h))
    found = np.array([coverage.quarter_areas(*pair, r) for pair in zip(a, a[::-1], strict=True)])
    # the angle, at most pi/2, to 4 eps, and five roundings of areas up to r²
    np.testing.assert_allclose(found, np.stack((exact, exact[::-1]), axis=1), rtol=0, atol=8 * EPS * r * r)


def test_coverage_kernels_are_the_same_uncompiled(monkeypatch):
    discs = [(2.3, 3.1, 1.3), (4.9, 0.2, 0.4)]
    kinds = ("periodic", "wall")
    compiled = covered(discs, nx=6, ny=5, kinds=kinds, motion=(0.1, 0.2, 0.3))
    of_lines = "next_terms", "small_angles", "quarter_areas", "lines_at", "mark_lines", "across"
    for name in (
        *of_lines,
        "corner_area",
        "strip_area",
        "strips_at",
        "least_part",
        "full_or_empty",
        "place_corner",
        "cover_disc",
        "cover_part",
    ):
        monkeypatch.setattr(coverage, name, getattr(coverage, name).py_func)
    of_lists = "bands_about", "first_image", "has_room", "list_part", "row_of", "lines_inside", "blocks_inside"
    for name in (
        *of_lists,
        "views_of",
        "rasterize_band",
        "motion_of_body",
        "motion_of_row",
        "motion_of_block",
        "solid_velocity",
    ):
        monkeypatch.setattr(coverage_rows, name, getattr(coverage_rows, name).py_func)
    for module, name in ((coverage, "cover"), (coverage_rows, "list_bands"), (coverage_rows, "rasterize")):
        monkeypatch.setattr(f"porescale.coupling.psm.{name}", getattr(module, name).py_func)
    plain = covered(discs, nx=6, ny=5, kinds=kinds, motion=(0.1, 0.2, 0.3))
    np.testing.assert_allclose(plain.covered, compiled.covered, rtol=0, atol=area_error(1.3))


def test_loads_are_the_same_uncompiled(monkeypatch):
    from porescale.coupling import load

    wet = covered([(2.3, 3.1, 1.3), (4.9, 0.2, 0.4)], nx=6, ny=5, kinds=("periodic", "wall"))
    random = np.random.default_rng(0)
    scratch = np.zeros((3, BAND_HEIGHT, 6 + 2 * BLOCK))
    scratch[:, :5, BLOCK:-BLOCK] = random.uniform(-1, 1, (3, 5, 6))
    moved = np.array([[2.3, 3.1], [4.9, 0.2]]), random.uniform(-1, 1, (2, 2)), np.array([0.1, -0.2])
    motion = coverage_rows.Motion(*moved, random.uniform(-0.1, 0.1, (2, 3)), np.zeros(2))
    bands, patches = wet._bands, wet._patches
    made = []
    for plain in (False, True):
        take, add = load.accumulate_load_band, load.add_rows
        if plain:
            take, add = take.py_func, add.py_func
        if plain:
            of_cells = "motion_of_body", "motion_of_row", "motion_of_block", "load_of_cell"
            for name in ("lines_inside", "row_of", "blocks_inside", *of_cells, "add_rows_of"):
                monkeypatch.setattr(load, name, getattr(load, name).py_func)
            monkeypatch.setattr(load, "solid_velocity", coverage_rows.solid_velocity.py_func)
        row_load, loads, inside = np.full_like(wet._work.row_load, np.nan), np.zeros((2, 3)), np.zeros((2, 2))
        sums = (*scratch.reshape(3, -1), scratch[2].ravel())
        take(0, bands, patches, motion, True, sums, row_load, False)
        add(patches.corner, patches.height, 5, False, row_load, loads, inside)
        made.append(np.column_stack((loads, inside)))
    assert np.all(np.isfinite(made[0]))
    # a dozen cells, each with five roundings of numbers around 1
    np.testing.assert_allclose(*made, rtol=0, atol=60 * EPS)


def test_the_solid_fields_are_made_when_asked_for():
    wet = SaturatedCells(Fluid(30, 20, 0.7), np.array([3.0]))
    wet.advance(Fluid(30, 20, 0.7), np.array([[8.0, 9.0]]), np.zeros((1, 2)), np.zeros(1))
    assert wet._covered is None
    assert not wet.solid.any()


def test_no_discs_cover_nothing():
    fluid = Fluid(6, 5, 0.7)
    wet = SaturatedCells(fluid, np.zeros(0))
    wet.advance(fluid, np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(0))
    assert not wet.solid.any()


def many_discs(count):
    """Discs of 2.1 cells in rows, each a little off its place, in a box of 160 cells across: x, y, r."""
    k = np.arange(count)
    off = np.random.default_rng(2).uniform(-0.3, 0.3, (2, count))
    return np.stack((4.7 * (k % 34) + off[0], 4.7 * (k // 34) + off[1], np.full(count, 2.1)), axis=1)


@pytest.mark.parametrize("periodic", [False, True])
def test_many_bodies_over_threads_are_as_few_by_one(periodic):
    from porescale.coupling import load

    kinds, discs = ("periodic" if periodic else "wall",) * 2, many_discs(1500)
    parts = [covered(it, 160, 208, kinds) for it in (discs, discs[:700], discs[700:])]
    blocks = [len(it._patches.fraction) // BLOCK for it in parts]
    assert blocks[0] > coverage_rows.SERIAL_BELOW > max(blocks[1:])
    many, few = parts[0], parts[1:]
    np.testing.assert_array_equal(many._patches.fraction, np.concatenate([it._patches.fraction for it in few]))
    for band in range(208 // BAND_HEIGHT):  # those of the band in index order: first those of the first part
        found = [listed(it, band) for it in parts]
        assert found[0] == found[1] + [(n + 700, j, y) for n, j, y in found[2]]
    row_load = np.random.default_rng(3).uniform(-1, 1, (1500, 6, 5))
    loads, inside = np.zeros((3, 1500, 3)), np.zeros((3, 1500, 2))
    for k, of in enumerate((slice(1500), slice(700), slice(700, 1500))):
        patches = parts[k]._patches
        load.add_rows(patches.corner, patches.height, 208, periodic, row_load[of], loads[k, of], inside[k, of])
    np.testing.assert_array_equal(loads[0], loads[1] + loads[2])
    np.testing.assert_array_equal(inside[0], inside[1] + inside[2])
