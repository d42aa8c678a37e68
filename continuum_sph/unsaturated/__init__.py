"""Pores that are partly full: Richards' equation on the particles of the soil.  Two dimensions, SI.

Why not on particles of water, as `continuum_sph.seepage` has them: such a particle takes up V = m/(n S ρ_w), so along a
flow in one direction they lie 1/(n S) spacings apart, 2.5 where pores are full and 8 at S = 0.3, n = 0.4; kernels reach
2.6 to 4.  The distance over h stays under refinement, and with it the error.  Soil has its lattice at any saturation.
So where a scene has suction the water of the pores is a number that each particle of soil carries; it moves along with
the soil, and between its particles by Darcy's law.  There are no particles of water: what stands outside is at rest at
the levels of its reservoirs.

Stress.  Bishop's effective stress (Geotechnique 9 (1959) 215, in Teknisk Ukeblad 106 (1959) 859) takes χ p off the
total stress and leaves χ to be measured; here χ = S_e below saturation (Lu, Godt & Wu, Water Resour. Res. 46 (2010)
W05515) and 1 above: suction holds grains together.

Parts: `VanGenuchten` (`retention`), Mualem's k_r (`conductivity`), `Moisture`, the water (`richards`), `Outside`, what
lies about the ground (`outside`), `pore_forces` on the soil (`pore_stress`), `MoistSoil`, both moving (`step`).
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
