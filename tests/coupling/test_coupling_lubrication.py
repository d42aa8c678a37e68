"""Films: the squeeze-film law below a cell, equal and opposite, stable at its thinnest; off unless asked for.

Where films are corrected cells that two bodies share keep a tenth open, and no others change.
"""

import math

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.coupling import lubrication as law
from porescale.coupling.coverage.shared import MOST
from porescale.coupling.psm import SaturatedCells
from porescale.coupling.step import Coupled
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box, Plate
from porescale.dem.grains import Grains
from porescale.dem.motion.control import Moved
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from porescale.validation.coupling import setups as lab

EPS = np.finfo(float).eps
MU = 0.1
SHIFT = 0.28


def dry(position, radius, velocity=0.0, density=2.0, skin=0.01):
    """Discs in a closed box of 60 x 40 m with a skin so small that gaps are not listed by chance."""
    return Grains(make_discs(position, radius, density, velocity), lab.LAW, Box((0.0, 0.0), (60.0, 40.0)), skin=skin)


def films(grains, cut=1.0, dt=0.25, *, plain=False):
    force = np.zeros((grains.discs.count, 2))
    lub = law.Lubrication(grains, grains.discs.radius, viscosity=MU, spacing=1.0, cut=cut, dt=dt, shift=SHIFT)
    d, pairs = grains.discs, grains.current_pairs()
    add = law.add_films.py_func if plain else law.add_films
    add(
        d.position, d.velocity, d.radius, d.mass, pairs.start, pairs.partner, grains.box.period, grains.walls,
        grains.plates, law.FilmLaw(MU, 1.0, cut, dt, SHIFT), force,
    )  # fmt: skip
    return force, lub


def test_a_thin_film_is_the_limit_of_jeffrey_and_onishi():
    # 4 pi/(alpha - tanh alpha) = 12 pi/alpha³ (1 + 2/5 alpha² + ...), alpha² = 2 g/R (1 - g/(6 R) + ...)
    for gap in (1e-3, 1e-2):
        alpha = math.acosh(1 + gap)
        exact = 4 * math.pi / (alpha - math.tanh(alpha))
        assert law.FILM * gap**-1.5 == pytest.approx(exact, rel=1.1 * gap * (4 / 5 + 1 / 4))


@pytest.mark.parametrize("plain", [False, True])
def test_films_between_discs_and_at_walls_follow_the_law(plain):
    grains = dry(
        [(20.0, 20.0), (29.5, 20.0), (5.3, 10.0)], [5.0, 4.0, 5.0], [(0.02, 0.01), (-0.01, 0.0), (-0.03, 0.02)]
    )
    force, _ = films(grains, plain=plain)

    def c(radius, gap, measured):
        seen = max(measured[0], gap + (measured[0] - SHIFT / radius) * (1 - gap / law.CELLS) ** measured[1])
        return law.FILM * MU * ((radius / gap) ** 1.5 - (radius / seen) ** 1.5)

    between, wall = c(20 / 9, 0.5, law.BETWEEN_DISCS) * 0.03, c(5.0, 0.3, law.AT_A_WALL) * 0.03
    # lengths of 30 and differences of 0.3: 100 eps, to the power 3/2
    np.testing.assert_allclose(force, [(-between, 0), (between, 0), (wall, 0)], rtol=300 * EPS, atol=1e-15)


def added(gap, radius, shift=SHIFT, measured=law.BETWEEN_DISCS):
    """Share of the thin-film law that is added, of a film of which no step is too long."""
    whole = law.FILM * MU * (radius / gap) ** 1.5
    return law.film(gap, radius, 1.0, measured, law.FilmLaw(MU, 1.0, law.CELLS, 0.0, shift)) / whole


