"""The fluid on a device, in numba's simulator, beside the CPU's: the same bits, since both run the same operations.

The simulator rounds after every operation, as the CPU's code does without fused products, and no sum runs over cells:
the bound on the difference is zero.  On a device products may be fused: there the bound is FUSED of the manual's page.
"""

import subprocess
import sys

import numpy as np
import pytest

from porescale.common.compiled.cuda import simulate
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid

simulate()

from porescale.lbm.device.fluid import DeviceFluid, bytes_needed, lacking  # noqa: E402

FORCE = (2e-4, -1e-4)
BOXES = {
    "periodic": Sides(),
    "sides": Sides(left="velocity", right="pressure", bottom="slip", top="wall", left_velocity=(0.01, 0.0),
                   right_density=1.002, top_speed=0.01),
}


def started(sides, dtype=np.float64, operator="trt", force=FORCE, nx=7, ny=6, **more):
    """A fluid with a random flow."""
    fluid = Fluid(nx, ny, 0.7, force=force, sides=sides, dtype=dtype, operator=operator, **more)
    random = np.random.default_rng(1)
    fluid.set_flow(*(0.05 * random.uniform(-1, 1, (2, ny, nx))), 1 + 0.01 * random.uniform(-1, 1, (ny, nx)))
    return fluid


def gone(fluid, steps):
    """Populations after so many steps on the CPU."""
    for _ in range(steps):
        fluid.advance()
    return fluid.populations


def gone_on_device(fluid, steps):
    """Populations after so many steps on the device."""
    device = DeviceFluid(fluid)
    for _ in range(steps):
        device.advance()
    return device.fetch().populations


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("box", BOXES)
def test_device_and_cpu_give_the_same_bits(box, dtype):
    expected = gone(started(BOXES[box], dtype), 3)
    assert np.ptp(expected) > 0.01
    assert np.array_equal(gone_on_device(started(BOXES[box], dtype), 3), expected)


@pytest.mark.parametrize("more", [
    {"operator": "bgk"}, {"operator": "mrt"}, {"operator": "central"}, {"smagorinsky": 0.1}, {"force": (0.0, 0.0)},
])
def test_every_operator_is_the_cpus(more):
    expected = gone(started(Sides(), **more), 2)
    assert np.array_equal(gone_on_device(started(Sides(), **more), 2), expected)


def test_another_operator_gives_other_bits():
    """The check that must fail."""
    assert not np.array_equal(gone_on_device(started(Sides(), operator="mrt"), 2), gone(started(Sides()), 2))


def with_plate():
    fluid = started(Sides(left="wall", right="wall", bottom="slip", top="wall"))
    plate = fluid.add_plate(3)
    plate.lower_edge, plate.speed = 2.0, 0.01
    return fluid


def test_a_rising_plate_cuts_the_same_links():
    assert np.array_equal(gone_on_device(with_plate(), 4), gone(with_plate(), 4))


def test_a_run_goes_on_across_devices():
    """CPU, device and CPU again, at an odd step too, is the CPU alone."""
    fluid = started(BOXES["sides"])
    gone(fluid, 1)
    gone_on_device(fluid, 2)
    again = started(BOXES["sides"])
    again.restore(fluid.state())
    assert np.array_equal(gone(again, 2), gone(started(BOXES["sides"]), 5))


def test_a_side_that_changes_acts_on_the_device():
    cpu, other = started(BOXES["sides"]), DeviceFluid(started(BOXES["sides"]))
    for fluid in (cpu, other.fluid):
        fluid.set_side_density("right", 1.01)
        fluid.set_side_velocity("left", (0.02, 0.0))
    other.send_sides()
    for one in (cpu, other):
        one.advance()
    assert np.array_equal(other.fetch().populations, cpu.populations)


def test_what_the_device_lacks_is_refused():
    fluid = started(Sides(), force=(0.0, 0.0))
    fluid.set_force_field(np.zeros((2, 6, 7)))
    assert lacking(fluid) == ["a body force of every cell"]
    with pytest.raises(ValueError, match="not on the device: a body force of every cell"):
        DeviceFluid(fluid)


def test_memory_is_that_of_the_populations():
    """Nine numbers a cell; what the halo and links of a box of 12 000 cells a side add is below 0.1 %."""
    assert bytes_needed(12000, 12000, np.float32) == pytest.approx(9 * 4 * 12000**2, rel=1e-3)


def test_a_fluid_on_the_cpu_imports_nothing_of_cuda():
    code = """
import sys
from porescale.lbm.fluid import Fluid
fluid = Fluid(4, 4, 0.7)
fluid.fields()
assert not [it for it in sys.modules if it.startswith("numba.cuda") or it == "porescale.common.compiled.cuda"]
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)
