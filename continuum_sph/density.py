"""Rate of density of a pair: continuity (eq. 25 of Maeda & Sakai 2004) and diffusion against acoustic noise.

Eq. 27, the normalised density, is a Shepard average: it keeps any uniform density and so makes no pressure.
Diffusion: Molteni & Colagrossi, Comput. Phys. Commun. 180 (2009) 861, of the departure from the hydrostatic
density only, so that water at rest stays: Fourtakas et al., Computers & Fluids 190 (2019) 346.
"""

from __future__ import annotations

from porescale.ground.jit import inline


@inline
def continuity(mass_j, approach, slope):
    """dρ_i/dt of one partner, kg/(m³ s): m_j v_ij · ∇_i W;  approach v_ij · x_ij, m²/s;  slope (1/r) dW/dr."""
    return mass_j * approach * slope


@inline
def diffusion(density_i, density_j, stiff_i, stiff_j, lift, volume_j, slope, strength):
    """dρ_i/dt of one partner, kg/(m³ s): 2 δ h c0 (ρ_j - ρ_i - hydrostatic difference)(-(1/r) dW/dr) V_j.

    Hydrostatic: dp = ρ g · dx and dp = c² dρ give ρ_j - ρ_i = (ρ/c²) g · (x_j - x_i), with the mean of both ends;
    stiff ρ/c², kg s²/m⁵;  lift g · (x_i - x_j), m²/s²;  strength 2 δ h c0, m²/s.
    """
    departure = density_j - density_i + 0.5 * (stiff_i + stiff_j) * lift
    return -strength * departure * volume_j * slope
