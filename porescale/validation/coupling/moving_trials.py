"""Discs that move as told, or freely, in fluid: oscillation, shear, a stream, gravity in the fluid; lattice units."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.special import kve

from porescale.lbm.boundary.sides import Sides
from porescale.lbm.lattice import viscosity
from porescale.validation.coupling.grains_trials import DEFAULT, TAU, Method, faxen, immersed
from porescale.validation.coupling.towed_trials import PERIODIC, steady, towed
from porescale.validation.lbm.channels_flows import one_thread

Array = NDArray[np.floating]


def stokes_oscillation(frequency: float) -> complex:
    """G = 1 + 4 K1(z)/(z K0(z)), z = sqrt(i a² w/nu): force on an oscillating cylinder -rho pi a² G dU/dt (Stokes).

    Its real part is the added mass, less its imaginary part the damping over w, both in displaced masses.
    """
    z = np.sqrt(1j * frequency)
    return complex(1 + 4 * kve(1, z) / (z * kve(0, z)))


def dipole_in_a_box(images: int = 200) -> float:
    """Stream that its images in a square box of side 1 send to a dipole of strength 1 in the middle, against it.

    A wall across turns the dipole's image round, one along does not: sum of (-1)^m (m² - n²)/(m² + n²)² over all but
    the origin, rows first, since over n each row falls off exponentially.
    """
    n = np.arange(-images * 50, images * 50 + 1)
    total = 0.0
    for m in range(-images, images + 1):
        row = n[n != 0] if m == 0 else n
        total += (-1) ** m * float(np.sum((m * m - row**2) / (m * m + row**2) ** 2.0))
    return -total


def oscillation(
    frequency: float,
    *,
    radius: float = 10.0,
    width: float = 10.0,
    relaxation_time: float = TAU,
    inner: bool = True,
    method: Method = DEFAULT,
) -> complex:
    """G of a disc that oscillates in a closed box ``width`` radii wide, ``frequency`` a² w/nu.

    inner: whether the fluid inside is given back.  Its centre hardly moves.  The first half period is passed over, the
    next whole one fitted.
    """  # fmt: skip
    n, nu = round(width * radius), viscosity(relaxation_time)
    w = frequency * nu / radius**2
    period = round(2 * math.pi / w)
    coupled = towed((n, n), [(n / 2 + 0.3, n / 2 + 0.1)], radius, relaxation_time=relaxation_time, method=method)
    if not inner:
        coupled.inner_mass[:] = 0.0
    speed = 1e-3 * w * radius  # a thousandth of the radius to and fro
    force = np.zeros(period)
    with one_thread():
        for step in range(period // 2 + period):
            coupled.grains.discs.velocity[0, 0] = speed * math.sin(w * step)
            coupled.advance()
            if step >= period // 2:
                force[step - period // 2] = coupled.fluid_force[0, 0]
    # U is held over a step and loads are those within it: half a step later.
    phase = w * (np.arange(period) + period // 2)
    fitted = np.linalg.lstsq(np.stack([np.sin(phase), np.cos(phase), np.ones(period)], 1), force, rcond=None)[0]
    amplitude = complex(fitted[0], fitted[1])  # of exp(i w t) - i: force = Im(amplitude exp(i phase))
    return -amplitude / (1j * w * math.pi * radius**2 * speed)


def oscillation_in_a_box(frequency: float, width: float = 10.0) -> complex:
    """G with the images of its dipole, a² (1 + G)/2, whose stream u acts as G U - (1 + G) u: exact to (a/W)⁴."""
    g = stokes_oscillation(frequency)
    return g + (1 + g) ** 2 / 2 * dipole_in_a_box() / width**2


def shear_spin(
    blockage: float = 0.1,
    diameter: float = 10.0,
    *,
    relaxation_time: float = TAU,
    reynolds: float = 0.01,
    density: float = 1.0,
    place: tuple[float, float] = (0.3, 0.0),
    method: Method = DEFAULT,
) -> float:
    """Spin over the shear rate of a free disc midway between walls that move apart, diameter over their distance given.

    reynolds: shear rate * d²/nu.  The channel is periodic, three heights long.
    """  # fmt: skip
    height = round(diameter / blockage)
    nu = viscosity(relaxation_time)
    rate = reynolds * nu / diameter**2
    wall = rate * height / 2
    sides = Sides("periodic", "periodic", "wall", "wall", top_speed=wall, bottom_speed=-wall)
    cells = 3 * height, height
    centre = cells[0] / 2 + place[0], height / 2 + place[1]
    coupled = towed(
        cells, [centre], diameter / 2, spin=-rate / 2, relaxation_time=relaxation_time, sides=sides, density=density,
        method=method,
    )  # fmt: skip
    y = np.arange(height)[:, None] + 0.5 - height / 2
    coupled.fluid.set_flow(rate * y * np.ones(cells[0]), 0.0)
    coupled.grains.hold(0, x=True, y=True, rotation=False)
    discs = coupled.grains.discs
    return -steady(coupled, lambda: float(discs.spin[0]), (height / (2 * math.pi)) ** 2 / nu) / rate


def stream_drag(
    frame: float,
    *,
    diameter: float = 10.0,
    relaxation_time: float = TAU,
    speed: float = 0.02,
    steps: int = 2000,
    method: Method = DEFAULT,
) -> Array:
    """Drag on a disc that meets fluid at ``speed`` in a periodic box of six diameters, (steps,).

    frame 0: the disc stands and the fluid streams;  1: the fluid stands and the disc goes;  others between and beyond.
    """  # fmt: skip
    cells = round(6 * diameter)
    coupled = towed(
        (cells, cells), [(cells / 2, cells / 2)], diameter / 2, (-frame * speed, 0.0), relaxation_time=relaxation_time,
        sides=PERIODIC, method=method,
    )  # fmt: skip
    coupled.fluid.set_flow((1 - frame) * speed, 0.0)
    coupled.inner_velocity[:] = coupled.grains.discs.velocity
    drag = np.zeros(steps)
    with one_thread():
        for step in range(steps):
            coupled.advance()
            drag[step] = coupled.fluid_force[0, 0]
    return drag


def settled_speed(
    ratio: float,
    blockage: float = 0.2,
    diameter: float = 10.0,
    *,
    relaxation_time: float = TAU,
    speed: float = 1e-4,
    gravity_in_fluid: bool = False,
    method: Method = DEFAULT,
) -> float:
    """Speed over the expected one of a free disc of density ``ratio`` that sinks or rises in a closed channel.

    Expected: (s - 1) g pi a²/(mu K), K by Faxen.  gravity_in_fluid: the fluid is pulled down too, and what it then
    bears of a disc at rest, in place of the buoyancy, is measured and put right.
    """  # fmt: skip
    width = round(diameter / blockage)
    nu, a = viscosity(relaxation_time), diameter / 2
    g = speed * nu * faxen(diameter / width) / ((ratio - 1) * math.pi * a**2)
    cells = width, 4 * width

    def made(held: bool, pulled: bool) -> float:
        """The speed a disc settles at, or the load on one that is held, in cells and steps."""
        coupled = immersed(
            cells, [(width / 2, cells[1] / 2 + 0.3)], a, ratio, relaxation_time=relaxation_time,
            acceleration=(0.0, 0.0 if held else -g), force=(0.0, -g if pulled else 0.0), method=method,
        )  # fmt: skip
        if pulled:  # start with the pressure of water at rest
            depth = cells[1] / 2 - 0.5 - np.arange(cells[1])
            coupled.fluid.set_flow(0.0, 0.0, 1 + 3 * g * depth[:, None])
        if held:
            coupled.grains.hold(0)
        elif pulled:
            coupled.weight[0, 1] = -coupled.grains.discs.mass[0] * g + math.pi * a**2 * g - buoyancy
        discs = coupled.grains.discs
        memory = max((width / (2 * math.pi)) ** 2 / nu, (ratio + 1) * math.pi * a**2 / (nu * 16))
        value = (lambda: float(coupled.fluid_force[0, 1])) if held else lambda: float(discs.velocity[0, 1])
        return steady(coupled, value, memory, 1e-4)

    buoyancy = made(True, True) if gravity_in_fluid else 0.0
    return abs(made(False, gravity_in_fluid)) / speed
