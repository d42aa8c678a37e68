"""Particles of continuum_sph: sums over all pairs, seepage by other methods, and kernels as plain Python."""
