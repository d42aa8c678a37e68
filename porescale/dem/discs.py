"""Discs: the state of rigid round grains in two dimensions, one array per quantity.

Mass and moment of inertia are those of a homogeneous cylinder per metre of depth, m = pi r^2 rho and I = m
r^2/2. Velocity and spin are held at half steps (integrate.py); position and angle at whole steps.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats

FIELDS = (
    "position", "angle", "velocity", "spin", "radius", "mass", "inertia", "force", "torque",
)  # fmt: skip
"""Names of the arrays of :class:`Discs`, in the order in which they are written."""


@dataclass(eq=False)
class Discs:
    """n discs; every array is C-contiguous float64 and is written in place by the kernels."""

    position: Floats  # (n, 2) m
    angle: Floats  # (n,)  rad, counter-clockwise
    velocity: Floats  # (n, 2) m/s, at half steps
    spin: Floats  # (n,)  rad/s, at half steps
    radius: Floats  # (n,)  m
    mass: Floats  # (n,)  kg/m
    inertia: Floats  # (n,)  kg m^2/m
    force: Floats  # (n, 2) N/m, of the last contact step, external force included
    torque: Floats  # (n,)  N m/m, likewise

    @property
    def count(self) -> int:
        """Number of discs of the system."""
        return len(self.radius)

    @property
    def area(self) -> Floats:
        """Area of each disc, (n,) m^2."""
        return np.pi * self.radius**2

    def state(self) -> dict[str, Floats]:
        """Copies of all arrays, by the names in FIELDS."""
        return {name: getattr(self, name).copy() for name in FIELDS}

    def restore(self, state: dict[str, Floats]) -> None:
        """Overwrite all arrays in place, bit for bit; raises InputError when the number of discs differs."""
        overwrite({name: getattr(self, name) for name in FIELDS}, state)


def overwrite(arrays: Mapping[str, NDArray[Any]], state: Mapping[str, Any], place: str = "state") -> None:
    """Overwrite ``arrays`` in place with those of ``state`` by their names, bit for bit.

    Raises InputError, naming the first of another shape after its ``place``.
    """
    for name, own in arrays.items():
        given = np.asarray(state[name])
        if given.shape != own.shape:
            raise InputError(Fault(f"{place}.{name}", given.shape, "wrong shape", allowed=str(own.shape)))
        own[...] = given


def make_discs(
    position: ArrayLike,
    radius: ArrayLike,
    density: ArrayLike,
    velocity: ArrayLike = 0.0,
    spin: ArrayLike = 0.0,
    angle: ArrayLike = 0.0,
) -> Discs:
    """Discs at ``position`` (n, 2) m with ``radius`` (n,) or a number, m, and ``density``, kg/m^3.

    ``velocity`` (n, 2) m/s, ``spin`` rad/s and ``angle`` rad are numbers or arrays.  Everything is copied.
    Raises InputError when a radius or density is not positive or a position is not finite.
    """
    place = np.array(position, dtype=np.float64).reshape(-1, 2)
    count = len(place)
    size = np.broadcast_to(np.asarray(radius, dtype=np.float64), (count,)).copy()
    heavy = np.broadcast_to(np.asarray(density, dtype=np.float64), (count,))
    faults = []
    if not np.all(np.isfinite(place)):
        faults.append(Fault("grains.position", problem="not finite", unit="m"))
    for key, values, unit in (("grains.radius", size, "m"), ("grains.density", heavy, "kg/m^3")):
        bad = np.flatnonzero(~(values > 0.0) | ~np.isfinite(values))
        if len(bad):
            faults.append(Fault(key, float(values[bad[0]]), f"of grain {bad[0]}", unit, "> 0"))
    if faults:
        raise InputError(faults)
    mass = np.pi * size**2 * heavy
    return Discs(
        position=place,
        angle=np.broadcast_to(np.asarray(angle, dtype=np.float64), (count,)).copy(),
        velocity=np.broadcast_to(np.asarray(velocity, dtype=np.float64), (count, 2)).copy(),
        spin=np.broadcast_to(np.asarray(spin, dtype=np.float64), (count,)).copy(),
        radius=size,
        mass=mass,
        inertia=0.5 * mass * size**2,
        force=np.zeros((count, 2)),
        torque=np.zeros(count),
    )
