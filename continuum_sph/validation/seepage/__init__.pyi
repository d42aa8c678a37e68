# The public names of continuum_sph.validation.seepage: its topics.
from . import air as air
from . import bare_exit as bare_exit
from . import consolidation as consolidation
from . import dam as dam
from . import heave as heave
from . import infiltration as infiltration
from . import levee as levee
from . import open_water as open_water
from . import overtopping as overtopping
from . import permeability as permeability
from . import permeameter as permeameter
from . import saturated_box as saturated_box
from . import setups as setups
from . import sheet_pile as sheet_pile
from . import wet_slopes as wet_slopes
from . import wetting as wetting