@pytest.mark.parametrize("measured", [law.BETWEEN_DISCS, law.AT_A_WALL])
def test_what_is_added_is_a_share_of_the_film_and_ends_with_the_last_cell(measured):
    for radius in (0.3, 0.76, 1.0, 2.5, 100.0):
        gaps = np.linspace(1e-6, law.CELLS * (1 - 1e-12), 200)
        shares = [added(gap, radius, measured=measured) for gap in gaps]
        assert 0 <= min(shares) <= max(shares) <= 1  # so the film that is stable in whole is in part
        # next to the cut 3/2 of d/3, d at most D times 1e-12; and round-off of the two powers
        assert shares[-1] < 1e-12 + 4 * EPS
    least = SHIFT / measured[0]  # reduced radius where outlines in the lattice are nearer by all of D
    assert added(0.5, 1.01 * least, measured=measured) > 0 == added(0.5, 0.99 * least, measured=measured)  # no thrust


def test_outlines_that_meet_in_the_lattice_bear_the_film_that_it_lacks():
    wide = law.BETWEEN_DISCS[0]
    for radius in (0.5, 1.0, 2.5):  # outlines nearer by 0.56, 0.28 and 0.11 cells
        for gap in (0.01, 0.1):
            assert added(gap, radius) == pytest.approx(1 - (gap / wide) ** 1.5, rel=20 * EPS)
    assert added(0.2, 2.5) > 1 - (0.2 / wide) ** 1.5


def test_outlines_that_are_wider_in_the_lattice_make_up_for_a_part_of_the_film():
    # of a gap 0.2 that the lattice has as 0.2 - 0.28/2.5 it bears more than of one that it has as 0.2
    assert added(0.2, 2.5) < added(0.2, 2.5, shift=0.0) - 0.07
    assert added(0.2, 2.5, shift=0.0) == pytest.approx(added(0.2, 50.0, shift=0.0), rel=20 * EPS)


def test_films_of_an_oblique_pair_are_equal_opposite_and_along_the_line_of_centres():
    n = np.array([0.6, 0.8])
    grains = dry([(20.0, 20.0), tuple(20.0 + 9.4 * n)], [5.0, 4.0], [(0.02, 0.01), (-0.01, 0.03)])
    force, _ = films(grains)
    np.testing.assert_array_equal(force[0], -force[1])
    assert abs(force[0] @ (-0.8, 0.6)) < 1e-14
    assert force[1] @ n > 0  # 0.03 * 0.6 - 0.02 * 0.8 > 0: they close


@pytest.mark.parametrize(("gap", "acts"), [(1.001, False), (0.999, True), (1e-6, True), (-1e-6, False)])
def test_a_film_acts_below_the_cut_and_not_in_contact(gap, acts):
    force, _ = films(dry([(20.0, 20.0), (28.0 + gap, 20.0)], 4.0, [(0.01, 0.0), (0.0, 0.0)]))
    assert (force != 0).any() == acts


@pytest.mark.parametrize("plain", [False, True])
def test_no_film_acts_through_a_plate(plain):
    # Two discs 0.5 apart; the line of centres crosses x = 24.25 at a height of 20.
    def pushed(plate, *, open_it=False):
        discs = make_discs([(20.0, 20.0), (28.5, 20.0)], [4.0, 4.0], 2.0, [(0.02, 0.0), (-0.01, 0.0)])
        grains = Grains(discs, lab.LAW, Box((0.0, 0.0), (60.0, 40.0)), plates=[plate], skin=0.01)
        if open_it:
            grains.remove_plate(plate.name)
        return films(grains, plain=plain)[0].any()

    assert not pushed(Plate(24.25, 0.0, 40.0))
    # The twins: it ends above or below them, stands beside them, or is gone.
    assert pushed(Plate(24.25, 20.1, 40.0))
    assert pushed(Plate(24.25, 0.0, 19.9))
    assert pushed(Plate(30.0, 0.0, 40.0))
    assert pushed(Plate(24.25, 0.0, 40.0), open_it=True)


