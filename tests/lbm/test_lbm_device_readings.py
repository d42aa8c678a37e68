"""What rows, checks and snapshots read of a fluid on a device, in numba's simulator: the CPU's bits, without the
populations."""

import numpy as np
import pytest

from porescale.lbm.boundary.sides import Sides
from porescale.lbm.device.fluid import DeviceFluid
from porescale.lbm.device.readings import BAND, bytes_of_readings
from porescale.lbm.fluid import Fluid
from porescale.lbm.totals import ROWS

WALLS = Sides("wall", "wall", "slip", "wall")


def started(kind, nx=5, ny=BAND + 3, dtype=np.float64, sides=None):
    """A fluid of a kind with a random flow; its last band is a short one."""
    fluid = kind(nx, ny, 0.7, force=(2e-4, -1e-4), sides=sides, dtype=dtype)
    random = np.random.default_rng(1)
    fluid.set_flow(*(0.05 * random.uniform(-1, 1, (2, ny, nx))), 1 + 0.01 * random.uniform(-1, 1, (ny, nx)))
    return fluid


@pytest.fixture
def no_populations(monkeypatch):
    """An error where populations are fetched."""

    def fetched(_):
        raise AssertionError("populations were fetched")

    monkeypatch.setattr(DeviceFluid, "fetch", fetched)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("steps", [0, 1])
@pytest.mark.usefixtures("no_populations")
def test_readings_are_the_cpus_to_the_bit(steps, dtype):
    cpu, device = started(Fluid, dtype=dtype), started(DeviceFluid, dtype=dtype)
    for fluid in (cpu, device):
        for _ in range(steps):
            fluid.advance()
    assert device.totals() == cpu.totals()
    for ours, theirs in zip(device.fields(), cpu.fields(), strict=True):
        assert ours.dtype == dtype
        assert np.array_equal(ours, theirs)


@pytest.mark.usefixtures("no_populations")
def test_a_box_of_two_blocks_is_summed_as_on_the_cpu():
    cpu, device = (started(kind, 2, ROWS + 3, np.float32) for kind in (Fluid, DeviceFluid))
    assert device.totals() == cpu.totals()


@pytest.mark.usefixtures("no_populations")
def test_a_checkpoint_fetches_populations():
    """The check that must fail."""
    with pytest.raises(AssertionError, match="populations were fetched"):
        started(DeviceFluid).state()


def test_a_reading_at_an_odd_step_leaves_what_plates_cut_as_it_was():
    cpu, device = (started(kind, 7, 6, sides=WALLS) for kind in (Fluid, DeviceFluid))
    for fluid in (cpu, device):
        plate = fluid.add_plate(3)
        plate.lower_edge, plate.speed = 2.0, 0.01
        fluid.advance()
    assert device.totals() == cpu.totals()
    assert np.array_equal(device.fields()[1], cpu.fields()[1])
    assert np.array_equal(device.state()["populations"], cpu.state()["populations"])
    device.plates.clear()
    assert device.totals() != cpu.totals()  # the check that must fail: the plate counts


def test_what_is_read_follows_a_flow_that_is_set_anew():
    device = started(DeviceFluid, 4, 3)
    device.advance()
    before = device.totals()
    device.set_flow(0.01, 0.0)
    assert device.totals() != before
    # Half the body force is in u; populations below 1 carry a rounding each.
    assert device.totals().fastest == pytest.approx(np.hypot(0.01 + 1e-4, 5e-5), abs=16 * np.finfo(float).eps)


def test_readings_take_a_hundredth_of_the_populations():
    """Seven float64 a column for 256 rows are 0.22 bytes a cell, 0.6 % of nine float32; bands are 32 rows of 12 000."""
    assert 0.006 < bytes_of_readings(12000, 12000, 4) / (36 * 12000**2) < 0.01
