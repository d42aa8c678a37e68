"""Saturated cells are those of the paper, cell by cell; coupled steps go on bit for bit and allocate nothing."""

import copy

import numba
import numpy as np
import pytest

from porescale.common.compiled.jit import set_threads
from porescale.coupling import psm_kernels as solid_collision
from porescale.coupling.psm import SaturatedCells
from porescale.coupling.solid.choose import choose_solid
from porescale.coupling.weighting.choose import choose_weight
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.collision.choose import third_order_rate
from porescale.lbm.fluid import Fluid
from porescale.validation.coupling import setups as lab
from tests.reference import memory
from tests.reference.coupling import psm as twin
from tests.reference.lbm import lbm as plain

EPS = np.finfo(float).eps

# As in test_lbm_in_place.py, with a collision twice as long: 120 eps a cell and step.  Coverage differs by round-off of
# areas of size r² = 16, cancelled to a fraction: 16 * 4 eps, times a slip velocity of 0.1: below the former.
ROUND_OFF = 120 * EPS


def wet_and_twin(kinds, discs, force=(2e-5, -1e-5), tau=0.7, operator="exact-wall", twin_operator=None, **switches):
    names = ("left", "right", "bottom", "top")
    fluid = Fluid(22, 18, tau, force=force, sides=Sides(*kinds))
    other = twin.SaturatedCells(
        22, 18, tau, force=force, sides={n: (k, 0.0) for n, k in zip(names, kinds, strict=True)},
        operator=twin_operator or operator, **switches,
    )  # fmt: skip
    random = np.random.default_rng(5)
    rho, ux, uy = 1 + 0.01 * random.uniform(-1, 1, (18, 22)), *(0.05 * random.uniform(-1, 1, (2, 18, 22)))
    fluid.set_flow(ux, uy, rho)
    other.f = plain.equilibrium(rho, ux, uy)
    wet = SaturatedCells(fluid, np.array([d.r for d in discs]), solid_operator=operator)
    return fluid, wet, other


def arrays(discs):
    return (
        np.array([(d.x, d.y) for d in discs]), np.array([(d.u, d.v) for d in discs]), np.array([d.w for d in discs]),
    )  # fmt: skip


def move(discs):
    for d in discs:
        d.x, d.y = d.x + d.u, d.y + d.v


def differences(kinds, discs, steps=6, **switches):
    """Largest difference of loads, torques and flow between kernels and twin, over moving discs."""
    fluid, wet, other = wet_and_twin(kinds, discs, **switches)
    worst = np.zeros(3)
    for _ in range(steps):
        wet.advance(fluid, *arrays(discs))
        force, torque = other.step_with(discs)
        move(discs)
        rho, jx, _ = other.moments()
        now, ux, _ = fluid.fields(np.ones_like(rho))  # no share of the force: first moments as they are
        worst = np.maximum(
            worst,
            [np.abs(wet.force - force).max(), np.abs(wet.torque - torque).max(), np.abs(now * ux - jx).max()],
        )
    return worst


def touching_discs():
    """Discs that touch, overlap, share cells, cross sides and spin; the last is smaller than a cell."""
    return [
        twin.Disc(6.3, 7.1, 3.4, 0.05, 0.02, 0.01), twin.Disc(13.05, 7.6, 3.36, -0.04, 0.03, -0.02),
        twin.Disc(9.7, 12.2, 2.5, 0.0, -0.06, 0.0), twin.Disc(20.9, 16.4, 2.2, 0.06, 0.05, 0.03),
        twin.Disc(17.3, 3.2, 0.4, 0.1, 0.0, 0.0),
    ]  # fmt: skip


SIDES = [
    ("periodic", "periodic", "periodic", "periodic"),
    ("wall", "wall", "wall", "wall"),
    ("periodic", "periodic", "wall", "slip"),
]


@pytest.mark.parametrize("operator", ["exact-wall", "odd-SC1"])
@pytest.mark.parametrize("kinds", SIDES)
def test_saturated_cells_are_those_of_the_formulas(kinds, operator):
    force, torque, flow = differences(kinds, touching_discs(), steps=6, operator=operator)
    # Loads sum some 40 cells with lever arms up to 3.4; errors of the flow pile up over the steps.
    assert flow < 6 * ROUND_OFF
    assert force < 40 * 6 * ROUND_OFF
    assert torque < 3.4 * 40 * 6 * ROUND_OFF


