"""Laminar viscous acceleration of a pair: eq. 34 of Maeda & Sakai 2004 (Morris, Fox & Zhu, J. Comput. Phys. 136 (1997)
214).  Between two fluids the harmonic mean of Cleary & Monaghan, J. Comput. Phys. 148 (1999) 227, keeps the stress
continuous; eq. 34 has (μ_i + μ_j), which is the same within one fluid.

Eq. 34 is ∇·(μ ∇v).  Where μ changes that is not the divergence of a stress: the term ∇·(μ ∇vᵀ) is missing, an interface
that is strained bears half of 2μ ∂v_n/∂n, and two fluids that rotate as one slow each other down.  Friction between two
fluids therefore acts along the line of centres, with the factor of two dimensions: ∇·μ(∇v + ∇vᵀ), by forces that exert
no torque and always dissipate.
On a square lattice of h = 1.35 spacings that is 13 % too stiff along the axes and 17 % too soft across; disordered
particles have the mean.  (Adding ∇·(μ ∇vᵀ) from gradients in a second pass is the same on any lattice, but can make
energy; it takes 2 % off the speed of Hysing's bubble.)  Source: Monaghan, Rep. Prog. Phys. 68 (2005) 1703; which form
has which stress: Colagrossi et al., Phys. Rev. E 84 (2011) 026705.

Artificial viscosity: eqs 35, 36 of Maeda & Sakai 2004 (Monaghan & Gingold, J. Comput. Phys. 52 (1983) 374).  Maeda &
Sakai 2004 have μ_ij without h and with r·x for v·r.
"""

from porescale.common.compiled.jit import inline
from porescale.common.compiled.simd import maximum, minimum

CENTRAL = 4.0
"""Friction along the line of centres over eq. 34's in all directions: 2(2 + 2) for 2, in the plane."""
STIFFER = 3.0
"""How much faster it damps the shortest wave, along it: 2.4 to 2.8 times for h of 1 to 1.8 spacings, rounded up."""
COINCIDENT = 1e-300  # m²: two particles in one place have no line of centres, and no approach


@inline
def laminar(viscosity, volume_j, specific_i, slope):
    """Factor of v_ij, 1/s: m_j 2μ/(ρ_i ρ_j) (1/r) dW/dr.

    viscosity μ of the pair, Pa s;  volume_j m_j/ρ_j, m²;  specific_i 1/ρ_i, m³/kg;  slope (1/r) dW/dr.
    Negative: it brakes.
    """
    return 2.0 * viscosity * volume_j * specific_i * slope


@inline
def central(viscous_term, approach, distance2):
    """Factor of x_ij, 1/s²: friction along the line of centres for what `laminar` gives of v_ij.

    viscous_term 1/s;  approach v_ij · x_ij, m²/s;  distance2 r², m².
    """
    return CENTRAL * viscous_term * approach / maximum(distance2, COINCIDENT)


@inline
def mutual(viscosity_i, viscosity_j, specific_i, approach, distance2):
    """Factor of V_j x_ij (1/r) dW/dr, 1/(m⁴ s²): `central` of `laminar` with the viscosity that two particles share.

    That is 2 μ_i μ_j/(μ_i + μ_j), 0 if one has none.  The rest: as there.  One division.
    """
    above = 4.0 * CENTRAL * viscosity_i * specific_i * viscosity_j * approach
    return above / maximum((viscosity_i + viscosity_j) * distance2, COINCIDENT)


@inline
def artificial(alpha, beta, sound_speed, length, softening, approach, distance2, density_sum):
    """Π_ij, m⁵/(kg s²): (-α c μ + β μ²)/ρ̄ for approaching particles, μ = h v·r/(r² + ε h²), else 0.

    approach v_ij · x_ij, m²/s;  beta: None for 0;  softening ε;  density_sum 2ρ̄, kg/m³.  Acceleration of i:
    -m_j Π_ij ∇_i W.  One division: it is what a pair costs most.
    """
    soft = distance2 + softening * length * length
    if beta is None:
        return -2.0 * alpha * sound_speed * length * minimum(approach, 0.0) / (soft * density_sum)
    per_mass = length * minimum(approach, 0.0) / (soft * density_sum)  # μ/2ρ̄
    return 2.0 * (beta * per_mass * density_sum - alpha * sound_speed) * per_mass
