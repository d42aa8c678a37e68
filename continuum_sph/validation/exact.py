"""Exact solutions that validations hold the particles to.  SI; arrays in, arrays out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.special import jv, jvp

Floats = NDArray[np.float64]


def couette(y: Floats, time: float, gap: float, speed: float, viscosity: float) -> Floats:
    """Velocity (m/s) between a wall at rest (y = 0) and one that starts at ``speed`` (y = gap); ν in m²/s.

    Morris, Fox & Zhu 1997, eq. 35.
    """
    u = speed * y / gap
    for n in range(1, 200):
        decay = np.exp(-viscosity * (n * np.pi / gap) ** 2 * time)
        u = u + 2.0 * speed / (n * np.pi) * (-1) ** n * np.sin(n * np.pi * y / gap) * decay
    return u


def poiseuille(y: Floats, time: float, gap: float, force: float, viscosity: float) -> Floats:
    """Velocity (m/s) between walls at rest a time after a body ``force`` (m/s²) sets in; ν in m²/s.

    Morris, Fox & Zhu 1997, eq. 36.
    """
    u = force / (2.0 * viscosity) * y * (gap - y)
    for n in range(200):
        k = (2 * n + 1) * np.pi / gap
        u = u - 4.0 * force / (viscosity * gap * k**3) * np.sin(k * y) * np.exp(-viscosity * k * k * time)
    return u


def drop_period(radius: float, tension: float, inner: float, outer: float, sound: float) -> float:
    """Period (s) of the swing n = 2 of a drop of ``radius`` (m) in the plane, both fluids without viscosity.

    ω² {ρ_i J₂(x)/x J₂'(x) + ρ_e/2} = 3 σ/R³, x = ω R/c: Lamb, Hydrodynamics (6th ed., arts 273-275), with sound of
    speed ``sound`` (m/s) in the drop, whose pressure goes as J₂;  σ ``tension`` N/m, ρ_i ``inner``, ρ_e ``outer``
    kg/m³.  Infinite sound: J₂(x)/x J₂'(x) = 1/2.
    """
    frequency = (6.0 * tension / ((inner + outer) * radius**3)) ** 0.5
    for _ in range(60):  # converges as (x²/6)^k
        x = frequency * radius / sound
        share = jv(2, x) / (x * jvp(2, x)) if x > 0.0 else 0.5
        frequency = (3.0 * tension / radius**3 / (inner * share + 0.5 * outer)) ** 0.5
    return float(2.0 * np.pi / frequency)


def taylor_green_vortices(x: Floats) -> tuple[Floats, Floats]:
    """Velocity (n, 2) m/s and pressure (n,) Pa at ``x`` (n, 2) m of four vortices in a box of 1 m, 1 m/s, 1 kg/m³.

    Taylor & Green, Proc. R. Soc. A 158 (1937) 499: the field keeps its form and decays as exp(-8π² ν t).
    """
    angle = 2.0 * np.pi * x
    v = np.column_stack((-np.cos(angle[:, 0]) * np.sin(angle[:, 1]), np.sin(angle[:, 0]) * np.cos(angle[:, 1])))
    p = -0.25 * (np.cos(2.0 * angle[:, 0]) + np.cos(2.0 * angle[:, 1]))
    return v, p
