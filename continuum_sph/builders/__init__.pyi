# The public names of continuum_sph.builders: parts of a simulation, and what they are made of.
from .parts.material import material_of as material_of
from .parts.soil import SoilPart as SoilPart
from .parts.soil import geostatic as geostatic
from .parts.water import wall_layers as wall_layers
from .parts.water import water_flow as water_flow
