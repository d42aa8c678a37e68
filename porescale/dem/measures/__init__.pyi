# The public names of porescale.dem.measures: what is measured on grains.
from .coarse_graining import CoarseGrained as CoarseGrained
from .coarse_graining import Raster as Raster
from .contacts import contacts as contacts
from .energy import energy_budget as energy_budget
from .network import stiffness as stiffness
from .network import voigt as voigt
from .survey import centre_of_mass as centre_of_mass
