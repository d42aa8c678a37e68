"""Water among grains: the passes over both layers are what their derivation says."""

import numpy as np
import pytest

from continuum_sph.seepage import Frame, Resistance, exchange, mixture
from continuum_sph.seepage import overlap as overlaps
from continuum_sph.seepage.exchange import apply_drag, apply_reaction, relative_to_soil, relaxation
from continuum_sph.seepage.mixture import (
    DENSITY,
    GROUND,
    LINES,
    MASSES,
    POROSITY,
    PULL_X,
    RESISTING,
    SLIP_X,
    SLIP_Y,
    SOIL,
    WEIGHT,
    gather_soil,
    load_soil,
    mix_fluxes,
    open_gradients,
    share_forces,
)
from continuum_sph.seepage.overlap import Overlap, Reach, overlap_kernel, overlap_weights
from continuum_sph.seepage.pressure_face import prescribe_pressure
from continuum_sph.seepage.resistance import drag, sharpened
from continuum_sph.seepage.skeleton import show_soil, weigh
from continuum_sph.water.bundles import Neighbours
from continuum_sph.water.kernel_correction import lattice_gradient
from continuum_sph.water.smoothing import CUBIC, WENDLAND, kernel_slope, kernel_value
from continuum_sph.water.state import COMPRESSIBILITY, RHO, VOLUME, VX, VY, P, X, Y
from porescale.common.compiled.simd import LANES
from tests.reference.continuum import seepage as slow

eps = np.finfo(float).eps
H, GRAVITY, POROUS = 0.13, 9.81, 0.4
PERIOD = np.array([1.0, 1.0])


@pytest.fixture(scope="module", autouse=True)
def plain():
    """Compiled functions take vectors only from kernels: here they are plain."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(overlaps, "kernel_value", kernel_value.py_func)
        patch.setattr(overlaps, "overlap_kernel", overlap_kernel.py_func)
        patch.setattr(mixture, "overlap_kernel", overlap_kernel.py_func)
        patch.setattr(exchange, "relaxation", relaxation.py_func)
        patch.setattr(exchange, "drag", drag.py_func)
        patch.setattr(exchange, "sharpened", sharpened.py_func)
        yield


@pytest.fixture(scope="module")
def place(plain):
    """A periodic box of 10 by 10 water and soil particles, disordered, with velocities and pressures."""
    rng = np.random.default_rng(3)
    i, j = np.meshgrid(np.arange(10), np.arange(10))
    lattice = (np.column_stack((i.ravel(), j.ravel())) + 0.5) * 0.1
    x, soil_x = (lattice + rng.uniform(-0.02, 0.02, lattice.shape) for _ in range(2))
    n = len(x)
    overlap = Overlap(n, n, H, 0.02, (0.0, 0.0), (1.0, 1.0), (True, True))
    overlap.pairs.update(np.concatenate((x, soil_x)), overlap.reach)
    pairs = overlap.pairs
    weight = np.zeros(len(pairs.partner) + LANES)
    overlap_weights.py_func(pairs.start, pairs.partner, np.concatenate((x, soil_x)), weight, H, 1.0, 1.0)
    values = {name: rng.normal(size=(n, 2)) for name in ("v", "soil_v", "a", "soil_a")}
    rho = 1000.0 + rng.normal(size=n)
    inside = rng.uniform(0.5, 0.7, n)  # share of grains by the soil's own density, whatever its neighbours are
    rest = {
        "inside": inside,
        "mass": np.full(n, 4.0),
        "soil_mass": np.full(n, 15.9),
        "grains": np.full(n, 6e-3),
        "rho": rho,
    }
    return (
        {"x": x, "soil_x": soil_x, "rows": (pairs.start, pairs.partner, weight), "p": rng.normal(size=n)}
        | values
        | rest
    )


def anew(place):
    """The overlap with weights that are still to be made."""
    start, partner, weight = place["rows"]
    return start, partner, np.full_like(weight, np.nan)


def blended(place, k=1e-3):
    """Record and pores after `gather_soil` and `mix_fluxes`, which make the water's weights."""
    n, rows, shown = len(place["x"]), anew(place), np.zeros((len(place["soil_x"]), 8))
    grains = place["grains"]
    show_soil.py_func(
        place["soil_x"], place["soil_v"], place["soil_mass"], 2650.0 * place["inside"], 2650.0, grains, grains / k,
        shown,
    )  # fmt: skip
    record = np.zeros((n, 8))
    record[:, [X, Y]], record[:, [VX, VY]] = place["x"], place["v"]
    record[:, RHO], record[:, P], record[:, VOLUME] = place["rho"], place["p"], place["mass"] / place["rho"]
    pores, none = np.ones((LINES, n + LANES)), np.zeros(n + 1, np.int64)
    gather_soil.py_func(
        n, *rows, record, place["mass"], shown, Resistance(POROUS).gravity, np.zeros(0), pores, Reach(H, 1.0, 1.0)
    )  # fmt: skip
    mix_fluxes.py_func(n, none, none[:n], np.zeros(0, np.int32), record, place["x"], pores, H, 1.0, 1.0)
    np.testing.assert_array_equal(rows[2][: rows[0][n]], place["rows"][2][: rows[0][n]])
    return record, pores