def test_gaps_up_to_the_cut_are_listed_only_when_films_ask_for_it():
    grains = dry([(20.0, 20.0), (28.5, 20.0)], 4.0)
    grains.refresh()
    assert len(grains.pairs.partner) == 0
    films(grains)
    assert len(grains.pairs.partner) == 1


def test_the_thinnest_film_is_stable_and_one_eight_times_as_stiff_is_not():
    def last():
        grains = dry([(20.0, 20.0), (28.0 + 1e-3, 20.0), (20.0, 28.001)], 4.0, [(1e-6, 1e-6), (0, 0), (0, 0)])
        _, lub = films(grains)
        start = np.abs(grains.discs.velocity).max()
        for _ in range(60):
            lub.step(grains, np.zeros((3, 2)), np.zeros(3), 1)
            grains.discs.position[:] = [(20.0, 20.0), (28.001, 20.0), (20.0, 28.001)]
        return np.abs(grains.discs.velocity).max() / start

    def forced(stiffer):
        grains = dry([(20.0, 20.0), (28.0 + 1e-3, 20.0)], 4.0, [(1e-6, 0), (0, 0)])
        d = grains.discs
        for _ in range(60):
            force = np.zeros((2, 2))
            push = (
                stiffer
                * law.film(1e-3, 2.0, d.mass[0], law.BETWEEN_DISCS, law.FilmLaw(MU, 1.0, 1.0, 0.25, SHIFT))
                * (d.velocity[0, 0] - d.velocity[1, 0])
            )
            force[:, 0] = -push, push
            grains.step(0.25, force)
            d.position[:] = [(20.0, 20.0), (28.001, 20.0)]
        return np.abs(d.velocity).max() / 1e-6

    assert last() < 1.0
    assert forced(1.0) < 1.0
    assert forced(8.0) > 10.0  # C dt = 8/3 m on half the mass: beyond 2


def test_a_step_too_long_for_any_film_is_refused():
    with pytest.raises(InputError, match="lubrication"):
        films(dry([(20.0, 20.0)], 4.0, density=0.1), dt=10.0)


def lubricated(on=True):
    plain = lab.immersed(
        (40, 30), [(12.0, 12.2), (20.6, 12.9), (28.9, 4.5)], 4.0, [2.0, 3.0, 2.5],
        [(0.02, 0.0), (-0.02, 0.01), (0.0, -0.01)], acceleration=(0.0, -2e-5), sides=("periodic", "wall"),
    )  # fmt: skip
    made = Coupled(
        plain.fluid, plain.grains, plain.scales, hydraulic_ratio=1.0, contact_steps=4, acceleration=(0.0, -2e-5),
        lubrication=on,
    )  # fmt: skip
    made.grains.hold(0)
    return made


def test_no_film_unless_asked_for():
    assert (lab.handful().lubrication, lab.handful().saturated.body) == (None, None)


def test_a_restored_run_with_films_goes_on_bit_for_bit():
    whole, again = lubricated(), lubricated()
    acted = 0
    for step in range(60):
        if step == 25:
            kept = again.state()
            again = lubricated()
            again.restore(kept)
        for coupled in (whole, again):
            coupled.advance()
        acted += bool(whole.lubrication.force.any())
    assert acted > 20
    for name in ("position", "velocity", "spin"):
        np.testing.assert_array_equal(getattr(whole.grains.discs, name), getattr(again.grains.discs, name))


def test_holders_bear_the_films_too_and_only_contacts_are_contacts():
    coupled = lubricated()
    met = 0
    for _ in range(60):
        coupled.advance()
        bears = coupled.grains.withheld[0, :2]
        rest = bears - coupled.force[0] - coupled.lubrication.force[0]
        # sums of forces of some 0.1, four steps
        np.testing.assert_allclose(coupled.contact_load()[0, :2], rest, rtol=0, atol=40 * EPS)
        met += bool(coupled.lubrication.force[0].any())
        if not coupled.grains.pairs.carried.any():
            assert np.abs(rest).max() < 40 * EPS
    assert met > 10


