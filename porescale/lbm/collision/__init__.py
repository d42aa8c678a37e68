"""Collision operators of the lattice-Boltzmann method, one per file."""