def test_porosity_flux_and_shared_forces_are_those_of_the_dense_sums(place):
    n = len(place["x"])
    psi = slow.shares(place["x"], place["soil_x"], place["grains"], H, PERIOD)
    porosity, rate, acceleration, force = slow.mixture(
        place["x"], place["v"], place["mass"], place["rho"], place["p"], place["soil_v"], psi, H, PERIOD
    )
    record, pores = blended(place)
    # sums of some 25 terms of one sign
    np.testing.assert_allclose(pores[POROSITY, :n], porosity, rtol=30 * eps)
    q = porosity[:, None] * place["v"] + psi @ place["soil_v"]
    np.testing.assert_allclose(record[:, [VX, VY]], q, atol=100 * eps)
    np.testing.assert_allclose(record[:, VOLUME], place["mass"] / (porosity * place["rho"]), rtol=50 * eps)
    # continuity of one fluid, as `rates` leaves it, is n times the rate
    given, power = porosity * rate, np.ones((n, 6))
    thrust, found, rows = np.zeros((n, 4)), np.zeros((n, 2)), anew(place)
    thrust[:, :2] = place["x"]
    falling = acceleration + np.array([0.0, -GRAVITY])
    share_forces.py_func(n, place["mass"], falling, 0.0, -GRAVITY, pores, given, power, thrust)
    load_soil.py_func(n, *rows, place["soil_x"], place["grains"], thrust, found, H, 1.0, 1.0)
    first, last = rows[0][n], rows[0][-1]
    np.testing.assert_array_equal(rows[2][first:last], place["rows"][2][first:last])
    np.testing.assert_allclose(given, rate, rtol=10 * eps)
    np.testing.assert_allclose(power[:, :4], 1.0 / porosity[:, None] * np.ones(4), rtol=10 * eps)
    np.testing.assert_array_equal(power[:, 4:], 1.0)
    # gravity is added and taken off again: eps g over accelerations of size 1
    np.testing.assert_allclose(found, force, atol=np.abs(force).max() * 1000 * eps)
    # work: what continuity gives to the water's energy the forces take from both layers' motion
    gained = (place["mass"] * place["p"] / place["rho"] ** 2 * rate).sum()
    lost = (place["mass"][:, None] * acceleration * place["v"]).sum() + (force * place["soil_v"]).sum()
    scale = np.abs(place["mass"][:, None] * acceleration * place["v"]).sum()
    assert abs(gained + lost) < 200 * eps * scale
    assert np.abs((place["mass"][:, None] * acceleration).sum(axis=0) + force.sum(axis=0)).max() < 200 * eps * scale


