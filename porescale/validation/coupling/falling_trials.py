"""Discs that fall on each other and on the bottom, SI."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from porescale.lbm.lattice import viscosity
from porescale.lbm.scales import Scales
from porescale.validation.coupling.grains_trials import DEFAULT, Method, immersed
from porescale.validation.coupling.towed_trials import jeffrey_onishi
from porescale.validation.lbm.channels_flows import one_thread

Array = NDArray[np.floating]


def kiss(
    cells_per_diameter: int = 20,
    *,
    relaxation_time: float = 0.512,
    density_ratio: float = 1.5,
    method: Method = DEFAULT,
) -> tuple[float, Array]:
    """Time (s) at which two falling discs first touch, and their places then (2, 2) in diameters.

    Uhlmann 2005: channel 8 x 24 diameters, d 0.25 cm, s 1.5, nu 0.01 cm²/s, g 9.81 m/s², released at rest 4 and 6
    diameters below the top, d/250 to the right and to the left of the middle.  nan if they have not met after 0.3 s.
    """  # fmt: skip
    diameter, nu = 0.0025, 1e-6
    spacing = diameter / cells_per_diameter
    step = (relaxation_time - 0.5) / 3 * spacing**2 / nu
    offset = diameter / 250
    place = [(4 * diameter + offset, 20 * diameter), (4 * diameter - offset, 18 * diameter)]
    coupled = immersed(
        (8 * cells_per_diameter, 24 * cells_per_diameter), place, diameter / 2, 1000 * density_ratio,
        acceleration=(0.0, -9.81), scales=Scales(spacing, step, relaxation_time), method=method,
    )  # fmt: skip
    at, time, gap = coupled.grains.discs.position, 0.0, diameter
    with one_thread():
        while time < 0.3:
            coupled.advance()
            before, gap = gap, float(np.hypot(*(at[0] - at[1]))) - diameter
            time = coupled.fluid.step * step
            if gap <= 0:
                return time - step * gap / (gap - before), at / diameter
    return float("nan"), at / diameter


def approach(
    gaps: tuple[float, ...] = (0.6, 0.4, 0.3),
    *,
    radius: float = 10.0,
    relaxation_time: float = 0.6,
    ratio: float = 2.0,
    method: Method = DEFAULT,
) -> list[float]:
    """Speed times mu over the weight per metre of a disc that sinks to the floor, at gaps in radii, descending.

    Box 12 by 6 radii, lattice units; released 1.2 radii up, so slowly that the flow follows.
    """  # fmt: skip
    nu = viscosity(relaxation_time)
    weight = 2e-3 * nu**2 * jeffrey_onishi("towards", 1.0)  # a Reynolds number of 0.002 or so
    g = weight / ((ratio - 1) * np.pi * radius**2)
    coupled = immersed(
        (round(12 * radius), round(6 * radius)), [(6 * radius + 0.3, 2.0 * radius)], radius, ratio,
        relaxation_time=relaxation_time, acceleration=(0.0, -g), method=method,
    )  # fmt: skip
    discs, found = coupled.grains.discs, []
    with one_thread():
        for gap in gaps:
            while discs.position[0, 1] > radius * (1 + gap):
                coupled.advance()
            found.append(-float(discs.velocity[0, 1]) * nu / weight)
    return found
