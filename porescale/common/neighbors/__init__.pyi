# The public names of porescale.common.neighbors: pairs within a reach, lattices and seeded placement.
from .pair_list import PairList as PairList
from .placement import Placement as Placement
from .placement import place as place
from .placement import square_lattice as square_lattice
from .placement import triangular_lattice as triangular_lattice