@pytest.mark.parametrize(
    "wrong",
    [
        {"operator": "odd-SC1", "twin_operator": "SC1"}, {"operator": "odd-SC1", "forcing": "outside"},
        {"operator": "odd-SC1", "sharing": "sum"}, {"low_pass": 0.0}, {"low_pass": 0.11}, {"radius_shift": 0.29},
        {"buoyant": False},
    ],
)  # fmt: skip
def test_another_operator_is_told_apart(wrong):
    assert differences(SIDES[0], touching_discs(), steps=2, **wrong).max() > 1e-7


def test_a_correction_that_is_forgotten_is_missed():
    def go(forget):
        fluid, wet, _ = wet_and_twin(SIDES[0], touching_discs())
        for step in range(8):
            if step == 5:
                again = SaturatedCells(fluid, wet.radius)
                if not forget:
                    again.restore(copy.deepcopy(wet.state()))
                wet = again
            wet.advance(fluid, *arrays(touching_discs()))
        return fluid.populations[:, 1:-1, 1:-1].copy(), wet.force.copy()

    fluid, wet, _ = wet_and_twin(SIDES[0], touching_discs())
    for _ in range(8):
        wet.advance(fluid, *arrays(touching_discs()))
    for whole, again in zip((fluid.populations[:, 1:-1, 1:-1], wet.force), go(False), strict=True):
        np.testing.assert_array_equal(whole, again)
    assert np.abs(go(True)[1] - wet.force).max() > 1e-7


PAIRS = [("exact-wall", "wall"), ("odd-SC1", "B2")]


def laws_of(operator, weighting, fluid):
    tau = fluid.relaxation_time
    return (
        choose_weight(weighting, tau, float),
        choose_solid(operator, tau, third_order_rate(fluid.law), float),
        fluid.law,
    )


@pytest.mark.parametrize(("operator", "weighting"), PAIRS)
def test_a_row_of_saturated_cells_is_the_same_uncompiled(operator, weighting):
    random = np.random.default_rng(2)
    fluid = Fluid(5, 1, 0.7, force=(1e-4, 2e-4))
    rows = 0.01 * random.uniform(-1, 1, (9, 5))
    s = np.array([0.0, 0.3, 1.0, 1.4, 0.999])
    sx, sy = s * 0.02, s * -0.03
    laws = laws_of(operator, weighting, fluid)
    made = []
    for run in (solid_collision.collide_saturated_row, solid_collision.collide_saturated_row.py_func):
        copies = [row.copy() for row in rows], s.copy(), sx.copy(), sy.copy(), np.zeros(5)
        run(tuple(copies[0]), tuple(copies[1:4]), copies[4], np.zeros((4, 5)), 0, 5, laws)
        made.append(np.array([*copies[0], *copies[1:]]))
    # the same operations but for fused multiply-adds: 30 roundings of numbers up to 1.4
    np.testing.assert_allclose(*made, rtol=0, atol=30 * 1.4 * EPS)


@pytest.mark.parametrize(("operator", "weighting"), PAIRS)
def test_an_empty_saturated_row_is_a_plain_one(operator, weighting):
    from porescale.lbm.collision.law import collide_row

    random = np.random.default_rng(2)
    fluid = Fluid(5, 1, 0.7, force=(1e-4, 2e-4))
    rows = 0.01 * random.uniform(-1, 1, (9, 5))
    wet, dry, none = [row.copy() for row in rows], [row.copy() for row in rows], np.zeros(5)
    solid = (none.copy(), none.copy(), none.copy()), none.copy()
    laws = laws_of(operator, weighting, fluid)
    solid_collision.collide_saturated_row(tuple(wet), *solid, np.zeros((4, 5)), 0, 5, laws)
    collide_row(tuple(dry), 0, 5, fluid.law)
    np.testing.assert_allclose(wet, dry, rtol=0, atol=30 * EPS)


def final(count, steps=60, restart=None):
    """Populations and discs of a handful on ``count`` threads, after a restart from its own state if wanted."""
    set_threads(count)
    coupled = lab.handful(sides=("wall", "wall"), acceleration=(1e-5, -5e-5), gate=True)
    for step in range(steps):
        if step == restart:
            kept = copy.deepcopy(coupled.state())
            coupled = lab.handful(sides=("wall", "wall"), acceleration=(1e-5, -5e-5), gate=True)
            coupled.restore(kept)
        if step == 30:
            coupled.fluid.plates[0].speed = 0.05
            coupled.grains.move_plate(lab.GATE, 0.05)
        coupled.advance()
        coupled.fluid.plates[0].lower_edge += coupled.fluid.plates[0].speed
    d = coupled.grains.discs
    inside = coupled.fluid.populations[:, 1:-1, 1:-1]
    return [part.copy() for part in (inside, d.position, d.velocity, d.spin, coupled.force, coupled.torque)]