def test_a_body_with_a_prescribed_motion_has_the_mean_load_of_a_fluid_step():
    def loads(lubrication):
        # two discs in contact, moved 0.3 a fluid step apart by the one's control; touching discs have no film
        made = lab.immersed((40, 30), [(14.0, 15.0), (21.5, 15.0)], 4.0, [2.0, 3.0], [(0.0, 0.0), (0.0, 0.0)])
        coupled = Coupled(
            made.fluid, made.grains, made.scales, hydraulic_ratio=1.0, contact_steps=4, acceleration=(0.0, 0.0),
            lubrication=lubrication,
        )  # fmt: skip
        steering = coupled.grains.steering
        steering.control(0, x=Moved(-0.3), y=Moved(0.0), rotation=Moved(0.0))
        steering.control(1, x=Moved(0.0), y=Moved(0.0), rotation=Moved(0.0))
        steering.watch(0, 1)
        coupled.advance()
        coupled.grains.restore(coupled.grains.state())
        return np.array([[*row.contact, *row.supply] for row in steering.record()])

    mean = loads(False)
    assert mean[0, 0] < -1e-6 < 1e-6 < mean[1, 0]
    np.testing.assert_allclose(loads(True), mean, rtol=1e-12, atol=1e-12 * np.abs(mean).max())


@pytest.mark.parametrize(("kind", "acts"), [("wall", True), ("slip", False), ("velocity", False), ("pressure", False)])
def test_films_are_at_sides_that_hold_the_fluid_alone(kind, acts):
    made = lab.immersed((40, 30), [(35.8, 15.0)], 4.0, [2.0], [(0.02, 0.0)], sides=("wall", "wall"))
    fluid = Fluid(40, 30, made.fluid.relaxation_time, sides=Sides(right=kind))
    coupled = Coupled(
        fluid, made.grains, made.scales, hydraulic_ratio=1.0, contact_steps=4, acceleration=(0.0, 0.0), lubrication=True
    )
    coupled.advance()
    assert bool(coupled.lubrication.force.any()) is acts


def test_films_slow_an_approach():
    speeds = []
    for on in (True, False):
        coupled = lubricated(on)
        for _ in range(15):
            coupled.advance()
        d = coupled.grains.discs
        speeds.append(d.velocity[0, 0] - d.velocity[1, 0])
    assert 0 < speeds[0] < 0.9 * speeds[1]


PLACES = np.array([[4.1, 8.4], [10.2, 10.9], [7.3, 15.2], [37.5, 8.1], [30.8, 6.2]])
"""Three that nearly touch, of which the first also meets the fourth across a periodic side, and one beside that."""
RADIUS = 3.3, 3.3, 2.0, 3.3, 3.5


def covered(body, *, periodic=True, many=1, dtype=np.float64, rim=False):
    """Solid fractions of each disc, (n, cells of its patch), and of all, with the given bodies of the discs."""
    sides = Sides(*["periodic"] * 4) if periodic else Sides(left="wall", right="wall", bottom="wall", top="wall")
    fluid = Fluid(40, 20 * many, 0.8, dtype=dtype, sides=sides)
    places = np.concatenate([PLACES + np.array([0, 20 * k]) for k in range(many)])
    cells = SaturatedCells(fluid, np.tile(RADIUS, many), soft_rim=rim)
    cells.body = None if body is None else np.concatenate([np.array(body) + 5 * k for k in range(many)])
    still = np.zeros_like(places)
    cells.cover(places, still, still[:, 0])
    it = cells._patches
    each = [it.fraction[a : a + h * w].copy() for a, h, w in zip(it.start, it.height, it.stride, strict=True)]
    return each, cells.solid.copy(), cells


