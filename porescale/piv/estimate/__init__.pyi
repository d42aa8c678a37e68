# The public names of porescale.piv.estimate: displacements between two pictures.
from .measure import Settings as Settings
from .measure import Vectors as Vectors
from .measure import measure as measure
