# The public names of continuum_sph.validation.water: its topics.
from . import channels as channels
from . import dam_break as dam_break
from . import drop_swing as drop_swing
from . import flows as flows
from . import fluids as fluids
from . import hydrostatics as hydrostatics
from . import kernels as kernels
from . import momentum as momentum
from . import setups as setups
from . import sound as sound
