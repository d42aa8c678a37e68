"""Rate of density of a pair: continuity (eq. 25 of Maeda & Sakai 2004), diffusion against acoustic noise, a filter.

Continuity with the partner's volume, dρ_i/dt = ρ_i Σ V_j v_ij · ∇W, not its mass (eq. 25): the same within one fluid
but for density differences of 1 %, and right beside a fluid of another density.

A filter within one fluid (eq. 27), ρ_i = Σ m_j W/Σ (m_j/ρ_j) W with i itself included: a Shepard average, which keeps
any uniform density, so makes no pressure and cannot stand for continuity; every 20 to 40 steps it takes out the noise
that continuity collects.

Diffusion: Molteni & Colagrossi, Comput. Phys. Commun. 180 (2009) 861 ("plain"); of the departure from the hydrostatic
density only, so that water at rest stays: Fourtakas et al., Computers & Fluids 190 (2019) 346 ("hydrostatic"); of the
departure from a linear field: Antuono et al., Comput. Phys. Commun. 181 (2010) 532 ("linear", δ-SPH).

What it gives one particle of a pair it takes from the other, Σ V dρ/dt = 0 in all three.  It moves no particle, and so
separates densities from how closely particles lie: with γ = n m/ρ (n: particles per area), 1 on the lattice,

    d ln γ/dt = -(1/ρ) diffusion,     Σ V (p_i + p_j) ∇W ≈ ∇p + A p ∇ln γ

(A = 2, or 1 with corrected gradients).  Water at rest whose γ is uneven, as settling leaves it next to walls and the
surface, has pressures off the hydrostatic by A p ∇ln γ; diffusion levels these, and γ with them, as fast as
δ h c0 A p/(ρ c0²).  At the speed of sound, as published, that takes minutes of a metre of water, c0 = 44 m/s and
δ = 0.1, 4·10⁵ steps, and lifts its mean height by 2·10⁻⁴ of the depth per 10⁵ steps.  "Linear" lets ρ have any slope,
so nothing holds long waves of γ: water sinks by 3·10⁻³ per 10⁵ steps, and the pressure on the floor by 6 %.

So the densities of a pair diffuse at the speed of sound where it closes or separates as quickly as in noise above a
threshold, more slowly below it, and not at rest, as stress of soil does (`soil.momentum`).  (|v_ij · x_ij|/r in place
of sound keeps gas in hydrostatic equilibrium from conducting its heat away: Wadsley, Veeravalli & Couchman, Mon. Not.
R. Astron. Soc. 387 (2008) 427; Price et al., Publ. Astron. Soc. Aust. 35 (2018) e031.)  Noise of a pressure p' moves at
p'/(ρ c0).  With a threshold of a thousandth of the weight of a metre of water, what levels γ moves pairs at 10⁻³ of
that, and stops itself.  Under "linear" water in the open keeps moving at five times such speeds and goes on sinking,
2.8 in place of 3.9·10⁻³ in 10⁵ steps; among grains, whose drag stops it, it stands.
"""

import numpy as np

from continuum_sph.water.smoothing import kernel_value
from continuum_sph.water.state import X, Y
from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.common.compiled.simd import maximum, minimum
from porescale.common.neighbors.cells import minimum_image

PLAIN, HYDROSTATIC, LINEAR = range(3)
NAMES = ("plain", "hydrostatic", "linear")


@inline
def diffusion_share(approach, inverse_noise_speed, sound_share):
    """Share of the speed of sound at which the densities of a pair diffuse: min(1, s + |v_ij · x_ij|/(h v_n)).

    approach v_ij · x_ij, m²/s;  inverse_noise_speed 1/(h v_n), s/m², and sound_share s: of `noise_scale`.
    """
    return minimum(sound_share + inverse_noise_speed * maximum(approach, -approach), 1.0)


@inline
def noise_scale(noise_speed, h):
    """1/(h v_n), s/m², and 0 of a ``noise_speed`` v_n (m/s);  0 and 1, the speed of sound always, of v_n = 0."""
    if noise_speed > 0.0:
        return 1.0 / (h * noise_speed), 0.0
    return 0.0, 1.0


@parallel_kernel
def filtered(start, split, partner, record, material, mass, density, out, kind, h, period_x, period_y):
    """Overwrites ``out`` (fluid,) with the normalised ``density`` (fluid,), kg/m³.

    start, split, partner: full list, wall partners from ``split[i]`` on (they take no part);  record: see Layer, its
    positions are read;  volumes are mass/density;  kind, h: smoothing;  periods, m or 0.
    """
    for i in prange(density.shape[0]):
        value = kernel_value(kind, 0.0, h)
        above = mass[i] * value
        below = mass[i] / density[i] * value
        for k in range(np.uint64(start[i]), np.uint64(split[i])):
            j = np.uint64(partner[k])
            if material[j] != material[i]:
                continue
            dx = minimum_image(record[i, X] - record[j, X], period_x)
            dy = minimum_image(record[i, Y] - record[j, Y], period_y)
            value = kernel_value(kind, np.sqrt(dx * dx + dy * dy) / h, h)
            above += mass[j] * value
            below += mass[j] / density[j] * value
        out[i] = above / below if below > 0.0 else density[i]  # those that wait have no mass
