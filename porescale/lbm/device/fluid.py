"""A `Fluid` whose populations are stepped on a graphics device.

Everything that is not a population stays as it is: sides, plates, law, number of steps.  Moments and totals are worked
out on the device (readings.py).  What reads the populations themselves (stress, the state of a checkpoint) fetches them
first and is the CPU's code, so a checkpoint holds nothing of a device and goes on where one likes.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.cuda import device_kernel, launch, require_device, synchronize, to_device
from porescale.lbm.boundary.pressure import OpenLinks
from porescale.lbm.boundary.thin_plate import Plate
from porescale.lbm.device.kernels import exchange_links, let_in_links, pass_on_links, sweep_cells
from porescale.lbm.device.readings import Readings, bytes_of_readings
from porescale.lbm.fluid import Fluid, Sweep
from porescale.lbm.lattice import row_length
from porescale.lbm.stream import sweep
from porescale.lbm.totals import Totals

CELLS_IN_BLOCK, LINKS_IN_BLOCK = 128, 64
"""Threads of a block: whole warps; of 64 to 512, 128 are the fastest for cells on an H100 (docs/develop/gpu.md)."""


@dataclass(frozen=True)
class DeviceSweep:
    """A sweep over the cells that runs on the device: ``step`` (padded populations there, parity, law of collision)."""

    step: Callable[[Any, int, Any], None]


class OpenSide(NamedTuple):
    """Arrays of `OpenLinks` on the device, in the order of let_in_links.  even, odd : slots, and where they go."""

    even: tuple[Any, Any]
    odd: tuple[Any, Any]
    source: Any
    along: Any
    weight: Any
    force: Any


class DeviceFluid(Fluid):
    """A fluid on the device; arguments, attributes and results of `Fluid`.  InputError where there is no device.

    populations : the CPU's copy, brought up to date by whatever reads it here; ``fetch`` before reading it otherwise.
    """

    on_device = True

    def __init__(self, *arguments: Any, **options: Any) -> None:
        require_device()
        super().__init__(*arguments, **options)
        self._there = to_device(self.padded)
        """Populations on the device."""
        self._fetched, self._sent = True, True
        self._readings = Readings(self.nx, self.ny, self.force, self.populations.dtype)
        self._links = (to_device(self.links.halo), to_device(self.links.inner))
        self._plates: dict[Plate, tuple[Any, Any, Any]] = {}
        self._open = {name: _open_side(own, self.force) for name, own in self.links.own.items()}
        self._added = to_device(self.links.added)
        self._excess = {name: to_device(_open_links(own).excess) for name, own in self.links.own.items()}

    def _send_sides(self) -> None:
        """Velocities and densities of the sides, as they are now."""
        self._added.copy_to_device(self.links.added)
        for name, own in self.links.own.items():
            self._excess[name].copy_to_device(_open_links(own).excess)

    def send(self) -> None:
        """Bring the device's populations up to date."""
        if not self._sent:
            self._there.copy_to_device(self.padded)
            self._sent = True

    def wait(self) -> None:
        """Wait until the device has done the steps that it was given."""
        synchronize()

    def fetch(self) -> None:
        """Bring the CPU's populations up to date."""
        if not self._fetched:
            self._there.copy_to_host(self.padded)
            self._fetched = True

    def advance(self, cells: Sweep | DeviceSweep = sweep, *extra: Any) -> None:
        """One step, as ``Fluid.advance``; ValueError with a sweep of the CPU other than that of plain fluid."""
        if cells is not sweep and not isinstance(cells, DeviceSweep):
            raise ValueError("a fluid on the device takes no other sweep of the CPU than that of plain fluid")
        self.send()
        self._fetched = False
        odd, law, flat = self.step % 2, self.law_of_sweep, self._there.reshape(self.padded.size)
        if odd:
            self._exchange(flat, +1.0)
        if isinstance(cells, DeviceSweep):
            cells.step(self._there, odd, law)
        else:
            launch(self._kernel(sweep_cells), self.nx * self.ny, CELLS_IN_BLOCK, self._there, self.nx, odd, law)
        if odd:
            self._exchange(flat, -1.0)
        halo, inner = self._links
        of, to = (halo, inner) if odd else (inner, halo)
        launch(self._kernel(pass_on_links), self.links.halo.size, LINKS_IN_BLOCK, flat, of, to, self._added)
        for name, side in self._open.items():
            slots, to = side.odd if odd else side.even
            values = (side.source, side.along, side.weight, self._excess[name], side.force)
            launch(self._kernel(let_in_links), side.source.size, LINKS_IN_BLOCK, flat, slots, to, *values)
        self.step += 1

    def _exchange(self, flat: Any, sign: float) -> None:
        """Exchange the slots of all links that plates cut, before an odd sweep (+1) and after it (-1)."""
        for plate in self.plates:
            values = (*self._links_of(plate), plate.links_from(), plate.signed_speed(sign))
            launch(self._kernel(exchange_links), plate.first.size, LINKS_IN_BLOCK, flat, *values)

    def _links_of(self, plate: Plate) -> tuple[Any, Any, Any]:
        """Slots and pull of the links of a plate, on the device."""
        if plate not in self._plates:
            self._plates[plate] = (to_device(plate.first), to_device(plate.second), to_device(plate.pull))
        return self._plates[plate]

    @contextmanager
    def _readable_there(self) -> Iterator[None]:
        """As ``readable``, of the populations on the device."""
        self.send()
        kept, flat = [], self._there.reshape(self.padded.size)
        if self.step % 2:
            for slots in (part for plate in self.plates for part in self._links_of(plate)[:2]):
                kept.append((slots, to_device(np.empty(slots.size, self.populations.dtype))))
                launch(self._readings.keep, slots.size, LINKS_IN_BLOCK, flat, *kept[-1])
            self._exchange(flat, +1.0)
        try:
            yield
        finally:
            for values in kept:
                launch(self._readings.put, values[0].size, LINKS_IN_BLOCK, flat, *values)

    def moments(self) -> tuple[NDArray[np.floating], NDArray[np.floating], NDArray[np.floating]]:
        """As ``Fluid.moments``; fetches these three."""
        with self._readable_there():
            return self._readings.moments(self._there, self.step % 2)

    def totals(self) -> Totals:
        """As ``Fluid.totals``; fetches sums of blocks of cells."""
        with self._readable_there():
            return self._readings.totals(self._there, self.step % 2)

    def _kernel(self, function: Any) -> Any:
        """A kernel for the law and precision of this fluid."""
        return device_kernel(function, type(self.law_of_sweep), self.populations.dtype.type)

    @contextmanager
    def readable(self) -> Iterator[None]:
        """As ``Fluid.readable``, with the CPU's populations up to date."""
        self.fetch()
        with super().readable():
            yield

    def set_flow(self, ux: Any, uy: Any, density: Any = 1.0) -> None:
        """As ``Fluid.set_flow``; the device has it with the next step."""
        super().set_flow(ux, uy, density)
        self._sent, self._fetched = False, True

    def set_force_field(self, force: NDArray[np.floating]) -> None:
        """ValueError: the device has no force of every cell."""
        raise ValueError("a fluid on the device has no body force of every cell")

    def set_side_velocity(self, side: str, velocity: Any) -> None:
        """As ``Fluid.set_side_velocity``; sent to the device at once."""
        super().set_side_velocity(side, velocity)
        self._send_sides()

    def set_side_density(self, side: str, density: float) -> None:
        """As ``Fluid.set_side_density``; sent to the device at once."""
        super().set_side_density(side, density)
        self._send_sides()

    def state(self) -> dict[str, Any]:
        """As ``Fluid.state``: a state of the CPU."""
        self.fetch()
        return super().state()

    def restore(self, state: dict[str, Any]) -> None:
        """Restore a state, wherever it comes from."""
        super().restore(state)
        self._sent, self._fetched = False, True
        self._send_sides()


def bytes_needed(nx: int, ny: int, real_bytes: int) -> int:
    """Device memory of a box of nx by ny cells: populations with halo, two slots and a number a link, readings."""
    links = 6 * (nx + ny) * (16 + real_bytes)
    return 9 * row_length(nx) * (ny + 2) * real_bytes + links + bytes_of_readings(nx, ny, real_bytes)


def _open_links(own: Any) -> OpenLinks:
    """The links of a kind of side that settles them itself; ValueError unless it is the pressure side."""
    if not isinstance(own, OpenLinks):
        raise ValueError(f"a fluid on the device has no sides of kind {type(own).__name__}")
    return own


def _open_side(own: Any, force: tuple[float, float]) -> OpenSide:
    """The arrays of pressure sides on the device, with the uniform body force at each link."""
    links = _open_links(own)
    every = np.empty_like(links.force)
    every[0], every[1] = force
    return OpenSide(
        (to_device(links.even), to_device(links.halo)), (to_device(links.odd), to_device(links.inner)),
        to_device(links.source), to_device(links.along), to_device(links.weight), to_device(every),
    )  # fmt: skip
