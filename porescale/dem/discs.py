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
from porescale.common.core.ranges import Range, numbers
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

    ``velocity`` (n, 2) m/s, ``spin`` rad/s and ``angle`` rad are numbers or arrays.  Everything is copied.  One pair of
    numbers is the position of one disc.  Raises InputError when an array has another shape, a number is not finite, or
    a radius or density is not positive.
    """
    place = numbers("grains.position", position, (-1, 2), Range("m"), "grain")
    count = len(place)
    read, faults = {}, []
    for key, given, shape, within in (
        ("radius", radius, (count,), Range("m", gt=0)),
        ("density", density, (count,), Range("kg/m^3", gt=0)),
        ("velocity", velocity, (count, 2), Range("m/s")),
        ("spin", spin, (count,), Range("rad/s")),
        ("angle", angle, (count,), Range("rad")),
    ):
        try:
            read[key] = numbers(f"grains.{key}", given, shape, within, "grain", spread=True)
        except InputError as error:
            faults += error.faults
    if faults:
        raise InputError(faults)
    size = read["radius"]
    mass = np.pi * size**2 * read["density"]
    return Discs(
        position=place,
        angle=read["angle"],
        velocity=read["velocity"],
        spin=read["spin"],
        radius=size,
        mass=mass,
        inertia=0.5 * mass * size**2,
        force=np.zeros((count, 2)),
        torque=np.zeros(count),
    )
