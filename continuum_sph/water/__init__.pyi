# The public names of continuum_sph.water: layers of water and air in motion.
from .eos.liquid import Tait as Tait
from .smoothing import Smoothing as Smoothing
from .state import Layer as Layer
from .step import Flow as Flow
