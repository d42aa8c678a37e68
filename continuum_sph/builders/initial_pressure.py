"""Pressure of fluids the instant they are released, so that they start without a shock.

A disc of light fluid in water that has the pressure of water at rest is not at rest: its first push runs through the
tank as sound and rings there.  The pressure that fluids without compressibility would have leaves ∇·(g - ∇p/ρ) = 0.
"""

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.types import Floats

TERMS = 400
"""Of the series, whose rest is 2 H/(π² TERMS) at most."""
SIDES = ((1, 0), (-1, 0), (0, 1), (0, -1))


def released_pressure(x: Floats, y: Floats, width: float, height: float, density: float, gravity: float) -> Floats:
    """Pressure (Pa) in a column of incompressible water the instant its right face is set free.

    ∇²p = 0 with p = 0 on the top y = H and the face x = a, ∂p/∂x = 0 on the wall x = 0, ∂p/∂y = -ρg on the floor.
    With p = ρg{(H - y) - φ}: φ = Σ 2/(H k²) cos(k y) cosh(k x)/cosh(k a), k = (n + 1/2)π/H.
    """
    head = height - y
    for n in range(TERMS):
        k = (n + 0.5) * np.pi / height
        # cosh(kx)/cosh(ka) without overflow
        ratio = np.exp(k * (x - width)) * (1.0 + np.exp(-2.0 * k * x)) / (1.0 + np.exp(-2.0 * k * width))
        head = head - 2.0 / (height * k * k) * np.cos(k * y) * ratio
    return density * gravity * np.maximum(head, 0.0)


def lattice_pressure(
    x: Floats, density: Floats, spacing: float, gravity: float, size: tuple[float, float], lid: bool
) -> Floats:
    """Pressure (n,) Pa of fluid on a square lattice ``x`` (n, 2) m, half a ``spacing`` (m) from the origin.

    density (n,) kg/m³;  gravity m/s², downwards;  size of the tank, m, whose walls let nothing through;  lid: so does
    its top.  Where there is no fluid the pressure is 0, half a spacing away.  Five-point differences, (ρ_a + ρ_b)/2
    between two points, which keeps the acceleration continuous.  In a tank full of fluid and closed the mean pressure
    of the uppermost row is that of half a spacing of it.
    """
    place = np.floor(x / spacing).astype(int)
    columns, rows = (round(length / spacing) for length in size)
    number = np.full((columns + 2, rows + 2), -1)
    number[place[:, 0] + 1, place[:, 1] + 1] = np.arange(len(x))
    diagonal, right = np.zeros(len(x)), np.zeros(len(x))
    entries: list[tuple[Floats, NDArray[np.intp], NDArray[np.intp]]] = []
    for across, up in SIDES:
        there = number[place[:, 0] + 1 + across, place[:, 1] + 1 + up]
        beyond = place + np.array([across, up])
        wall = (beyond[:, 0] < 0) | (beyond[:, 0] >= columns) | (beyond[:, 1] < 0) | ((beyond[:, 1] >= rows) & lid)
        met, free = np.flatnonzero(there >= 0), np.flatnonzero((there < 0) & ~wall)
        ease = 2.0 / (density[met] + density[there[met]])
        entries.append((-ease, met, there[met]))
        diagonal[met] += ease
        diagonal[free] += 2.0 / density[free]
        right[met] += up * gravity * spacing
        right[free] += up * gravity * spacing
    top = place[:, 1] == rows - 1
    closed = lid and len(x) == columns * rows
    if closed:  # any constant may be added: the first point takes 0 for now
        diagonal[0] *= 2.0
    index = np.arange(len(x))
    values, i, j = (np.concatenate(parts) for parts in zip((diagonal, index, index), *entries, strict=True))
    from scipy.sparse import coo_array, csr_array  # takes longer to import than a scene to be judged
    from scipy.sparse.linalg import spsolve

    pressure: Floats = spsolve(csr_array(coo_array((values, (i, j)), shape=(len(x), len(x)))), right)
    if closed:
        pressure += 0.5 * gravity * spacing * density[top].mean() - pressure[top].mean()
    return pressure