def braked(place, seconds, pores):
    """Velocities of both layers after `seconds` of drag, and the heat of it."""
    n, k = len(place["x"]), 1e-3
    v, soil_v, push, borne = place["v"].copy(), place["soil_v"].copy(), np.zeros((n, 2)), np.zeros((n, 2))
    heat, law, resisting, shown = np.zeros(2 * n), Resistance(POROUS), place["grains"] / k, np.zeros((n, 2))
    weigh.py_func(resisting, soil_v, shown)
    slip = pores[[SLIP_X, SLIP_Y]].copy()
    relative_to_soil.py_func(n, *place["rows"], shown, v, pores, SLIP_X)
    # `gather_soil` has them from velocities weighted in another order: a few roundings of sums of 25 terms
    np.testing.assert_allclose(pores[[SLIP_X, SLIP_Y], :n], slip[:, :n], atol=100 * eps)
    weigh.py_func(resisting, place["soil_a"], shown)
    relative_to_soil.py_func(n, *place["rows"], shown, place["a"], pores, PULL_X)
    apply_drag.py_func(n, pores, v, law.number, law.factor, law.share, seconds, np.zeros((4, n + LANES)), push, heat)
    apply_reaction.py_func(n, *place["rows"], push, resisting, place["soil_mass"], soil_v, seconds, borne, heat)
    return v, soil_v, heat.sum(), borne


@pytest.mark.parametrize("seconds", [1e-6, 1e-3, 10.0])
def test_drag_is_exact_in_time_and_opposite_whatever_the_step(place, seconds):
    _, pores = blended(place)
    v, soil_v, heat, borne = braked(place, seconds, pores)
    psi = slow.shares(place["x"], place["soil_x"], place["grains"], H, PERIOD)
    exact_v, exact_soil_v = slow.drag(
        place["v"], place["a"], place["mass"], place["rho"], pores[POROSITY, : len(v)], place["soil_v"],
        place["soil_a"], place["soil_mass"], psi, place["grains"], place["inside"], 1e-3, POROUS,
        Resistance(POROUS).gravity, seconds,
    )  # fmt: skip
    largest = np.abs(exact_v).max() + seconds
    np.testing.assert_allclose(v, exact_v, atol=1e4 * eps * largest)
    np.testing.assert_allclose(soil_v, exact_soil_v, atol=1e4 * eps * largest)
    m, s = place["mass"][:, None], place["soil_mass"][:, None]
    given = (m * (v - place["v"])).sum(axis=0) + (s * (soil_v - place["soil_v"])).sum(axis=0)
    assert np.abs(given).max() < 1e3 * eps * np.abs(m * place["v"]).sum() * (1.0 + seconds)
    # first law: kinetic energy with the other forces' kicks is what these gave, less the heat
    before = 0.5 * ((m * place["v"] ** 2).sum() + (s * place["soil_v"] ** 2).sum())
    end, soil_end = v + seconds * place["a"], soil_v + seconds * place["soil_a"]
    after = 0.5 * ((m * end**2).sum() + (s * soil_end**2).sum())
    work = 0.5 * seconds * ((m * place["a"] * (place["v"] + end)).sum()
                            + (s * place["soil_a"] * (place["soil_v"] + soil_end)).sum())  # fmt: skip
    assert abs(after - before - work + heat) < 1e4 * eps * (after + before)
    np.testing.assert_allclose(borne.sum(axis=0), -(m * (v - place["v"])).sum(axis=0) / seconds, rtol=1e-9)


def test_drag_that_is_not_given_to_the_soil_loses_momentum(place):  # the twin that must fail
    _, pores = blended(place)
    v, _, _, _ = braked(place, 1e-3, pores)
    assert np.abs((place["mass"][:, None] * (v - place["v"])).sum(axis=0)).max() > 1.0


def rows_over_ground(ratio, rows=12):
    """χ of rows of water that go on above ground of as many rows of a square lattice, the lowest first."""
    h, wide = ratio, np.arange(-6, 7)
    height = np.arange(rows) + 0.5
    return np.array(
        [
            sum(kernel_value.py_func(CUBIC, np.hypot(along, y - soil) / h, h) for along in wide for soil in height)
            for y in np.arange(0.5, rows + 2)
        ]
    )


