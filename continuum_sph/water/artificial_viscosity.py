"""Artificial viscosity of a pair: eqs 35, 36 of Maeda & Sakai 2004 (Monaghan & Gingold, J. Comput. Phys. 52 (1983)
374).  The paper prints μ_ij without h and with r·x for v·r.
"""

from __future__ import annotations

from porescale.common.compiled.jit import inline
from porescale.common.compiled.simd import lesser


@inline
def artificial(alpha, beta, sound_speed, length, softening, approach, distance2, density_sum):
    """Π_ij, m⁵/(kg s²): (-α c μ + β μ²)/ρ̄ for approaching particles, μ = h v·r/(r² + ε h²), else 0.

    approach v_ij · x_ij, m²/s;  beta: None for 0;  softening ε;  density_sum 2ρ̄, kg/m³.  Acceleration of i:
    -m_j Π_ij ∇_i W.  One division: it is what a pair costs most.
    """
    soft = distance2 + softening * length * length
    if beta is None:
        return -2.0 * alpha * sound_speed * length * lesser(approach, 0.0) / (soft * density_sum)
    per_mass = length * lesser(approach, 0.0) / (soft * density_sum)  # μ/2ρ̄
    return 2.0 * (beta * per_mass * density_sum - alpha * sound_speed) * per_mass
