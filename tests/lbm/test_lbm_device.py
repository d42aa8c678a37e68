"""The fluid on a device beside the CPU's: the same bits, in numba's simulator and, with ``NUMBA_ENABLE_CUDASIM=0``,
on the GPU of the machine, since all run the same operations.

Each rounds after every operation, with ``fma`` where the code says so, and no sum runs over cells: the bound on the
difference is zero.
"""

import subprocess
import sys

import numpy as np
import pytest

from porescale.lbm.boundary.sides import Sides
from porescale.lbm.device.fluid import DeviceFluid, bytes_needed
from porescale.lbm.fluid import Fluid

FORCE = (2e-4, -1e-4)
BOXES = {
    "closed": Sides(),
    "periodic": Sides("periodic", "periodic", "periodic", "periodic"),
    "sides": Sides(
        left="velocity",
        right="pressure",
        bottom="slip",
        top="wall",
        left_velocity=(0.01, 0.0),
        right_density=1.002,
        top_speed=0.01,
    ),
}


def started(kind, sides, dtype=np.float64, operator="trt", force=FORCE, **more):
    """A fluid of a kind with a random flow."""
    fluid = kind(7, 6, 0.7, force=force, sides=sides, dtype=dtype, operator=operator, **more)
    random = np.random.default_rng(1)
    fluid.set_flow(*(0.05 * random.uniform(-1, 1, (2, 6, 7))), 1 + 0.01 * random.uniform(-1, 1, (6, 7)))
    return fluid


def gone(fluid, steps):
    """The fluid's populations after so many steps; a copy."""
    for _ in range(steps):
        fluid.advance()
    return fluid.state()["populations"].copy()


def both(*arguments, **more):
    """The same fluid on the CPU and on the device."""
    return started(Fluid, *arguments, **more), started(DeviceFluid, *arguments, **more)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("box", BOXES)
def test_device_and_cpu_give_the_same_bits(box, dtype):
    cpu, device = both(BOXES[box], dtype)
    expected = gone(cpu, 3)
    assert np.ptp(expected) > 0.01
    assert np.array_equal(gone(device, 3), expected)
    for ours, theirs in zip(device.fields(), cpu.fields(), strict=True):
        assert np.array_equal(ours, theirs)


@pytest.mark.parametrize(
    "more",
    [
        {"operator": "bgk"},
        {"operator": "mrt"},
        {"operator": "central"},
        {"smagorinsky": 0.1},
        {"force": (0.0, 0.0)},
    ],
)
def test_every_operator_is_the_cpus(more):
    cpu, device = both(Sides(), **more)
    assert np.array_equal(gone(device, 2), gone(cpu, 2))


def test_another_operator_gives_other_bits():
    """The check that must fail."""
    assert not np.array_equal(gone(started(DeviceFluid, Sides(), operator="mrt"), 2), gone(started(Fluid, Sides()), 2))


def test_a_rising_plate_cuts_the_same_links():
    cpu, device = both(Sides(left="wall", right="wall", bottom="slip", top="wall"))
    for fluid in (cpu, device):
        plate = fluid.add_plate(3)
        plate.lower_edge, plate.speed = 2.0, 0.01
    assert np.array_equal(gone(device, 4), gone(cpu, 4))


@pytest.mark.parametrize("first", [Fluid, DeviceFluid])
def test_a_run_goes_on_across_devices(first):
    """One step here and two there, so that the state changes hands at an odd step, is three steps on the CPU."""
    fluid, other = started(first, BOXES["sides"]), started(DeviceFluid if first is Fluid else Fluid, BOXES["sides"])
    gone(fluid, 1)
    other.restore(fluid.state())
    assert np.array_equal(gone(other, 2), gone(started(Fluid, BOXES["sides"]), 3))


def test_a_look_between_steps_changes_nothing():
    cpu, device = both(BOXES["sides"])
    gone(device, 1)
    device.fields()
    device.mass_excess()
    assert np.array_equal(gone(device, 1), gone(cpu, 2))


def test_a_side_that_changes_acts_on_the_device():
    cpu, device = both(BOXES["sides"])
    for fluid in (cpu, device):
        fluid.set_side_density("right", 1.01)
        fluid.set_side_velocity("left", (0.02, 0.0))
    assert np.array_equal(gone(device, 1), gone(cpu, 1))


def test_what_the_device_lacks_is_refused():
    fluid = started(DeviceFluid, Sides(), force=(0.0, 0.0))
    with pytest.raises(ValueError, match="no body force of every cell"):
        fluid.set_force_field(np.zeros((2, 6, 7)))
    with pytest.raises(ValueError, match="no other sweep"):
        fluid.advance(lambda *_: None)


@pytest.mark.parametrize("box", BOXES)
def test_no_link_reads_what_another_overwrites(box):
    """So that no order of threads can matter: slots of links, in each kind of step, and of plates."""
    links = Fluid(7, 6, 0.7, sides=BOXES[box]).links
    assert not set(links.halo) & set(links.inner)
    assert len(set(links.halo)) == len(set(links.inner)) == links.halo.size
    for own in links.own.values():
        assert not set(own.halo) & {*own.even.ravel(), *links.halo}
        assert not set(own.inner) & {*own.odd.ravel(), *links.inner}
        assert len(set(own.halo)) == len(set(own.inner)) == own.source.size > 0
    plate = Fluid(7, 6, 0.7, sides=Sides(left="wall", right="wall", bottom="slip", top="wall")).add_plate(3)
    assert len({*plate.first, *plate.second}) == 2 * plate.first.size


def test_memory_is_that_of_the_populations():
    """Nine numbers a cell; of a box of 12 000 cells a side the halo and the padding add 16 cells a row and two rows,
    0.15 %, the links 0.06 %, sums of 47 blocks of rows 0.61 %, a band of 32 rows of moments 0.09 %."""
    assert bytes_needed(12000, 12000, 4) == pytest.approx(9 * 4 * 12000**2, rel=9.2e-3)
    assert bytes_needed(12000, 12000, 4) > 9 * 4 * 12000**2


def test_a_fluid_on_the_cpu_imports_nothing_of_cuda():
    code = """
import sys
from porescale.lbm.fluid import Fluid
fluid = Fluid(4, 4, 0.7)
fluid.fields()
assert not [it for it in sys.modules if it.startswith("numba.cuda") or it == "porescale.common.compiled.cuda"]
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)
