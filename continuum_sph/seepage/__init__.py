"""Water in the pores of soil: two layers of particles in the same place.  Two dimensions, SI, compression positive.

Water particles carry the mass m of their water and its true density ρ_f, from which p follows; soil particles the
volume of their grains, which never changes.  At a water particle

    ψ_is = V^grains_s W_is/Ω_i,   n_i = 1 - Σ ψ_is,   V_i = m_i/(n_i ρ_fi)

are the share of grains there, the porosity and the whole volume that the particle takes, grains included; Ω_i is the
part of its kernel that lies before walls.  The partial density m/V is n ρ_f.

Continuity.  What flows through a unit area, water and grains together, is q_i = n_i v_i + Σ ψ_is v_s.  The pore volume
balance (n/K_w) dp/dt + ∇·(n (v_f - v_s)) + ∇·v_s = 0 is then

    dρ_fi/dt = -(ρ_fi/n_i) (∇·q)_i,   (∇·q)_i = -Σ_j V_j (q_i - q_j)·∇W_ij         (j: water and walls)

which is continuity of one fluid with q for v and V for m/ρ.  A porosity that jumps needs no gradient: q does not jump.

Work.  The compression of water takes up Σ m p/ρ_f² dρ_f/dt = -Σ V_i p_i (∇·q)_i = -Σ f_i·q_i with the forces

    f_i = -V_i Σ_j V_j (p_i + p_j) ∇W_ij

of one fluid that fills the whole volume.  By what q is made of, n_i f_i of it acts on the water and Σ_i ψ_is f_i on the
soil: -n ∇p and -(1 - n) ∇p.  So kinetic energy gains what compression loses, particle by particle; forces between
the layers are opposite, and those within sum to zero, to round-off; layers that move as one compress nothing (only
differences of q enter); and a pressure without gradient moves nothing, at the surface of the soil either, where the
water's particles go on.  That would not hold for the obvious pair -∇(n p) + p ∇n, whose terms come from different
particles and cancel to a few per cent of p n/h.  Viscosity of q goes the same way as its pressure.

Drag on the water of a unit volume: -β (v_f - v_s), β = n² ρ_f g/k, where v_s is the mean of the soil about the
particle by ψ/k, and β at surfaces of the soil, which kernels smear, is sharpened (`resistance`).  With the difference A
of the other accelerations held over a time T, the relative velocity is

    w' = w e^(-κT) + A (1 - e^(-κT))/κ,   κ = β (1/n ρ_f + 1/(1-n) ρ_s)

exact, without bound on T (explicit drag needs T < 2k/(n g)), and where κT is large w' = A/κ, Darcy's law.  The impulse
that this takes from the water is given to the soil particles by the same weights.  Grid waves are safe: for
interpolation factors φ <= 1 the pair of velocities is multiplied by 1 - (1 - e^(-κT)) (a + b φ²), a + b = 1, which lies
between 0 and 1 for every T.

Eq. 46 of Maeda & Sakai 2004 as printed, drag n ρ_f g/k on a water layer of full density without the volume of the
grains (ψ = 0), has the conductivity k/n: such layers consolidate 1/n times too fast, and a step of porosity has no
effect on the water.

Parts: `Skeleton`, the soil as the water equations need it (`skeleton`);  `Overlap`, neighbours across layers
(`overlap`);  `PoreFlow`, a `Flow` of water in it (`pores`);  `PressureFace`, faces of given pressure (`pressure_face`);
`Supply`, water kept at levels (`reservoir`);  `Seepage`, both layers moving (`step`).
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
