"""Numbers that are none in the state of a system of grains."""

import numpy as np

from porescale.common.compiled.jit import kernel
from porescale.common.core.errors import Unstable
from porescale.dem.state import State


@kernel
def first_without_number(position, velocity, spin, angle):
    """(disc, column) of the first disc with a position (column 0) that is not finite, or else a velocity (1), a spin
    (2), or an angle (3); (-1, -1) if all are.  position, velocity (n, 2) m, m/s;  spin, angle (n,) rad/s, rad.
    """
    for i in range(spin.shape[0]):
        if not (np.isfinite(position[i, 0]) and np.isfinite(position[i, 1])):
            return i, 0
    for i in range(spin.shape[0]):
        if not (np.isfinite(velocity[i, 0]) and np.isfinite(velocity[i, 1])):
            return i, 1
    for i in range(spin.shape[0]):
        if not np.isfinite(spin[i]):
            return i, 2
    for i in range(angle.shape[0]):
        if not np.isfinite(angle[i]):
            return i, 3
    return -1, -1


def unstable(grains: State, where: str, quantity: str, value: float, unit: str, cause: str) -> Unstable:
    """The error for a ``quantity`` of ``where`` in ``unit``, with step and time of ``grains``."""
    return Unstable(where, quantity, value, unit, grains.steps, grains.time, cause)


def check_finite(grains: State) -> None:
    """Raise Unstable at a position, velocity, spin or angle, or a place of a plate, that is no number."""
    d = grains.discs
    if np.isnan(grains.plates).any():
        nowhere = int(np.isnan(grains.plates).any(axis=1).argmax())
        raise unstable(
            grains, f"plate {grains.plate_names[nowhere]}", "place", float("nan"), "m", "a motion without numbers"
        )
    if grains.sleep is not None and not np.isfinite(grains.sleep.removed.sum()):
        nowhere = int((~np.isfinite(grains.sleep.removed)).argmax())
        raise unstable(
            grains, f"grain {nowhere}", "energy taken by sleep", float("nan"), "J/m", "it slept without a speed",
        )  # fmt: skip
    bad, column = first_without_number(d.position, d.velocity, d.spin, d.angle)
    if bad >= 0:
        quantity, unit = (("position", "m"), ("velocity", "m/s"), ("spin", "rad/s"), ("angle", "rad"))[column]
        raise unstable(
            grains, f"grain {bad}", quantity, float("nan"), unit,
            "two centres met or the contact step is beyond its stability limit",
        )  # fmt: skip
