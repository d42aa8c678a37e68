# The public names of continuum_sph.builders: parts of a simulation, and what they are made of.
from .soil import SoilPart as SoilPart
from .soil import geostatic as geostatic
from .soil import material_of as material_of
from .water import wall_layers as wall_layers
from .water import water_flow as water_flow

__all__ = ["SoilPart", "geostatic", "material_of", "wall_layers", "water_flow"]
