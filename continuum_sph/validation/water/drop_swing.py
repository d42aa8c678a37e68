"""A viscous drop in another viscous fluid that swings in the plane: exact for small amplitudes.  SI.

Lamb's drop (Hydrodynamics, art. 275) is inviscid.  Two viscous fluids that move against each other along their
interface drag layers √(2ν/ω) thick, which slow the swing by the square root of the viscosity: Miller & Scriven, J.
Fluid Mech. 32 (1968) 417;  that these layers have to grow first: Prosperetti, ibid. 100 (1980) 333.  Both in space;
here the same in the plane.  In each fluid the stream function is Σ f(r) sin nθ e^{st}: f = r^±n with the pressure
-ρ s φ, and f = I_n or K_n(r √(s/ν)) without; velocities and the shear stress are continuous, the normal stress jumps by
σ δκ, δκ = (n² - 1) η/R².
"""

import numpy as np
from scipy.special import ive, jv, jvp, kve

from porescale.common.core.types import Floats


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


MODE = 2
NODES = 32  # of the inverse transform: it gains 0.6 digits with each and loses round-off times e^(0.4 NODES) = 4e-11


def drop_swing(
    times: Floats, radius: float, tension: float, densities: tuple[float, float], viscosities: tuple[float, float]
) -> Floats:
    """How far (m per m/s) a drop of ``radius`` (m) is drawn out at ``times`` (s, above 0) after a kick.

    η(t) at the tips, n = 2, both fluids starting in irrotational motion of 1 m/s there;  tension σ, N/m;  densities ρ,
    kg/m³, and viscosities μ, Pa s, above 0, inside and outside.  The inverse Laplace transform of `_tip` by the fixed
    Talbot contour: Abate & Valkó, Int. J. Numer. Methods Eng. 60 (2004) 979.
    """
    angle = np.arange(1, NODES) * np.pi / NODES
    cot = 1.0 / np.tan(angle)
    where = np.concatenate(([1.0 + 0.0j], angle * (cot + 1.0j)))
    weight = np.concatenate(([0.5 + 0.0j], 1.0 + 1.0j * (angle + (angle * cot - 1.0) * cot)))
    found = np.zeros(len(times))
    for k, time in enumerate(times):
        reach = 2.0 * NODES / (5.0 * time)
        tips = np.array([_tip(reach * s, radius, tension, densities, viscosities) for s in where])
        found[k] = reach / NODES * float(np.real(np.exp(reach * time * where) * weight * tips).sum())
    return found


def swing_period(
    radius: float, tension: float, densities: tuple[float, float], viscosities: tuple[float, float]
) -> float:
    """Time (s) until a kicked drop is round for the second time, see `drop_swing`."""
    lamb = 2.0 * np.pi * ((densities[0] + densities[1]) * radius**3 / (6.0 * tension)) ** 0.5
    times = lamb * np.linspace(0.8, 1.4, 121)
    swing = drop_swing(times, radius, tension, densities, viscosities)
    turn = int(np.flatnonzero((swing[:-1] < 0.0) & (swing[1:] >= 0.0))[0])
    # parabolas through a step of 0.005 periods would change its sixth digit
    return float(times[turn] - swing[turn] * (times[turn + 1] - times[turn]) / (swing[turn + 1] - swing[turn]))


def _tip(
    s: complex, radius: float, tension: float, densities: tuple[float, float], viscosities: tuple[float, float]
) -> complex:
    """Laplace transform of `drop_swing` at ``s`` (1/s): four amplitudes from four conditions at r = R."""
    n = MODE
    inner, outer = (radius * np.sqrt(s * rho / mu) for rho, mu in zip(densities, viscosities, strict=True))
    # r f'/f and r² f''/f of r^n, r^-n, I_n, K_n, all 1 at R
    bent_in = inner * ive(n - 1, inner) / ive(n, inner) - n
    bent_out = -outer * kve(n - 1, outer) / kve(n, outer) - n
    first = np.array([n, -n, bent_in, bent_out])
    second = np.array([n * (n - 1), n * (n + 1), inner**2 + n * n - bent_in, outer**2 + n * n - bent_out])
    mu = np.array([viscosities[0], viscosities[1]] * 2)
    side = np.array([1.0, -1.0, 1.0, -1.0])
    conditions = np.zeros((4, 4), complex)
    conditions[0] = side * n / radius
    conditions[1] = side * first / radius
    conditions[2] = side * mu * (first - second - n * n) / radius**2
    conditions[3] = side * 2.0 * mu * n * (first - 1.0) / radius**2
    conditions[3, :2] += s * np.array(densities)
    conditions[3, ::2] += tension * (n * n - 1) / radius**2 * n / radius / s
    given = np.array([0.0, 0.0, 0.0, sum(densities) * radius / n])  # of the start's potential, jump of ρ φ
    scale = np.abs(conditions).max(axis=1)
    amplitudes = np.linalg.solve(conditions / scale[:, None], given / scale)
    return complex(n / radius * (amplitudes[0] + amplitudes[2]) / s)
