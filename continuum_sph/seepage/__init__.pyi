# The public names of continuum_sph.seepage: water in the pores of soil.
from .pores import PoreFlow as PoreFlow
from .pressure_face import PressureFace as PressureFace
from .reservoir import Reservoir as Reservoir
from .reservoir import Supply as Supply
from .resistance import Resistance as Resistance
from .skeleton import Frame as Frame
from .skeleton import Skeleton as Skeleton
from .skeleton import skeleton_of as skeleton_of
from .step import Seepage as Seepage