@pytest.mark.parametrize("ratio", [1.0, 1.3, 2.0])
def test_the_surface_of_ground_resists_what_crosses_it_as_much_as_it_should(ratio):
    rows = 12
    chi = rows_over_ground(ratio, rows)[rows // 2 :]  # from the middle of the ground
    resists = np.array([it * sharpened.py_func(it) for it in chi[chi > 0.0]])
    # Sums of the cubic spline over a square lattice are 1 to 0.0039 at 1 spacing, 0.0011 at 1.3: so is each row.
    assert resists.sum() == pytest.approx(rows / 2, abs=rows / 2 * 0.004)
    # One that is not antisymmetric, the twin that must fail: what is left of χ where it is more than 0.8.
    assert abs(chi[chi > 0.8].sum() - rows / 2) > 0.1


def test_water_over_ground_is_not_held_by_it():
    above = rows_over_ground(1.3)[12:]
    assert above[1] > 0.009  # its second row: by this share of n g/k = 3900 1/s, at 1 mm/s, it would be held
    assert sharpened.py_func(above[1]) == 0.0
    assert above[0] * sharpened.py_func(above[0]) < 0.07  # the first, half a spacing over the surface


def test_drag_is_whole_inside_and_half_at_a_surface():
    assert sharpened.py_func(1.0) == 1.0
    assert 0.5 * sharpened.py_func(0.5) == pytest.approx(0.5)
    assert sharpened.py_func(0.19) == 0.0
    assert 0.9 * sharpened.py_func(0.9) == pytest.approx(1.0)  # what neighbours are not there is made up for


def test_relaxation_is_exact_for_the_shortest_and_the_longest_times():
    times = np.concatenate((10.0 ** np.linspace(-300.0, 4.0, 2000), np.linspace(0.0, 60.0, 2001)))
    # 12 terms with two roundings each, all but the first few scaled down by y <= 0.69, and two for each doubling
    np.testing.assert_allclose(relaxation.py_func(times), -np.expm1(-times), rtol=16 * eps)
    half = 1.0 - np.sqrt(1.0 - relaxation.py_func(times[-2000:-1800]))  # of half the time: the twin that must fail
    assert np.abs(half + np.expm1(-times[-2000:-1800])).max() > 0.1


@pytest.mark.parametrize(("law", "share"), [("constant", 1.0), ("kozeny-carman", 1.0), ("kozeny-carman", 0.64)])
def test_resistance_is_that_of_the_permeability_at_hand(law, share):
    given = Resistance(POROUS, law, share=share)
    for porosity in (0.35, 0.4, 0.5):
        k = given.permeability(1e-4, porosity)
        beta = drag.py_func(given.number, porosity, (1.0 - porosity) / 1e-4, 1000.0 * GRAVITY, given.factor, share)
        assert beta == pytest.approx(porosity**2 * 1000.0 * GRAVITY / k, rel=1e-14)
    assert given.permeability(1e-4, POROUS) == pytest.approx(1e-4, rel=1e-14)
    # Kozeny 1927: k as n³/(1 - n)²
    ratio = Resistance(POROUS, "kozeny-carman").permeability(1.0, 0.5)
    assert ratio == pytest.approx((0.5**3 / 0.25) / (0.4**3 / 0.36), rel=1e-14)
    ratio = Resistance(POROUS, "kozeny-carman", share=0.5).permeability(1.0, 0.5)  # pores of 0.75 and 0.7
    assert ratio == pytest.approx((0.75**3 / 0.25) / (0.7**3 / 0.36), rel=1e-14)


@pytest.mark.parametrize("law", ["constant", "kozeny-carman"])
def test_drag_is_finite_where_grains_only_just_reach_the_water(law):
    """So little of them that n rounds to 1, as before a surface of the soil."""
    pores, given = np.ones((LINES, 1 + LANES)), Resistance(POROUS, law)
    pores[DENSITY], pores[WEIGHT], pores[MASSES], pores[RESISTING] = 1000.0, 1000.0 * GRAVITY, 1e-14, 1e-15
    pores[SOIL] = 1e-17
    v, push, heat = np.zeros((1, 2)), np.zeros((1, 2)), np.zeros(1)
    apply_drag.py_func(1, pores, v, given.number, given.factor, given.share, 1e-3, np.zeros((4, 1 + LANES)), push, heat)
    assert np.isfinite([*v[0], *push[0], heat[0]]).all()
    assert np.abs(v).max() < 1e-9  # hardly any drag


def test_a_drained_face_holds_a_linear_pressure():
    columns = np.array([[4, 5, 6]])
    x = np.array([[0.0, 0.05], [0.1, 0.05], [0.0, 0.15], [0.1, 0.15], [0.05, -0.05], [0.05, -0.15], [0.05, -0.25]])
    record = np.zeros((7, 8))
    record[:, [X, Y]] = x
    record[:4, P], record[:4, VY] = 300.0 + 50.0 * x[:4, 1], 0.2
    pressure = np.zeros(7)
    start, split = np.array([0, 0, 0, 0, 0, 4, 8, 8]), np.array([0, 0, 0, 0, 4, 8, 8])
    partner = np.array([0, 1, 2, 3, 0, 1, 2, 3], np.int32)
    near = Neighbours(start, split, partner, None, None, WENDLAND, H)
    given = np.full((1, 3), 300.0)
    prescribe_pressure.py_func(columns, given, x.copy(), near, x, record, pressure, 0.0, 0.0, 0.0, 1.0)
    np.testing.assert_allclose(pressure[4:6], 300.0 + 50.0 * x[4:6, 1], rtol=10 * eps)
    assert pressure[6] == 300.0  # no water near
    np.testing.assert_allclose(record[4:6, VY], 0.2, rtol=10 * eps)


def test_soil_that_is_held_has_no_speed_and_water_feels_it():
    frame = Frame(np.zeros((3, 2)), 0.01, POROUS, 1e-4)
    assert frame.skeleton.held
    assert frame.next_step == np.inf
    np.testing.assert_allclose(frame.skeleton.resisting, 0.6 * 0.01 / 1e-4)


@pytest.mark.parametrize(
    ("kind", "ratio", "known"), [(WENDLAND, 1.375, 1.0132), (WENDLAND, 2.0, 1.0008), (CUBIC, 1.0, 0.9871)]
)
def test_plain_sums_on_a_lattice_are_exact_once_multiplied(kind, ratio, known):
    # The sum over a lattice wider than the kernel, place by place: a linear field has the slope 1.
    at = 0.1 * np.arange(-5, 6)
    total = 0.0
    for x in at:
        for y in at:
            total -= 0.01 * x * x * kernel_slope(kind, float(np.hypot(x, y)) / (0.1 * ratio), 0.1 * ratio)
    factor = lattice_gradient(kind, 0.1 * ratio, 0.1)
    assert factor * total == pytest.approx(1.0, rel=100 * eps)
    assert factor == pytest.approx(known, abs=1e-4)  # and is what the pages say, to their digits


def test_gradients_are_corrected_among_grains_and_plain_in_the_open():
    # Four particles: in the open, on the edge of the ground, at half of what counts as ground, within it.
    grains = np.array([0.0, GROUND, 0.5 * GROUND, 0.6])
    pores, record = np.zeros((LINES, 4)), np.zeros((4, 8))
    pores[POROSITY], record[:, COMPRESSIBILITY] = 1.0 - grains, 2e-3
    matrix, density = np.tile([1.3, 0.2, 0.9, 2.0], (4, 1)), np.tile([7.0, -3.0], (4, 1))
    plain = 1.027
    open_gradients(4, pores, record, matrix, density, plain, 0.0, -GRAVITY)
    middle = [0.5 * (1.3 + plain), 0.1, 0.5 * (0.9 + plain), 2.0]
    expected = [[plain, 0.0, plain, 2.0], [1.3, 0.2, 0.9, 2.0], middle, [1.3, 0.2, 0.9, 2.0]]
    np.testing.assert_allclose(matrix, expected, rtol=4 * eps)
    rest = -2e-3 * GRAVITY
    expected = [[0.0, rest], [7.0, -3.0], [3.5, 0.5 * (rest - 3.0)], [7.0, -3.0]]
    np.testing.assert_allclose(density, expected, rtol=4 * eps)
