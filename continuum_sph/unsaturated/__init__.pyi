# The public names of continuum_sph.unsaturated: soil whose pores are partly full.
from .outside import Level as Level
from .outside import Outside as Outside
from .retention import VanGenuchten as VanGenuchten
from .richards import Moisture as Moisture
from .step import MoistSoil as MoistSoil
