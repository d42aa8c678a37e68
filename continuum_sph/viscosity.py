"""Viscous acceleration of a pair: laminar (eq. 34) and artificial (eqs 35, 36 of Maeda & Sakai 2004).

Laminar: Morris, Fox & Zhu, J. Comput. Phys. 136 (1997) 214.  Artificial: Monaghan & Gingold 1983; the paper
prints μ_ij without h and with r·x for v·r.
"""

from __future__ import annotations

from porescale.ground.jit import inline


@inline
def laminar(viscosity, volume_j, specific_i, slope):
    """Factor of v_ij, 1/s: m_j (μ_i + μ_j)/(ρ_i ρ_j) (1/r) dW/dr for one liquid.

    viscosity μ, Pa s;  volume_j m_j/ρ_j, m²;  specific_i 1/ρ_i, m³/kg;  slope (1/r) dW/dr.  Negative: it brakes.
    """
    return 2.0 * viscosity * volume_j * specific_i * slope


@inline
def artificial(alpha, beta, sound_speed, length, softening, approach, distance2, density_sum):
    """Π_ij, m⁵/(kg s²): (-α c μ + β μ²)/ρ̄ for approaching particles, μ = h v·r/(r² + ε h²), else 0.

    approach v_ij · x_ij, m²/s;  softening ε;  density_sum 2ρ̄, kg/m³.  Acceleration of i: -m_j Π_ij ∇_i W.
    One division: it is what a pair costs most.
    """
    soft = distance2 + softening * length * length
    per_mass = length * min(0.0, approach) / (soft * density_sum)  # μ/2ρ̄
    return 2.0 * (beta * per_mass * density_sum - alpha * sound_speed) * per_mass
