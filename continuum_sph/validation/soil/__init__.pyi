# The public names of continuum_sph.validation.soil: its topics.
from . import bodies as bodies
from . import element as element
from . import energy as energy
from . import fast_flow as fast_flow
from . import rods as rods
from . import run_outs as run_outs
from . import setups as setups
from . import side_walls as side_walls
from . import slides as slides
from . import slopes as slopes