def test_one_and_two_threads_give_the_same_bits():
    for one, two in zip(final(1), final(2), strict=True):
        np.testing.assert_array_equal(one, two)


@pytest.mark.parametrize("restart", [20, 21, 41])
def test_a_restored_run_goes_on_bit_for_bit(restart):
    for whole, again in zip(final(2), final(2, restart=restart), strict=True):
        np.testing.assert_array_equal(whole, again)


def test_another_step_has_other_bits():
    assert not np.array_equal(final(1)[0], final(1, steps=59)[0])


def test_reading_a_coupled_run_leaves_its_bits():
    def go(read):
        coupled = lab.handful(acceleration=(1e-5, -5e-5))
        for _ in range(15):
            coupled.advance()
            if read:
                coupled.fields()
                coupled.momentum()
        return coupled.fluid.populations[:, 1:-1, 1:-1], coupled.grains.discs.position

    for silent, read in zip(go(False), go(True), strict=True):
        np.testing.assert_array_equal(silent, read)


def many():
    """8192 discs that meet each other, walls and a gate in 512 x 1024 cells: a byte a disc is 8 kB, a number 64 kB."""
    x, y = np.meshgrid(np.arange(64), np.arange(128))
    place = 8.0 * np.stack((x, y), -1).reshape(-1, 2) + 4
    velocity = np.random.default_rng(4).uniform(-0.08, 0.08, place.shape)
    coupled = lab.immersed((512, 1024), place, 3.9, 2.0, velocity, 1e-3, acceleration=(0.0, -1e-6), gate=256)
    coupled.fluid.plates[0].speed = 0.05
    coupled.grains.move_plate(lab.GATE, 0.05)
    return coupled


def grown(coupled, step, steps=60):
    """Growth in each of ``steps`` steps, and which of them rebuilt the list of pairs or made its buffers grow; the
    first four go unmeasured."""
    sizes, rebuilt, pairs = [], [], coupled.grains.pairs
    for _ in range(4):
        step()
    with memory.traced():
        for _ in range(steps):
            before = pairs.builds, pairs._bounds.size
            sizes.append(memory.grown(step))
            rebuilt.append((pairs.builds, pairs._bounds.size) != before)
    return np.array(sizes), np.array(rebuilt)


def test_a_step_allocates_no_array_but_for_a_rebuild():
    coupled = many()
    sizes, rebuilt = grown(coupled, coupled.advance)
    grains = coupled.grains
    assert np.count_nonzero(grains.pairs.carried) > 20
    assert grains.plate_spring.any()
    assert grains.wall_spring.any()
    assert rebuilt.any()
    # What Python itself needs for its calls (5 kB of tuples and numbers, at any size) stays below a byte a disc.
    assert sizes[~rebuilt].max() < 8192


def test_an_array_in_a_step_would_be_noticed():
    coupled = many()

    def step():
        coupled.advance()
        np.isfinite(coupled.grains.discs.spin)

    sizes, rebuilt = grown(coupled, step, steps=10)
    assert sizes[~rebuilt].min() > 8192


def allocates(kernel):
    """Whether a kernel makes an array of its own: numba's allocator appears in its code.

    Compiled anew, since code from the disk cache cannot be inspected, and serially, since a loop over threads asks for
    its schedule there.
    """
    fresh = numba.njit(error_model="numpy")(kernel.py_func)
    fresh.compile(kernel.signatures[0])
    return any("NRT_MemInfo_alloc" in text for text in fresh.inspect_llvm().values())


def test_no_kernel_of_a_step_allocates():
    from porescale.coupling import immersed, load
    from porescale.coupling.coverage import discs as coverage
    from porescale.coupling.coverage import rows as coverage_rows
    from porescale.dem import step as integrate
    from porescale.lbm import stream
    from porescale.lbm.boundary import links
    from porescale.lbm.boundary import thin_plate as plate

    coupled = lab.handful(sides=("wall", "wall"), gate=True)
    for _ in range(2):
        coupled.advance()
        coupled.fluid.advance()
        coupled.fluid.advance()
        coupled.advance()
    used = [
        coverage.cover, coverage_rows.list_bands, load.add_rows, load.half_step_correction, immersed.to_lattice,
        immersed.total_load, links.pass_on, solid_collision.sweep,
        stream.sweep, plate.exchange, integrate.contact_steps,
    ]  # fmt: skip
    assert [kernel.__name__ for kernel in used if allocates(kernel)] == []


def test_a_kernel_that_allocates_is_found():
    from porescale.common.compiled.jit import kernel

    @kernel
    def wasteful(x):
        return np.zeros(x.shape[0]).sum()

    wasteful(np.zeros(3))
    assert allocates(wasteful)
