"""Laminar viscous acceleration of a pair: eq. 34 of Maeda & Sakai 2004 (Morris, Fox & Zhu, J. Comput. Phys. 136 (1997)
214).  Between two fluids the harmonic mean of Cleary & Monaghan, J. Comput. Phys. 148 (1999) 227, keeps the stress
continuous; the print has (μ_i + μ_j), which is the same within one fluid.  Where viscosities differ `transposed` adds
what is missing to the divergence of a stress.
"""

from __future__ import annotations

from porescale.ground.jit import inline


@inline
def between(viscosity_i, viscosity_j):
    """Viscosity (Pa s) that two particles share: 2 μ_i μ_j/(μ_i + μ_j), 0 if both have none."""
    both = viscosity_i + viscosity_j
    return 2.0 * viscosity_i * viscosity_j / both if both > 0.0 else 0.0


@inline
def laminar(viscosity, volume_j, specific_i, slope):
    """Factor of v_ij, 1/s: m_j 2μ/(ρ_i ρ_j) (1/r) dW/dr.

    viscosity μ of the pair, Pa s;  volume_j m_j/ρ_j, m²;  specific_i 1/ρ_i, m³/kg;  slope (1/r) dW/dr.
    Negative: it brakes.
    """
    return 2.0 * viscosity * volume_j * specific_i * slope
