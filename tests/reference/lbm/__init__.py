"""Flow on a lattice of two arrays, and collision operators as dense matrices."""
