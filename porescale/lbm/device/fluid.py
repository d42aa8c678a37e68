"""The populations of a `Fluid` on a graphics device, and steps of them there.

The fluid of the CPU stays the owner of everything that is not a population: sides, plates, law, number of steps.  Its
populations are stale while the device steps; ``fetch`` brings them, and with them fields, checkpoint and pictures are
those of the CPU's code.  A state that was fetched goes on where one likes.
"""

from typing import Any

import numpy as np

from porescale.common.compiled.cuda import device_kernel, launch, require_device, to_device
from porescale.lbm.boundary.pressure import OpenLinks
from porescale.lbm.device import kernels
from porescale.lbm.fluid import Fluid

CELLS_IN_BLOCK = 256
LINKS_IN_BLOCK = 64


def lacking(fluid: Fluid) -> list[str]:
    """What the fluid has and the device does not, a few words each."""
    found = []
    if fluid.force_field is not None:
        found.append("a body force of every cell")
    found += [f"sides of kind {name}" for name, own in fluid.links.own.items() if not isinstance(own, OpenLinks)]
    return found


def bytes_needed(nx: int, ny: int, dtype: Any) -> int:
    """Device memory of a box of nx by ny cells: populations with their halo, and 24 bytes for each link of a side."""
    links = 6 * (nx + ny)
    return int(9 * (nx + 2) * (ny + 2) * np.dtype(dtype).itemsize + links * (16 + np.dtype(dtype).itemsize))


class DeviceFluid:
    """A fluid whose populations are stepped on the device.  ValueError where the device lacks what the fluid has.

    fluid : its populations are stale until ``fetch``;  populations (9, ny + 2, nx + 2): on the device.
    """

    def __init__(self, fluid: Fluid) -> None:
        if missing := lacking(fluid):
            raise ValueError(f"not on the device: {', '.join(missing)}")
        require_device()
        self.fluid = fluid
        self.law = fluid.law_of_sweep
        real = fluid.populations.dtype.type
        self._sweep, self._fill, self._empty, self._let_in, self._exchange = (
            device_kernel(function, type(self.law), real)
            for function in (
                kernels.sweep_cells,
                kernels.fill_links,
                kernels.empty_links,
                kernels.let_in_links,
                kernels.exchange_links,
            )
        )
        self._links = (to_device(fluid.links.halo), to_device(fluid.links.inner))
        self._plates: dict[int, tuple[Any, Any, Any]] = {}
        self._open = {id(own): _open_links(own, fluid.force) for own in fluid.links.own.values()}
        self.send()

    def send(self) -> None:
        """Take the state of the CPU's fluid, its populations included: at first, and after a restore."""
        self.populations = to_device(self.fluid.populations)
        self._flat = self.populations.reshape(self.fluid.populations.size)
        self.send_sides()

    def send_sides(self) -> None:
        """Take velocities and densities of the sides from the CPU's fluid, after a change of one."""
        self._added = to_device(self.fluid.links.added)
        for own in self.fluid.links.own.values():
            self._open[id(own)]["excess"] = to_device(own.excess)  # type: ignore[attr-defined]

    def fetch(self) -> Fluid:
        """Bring the populations to the CPU's fluid, and return it."""
        self.populations.copy_to_host(self.fluid.populations)
        return self.fluid

    def advance(self) -> None:
        """One step, as ``Fluid.advance`` without extra arguments."""
        fluid = self.fluid
        odd = fluid.step % 2
        if odd:
            self._bounce_off_plates(+1.0)
        launch(self._sweep, fluid.nx * fluid.ny, CELLS_IN_BLOCK, self.populations, odd, self.law)
        if odd:
            self._bounce_off_plates(-1.0)
        settle = self._empty if odd else self._fill
        launch(settle, fluid.links.halo.size, LINKS_IN_BLOCK, self._flat, *self._links, self._added)
        for links in self._open.values():
            slots, to = links["odd" if odd else "even"]
            values = (links["source"], links["along"], links["weight"], links["excess"], links["force"])
            launch(self._let_in, links["count"], LINKS_IN_BLOCK, self._flat, slots, to, *values)
        fluid.step += 1

    def _bounce_off_plates(self, sign: float) -> None:
        """Exchange the slots of all links that plates cut, as ``Fluid`` does."""
        for plate in self.fluid.plates:
            if id(plate) not in self._plates:
                self._plates[id(plate)] = (to_device(plate.first), to_device(plate.second), to_device(plate.pull))
            first, second, pull = self._plates[id(plate)]
            values = (first, second, pull, plate.links_from(), plate.signed_speed(sign))
            launch(self._exchange, plate.first.size, LINKS_IN_BLOCK, self._flat, *values)


def _open_links(own: Any, force: tuple[float, float]) -> dict[str, Any]:
    """The arrays of pressure sides on the device, with the uniform body force at each link."""
    every = np.empty_like(own.force)
    every[0], every[1] = force
    return {
        "count": own.source.size,
        "even": (to_device(own.even), to_device(own.halo)),
        "odd": (to_device(own.odd), to_device(own.inner)),
        "source": to_device(own.source),
        "along": to_device(own.along),
        "weight": to_device(own.weight),
        "force": to_device(every),
    }
