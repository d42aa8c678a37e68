"""Rate of density of a pair: continuity (eq. 25 of Maeda & Sakai 2004) and diffusion against acoustic noise.

Continuity with the partner's volume, dρ_i/dt = ρ_i Σ V_j v_ij · ∇W, not its mass (eq. 25): the same within one fluid
but for density differences of 1 %, and right beside a fluid of another density.

Diffusion: Molteni & Colagrossi, Comput. Phys. Commun. 180 (2009) 861 ("plain"); of the departure from the hydrostatic
density only, so that water at rest stays: Fourtakas et al., Computers & Fluids 190 (2019) 346 ("hydrostatic"); of the
departure from a linear field: Antuono et al., Comput. Phys. Commun. 181 (2010) 532 ("linear", δ-SPH).
"""

from __future__ import annotations

from porescale.ground.jit import inline

PLAIN, HYDROSTATIC, LINEAR = range(3)
NAMES = ("plain", "hydrostatic", "linear")


@inline
def continuity(density_i, volume_j, approach, slope):
    """dρ_i/dt of one partner, kg/(m³ s): ρ_i V_j v_ij · ∇_i W;  approach v_ij · x_ij, m²/s;  slope (1/r) dW/dr."""
    return density_i * volume_j * approach * slope


@inline
def diffusion(density_i, density_j, expected, volume_j, slope, strength):
    """dρ_i/dt of one partner, kg/(m³ s): 2 δ h c0 (ρ_j - ρ_i - expected)(-(1/r) dW/dr) V_j.

    expected : difference ρ_j - ρ_i that is no noise, kg/m³;  strength 2 δ h c0, m²/s.
    Hydrostatic: dp = ρ g · dx and dp = c² dρ give (ρ/c²) g · (x_j - x_i), with the mean of both ends.
    """
    return -strength * (density_j - density_i - expected) * volume_j * slope