def in_box(cells, each):
    """Fraction of every disc in every cell of the box, (n, ny, nx): element by element."""
    it, (ny, nx) = cells._patches, cells._shape
    found = np.zeros((len(each), ny, nx))
    for n, fraction in enumerate(each):
        x, y = it.corner[n]
        for j in range(it.height[n]):
            for i in range(it.stride[n]):
                inside = 0 <= x + i < nx and 0 <= y + j < ny
                if fraction[j * it.stride[n] + i] and (inside or cells.periodic_x):
                    found[n, (y + j) % ny, (x + i) % nx] += fraction[j * it.stride[n] + i]
    return found


@pytest.mark.parametrize("periodic", [True, False])
@pytest.mark.parametrize("body", [[0, 1, 2, 3, 4], [0, 0, 2, 3, 4]])
def test_shared_cells_are_scaled_to_the_most_and_others_left(body, periodic):
    before, _, cells = covered(None, periodic=periodic)
    plain = in_box(cells, before)
    after, solid, cells = covered(body, periodic=periodic)
    found, total = in_box(cells, after), plain.sum(axis=0)
    owners = np.zeros(total.shape, int)
    for one in set(body):
        owners += plain[[k for k, b in enumerate(body) if b == one]].any(axis=0)
    shared = (owners > 1) & (total > MOST)
    expected = plain * np.where(shared, MOST / np.where(shared, total, 1), 1)
    assert np.count_nonzero(shared) >= (3 if body[1] else 1)
    np.testing.assert_allclose(found, expected, rtol=4 * np.finfo(float).eps)
    np.testing.assert_allclose(solid, expected.sum(axis=0), rtol=8 * np.finfo(float).eps)


def test_across_a_periodic_side_too():
    before, _, cells = covered(None)
    after = covered(range(5))[0]
    changed = [not np.array_equal(a, b) for a, b in zip(after, before, strict=True)]
    assert changed[3]
    assert not np.array_equal(in_box(cells, after)[0, :, :7], in_box(cells, before)[0, :, :7])
    one, walls = [covered(body, periodic=False)[0][0] for body in (None, [0, 0, 0, 3, 4])]
    assert np.array_equal(one, walls)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_the_same_bits_by_one_thread_and_by_several(dtype):
    """Few bodies are one thread's; forty times as many are not, in bands that begin elsewhere."""
    one, _, _ = covered(range(5), dtype=dtype)
    many, _, cells = covered(range(5), many=200, dtype=dtype)
    assert len(cells._patches.fraction) > 8192 * 8
    inner = slice(5, len(many) - 5)  # the first and the last meet others across the side above and below
    for k, fraction in enumerate(many[inner]):
        # places hundreds of cells up are rounded by as many eps, of rims of slope 1
        np.testing.assert_allclose(fraction, one[k % 5], atol=4000 * 2 * np.finfo(dtype).eps)


def test_bare_outlines_are_as_given():
    _, _, cells = covered(range(5))
    still = np.zeros_like(PLACES)
    cells.cover(PLACES, still, still[:, 0], bare=True)
    area = cells.solid.sum()
    assert area == pytest.approx(np.pi * np.sum(np.square(RADIUS)), rel=1e-12)


def test_a_disc_and_its_image_share_cells_with_clumps_beside_them_or_without():
    found = []
    for body in (None, [0, 1, 2], [0, 1, 1]):
        cells = SaturatedCells(Fluid(7, 24, 0.8, sides=Sides(*["periodic"] * 4)), [3.5, 2.0, 2.0])
        cells.body = None if body is None else np.array(body)
        places = np.array([[3.7, 4.1], [3.0, 14.0], [4.5, 15.5]])
        cells.cover(places, np.zeros((3, 2)), np.zeros(3))
        found.append(cells._patches.fraction[: cells._patches.start[1]].copy())
    assert np.array_equal(found[1], found[2])
    assert not np.array_equal(found[0], found[1])
