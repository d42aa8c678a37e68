"""Numbers from scenes and finished runs: permeability, soil tests, circles in pictures."""
