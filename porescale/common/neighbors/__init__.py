"""Points and the distances between them: cells, pair lists, seeded placement.  No physics.

Grains and smoothed particles use the same search; it takes positions and a reach for each, nothing else.
"""

from porescale.common.neighbors.pair_list import PairList
from porescale.common.neighbors.placement import Placement, place, square_lattice, triangular_lattice

__all__ = ["PairList", "Placement", "place", "square_lattice", "triangular_lattice"]
