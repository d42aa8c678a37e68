"""Boundary conditions of the lattice: sides of the box, one kind a file, and plates without thickness."""
