"""Rate of density of a pair: continuity (eq. 25 of Maeda & Sakai 2004) and diffusion against acoustic noise.

Continuity with the partner's volume, dρ_i/dt = ρ_i Σ V_j v_ij · ∇W, not its mass (eq. 25): the same within one fluid
but for density differences of 1 %, and right beside a fluid of another density.

Diffusion: Molteni & Colagrossi, Comput. Phys. Commun. 180 (2009) 861 ("plain"); of the departure from the hydrostatic
density only, so that water at rest stays: Fourtakas et al., Computers & Fluids 190 (2019) 346 ("hydrostatic"); of the
departure from a linear field: Antuono et al., Comput. Phys. Commun. 181 (2010) 532 ("linear", δ-SPH).

What it gives one particle of a pair it takes from the other, Σ V dρ/dt = 0 in all three.  It moves no particle, and so
parts densities from how closely particles lie: with γ = n m/ρ (n: particles per area), 1 on the lattice,

    d ln γ/dt = -(1/ρ) diffusion,     Σ V (p_i + p_j) ∇W ≈ ∇p + A p ∇ln γ

(A = 2, or 1 with corrected gradients).  Water at rest whose γ is uneven, as settling leaves it next to walls and the
surface, has pressures off the hydrostatic by A p ∇ln γ; diffusion levels these, and γ with them, as fast as
δ h c0 A p/(ρ c0²).  Of a metre of water at c0 = 44 m/s and δ = 0.1 that takes minutes, 4·10⁵ steps, and lifts the mean
height of corrected water by 2.2·10⁻⁴ of its depth per 10⁵ steps, half as much with half of δ, nothing with none.
"Linear" lets such long waves of γ go: 3·10⁻³ per 10⁵ steps, downwards.
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
