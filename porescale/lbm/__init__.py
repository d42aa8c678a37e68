"""D2Q9 lattice Boltzmann fluid, streamed in place.  Lattice units inside; SI at the door (scales.py)."""
