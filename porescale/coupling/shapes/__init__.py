"""Bodies of the lattice that are no discs, one file each; a body is a filler of a patch of solid fractions."""
