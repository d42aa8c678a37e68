"""Soil as one layer of smoothed particles that carry stress.  Two dimensions, SI, compression positive.

    dv/dt = -∇·σ'/ρ + g + f/m,   dσ'/dt = C : ε' + ω·σ' - σ'·ω,   ε' = -sym ∇v,   ω = skew ∇v

What there is
  `Soil`      the state: arrays, soil particles first, wall particles after them
  `Material`  elasticity, strength, weight and porosity of one kind of soil: a row of the table that kernels read
  `Rate`      how its friction grows with the rate of shear, where it does
  `Softening` what its strength falls to as it shears, where it does
  `SoilLaw`   parameters of all particles: smoothing, gravity, damping, corrections, walls
  `SoilFlow`  a soil, its law and its pairs, moving

How to use it.  Fill a `Soil`, make a `SoilFlow`, set ``lower``, ``upper`` (surfaces of the walls) and call ``start``.
Then ``advance()`` does one step of length ``next_step``; ``advance(step)`` does a shorter one (another layer's).
Other layers act through ``soil.force`` (soil, 2), N per metre of depth on each particle: set ``flow.before_force`` to a
function of the flow that overwrites it; it is called once a step, when positions, densities and effective stresses are
those of the end of the step, just before accelerations.  To put something else between the parts of a step (an implicit
drag, for example) call the parts themselves, which is all that ``advance`` does:

    flow.begin(step)      half kick and drift
    flow.strain(step)     velocity gradients, densities, stresses at the new positions
    flow.push()           before_force, walls, accelerations
    flow.end(step)        half kick, and the longest next step

``soil.mass`` is (1 - n) ρ_s times volume, ``soil.density`` the same per volume, so `porosity` follows from it;
``soil.stress`` is the effective stress.  ``flow.limit`` (s), when set, bounds ``next_step`` beside the soil's rules.

Forces of a pair are -V_i V_j (σ_i K_i + σ_j K_j)·∇W, K the gradient correction: opposite to the last bit but for the
division by mass, and the exact counterpart of velocity gradients Σ V_j (v_j - v_i) ⊗ K_i ∇W, which rotation leaves
alone: linear and angular momentum and energy are kept (Bonet & Lok, Comput. Methods Appl. Mech. Eng. 180 (1999) 97).
Eqs 33, 35, 37 of Maeda & Sakai 2004 have K = 1 and are a choice; eq. 38 turns the wrong way and is one too, for tests.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
