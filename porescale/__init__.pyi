# The public names of porescale, in one list: imported when first used, and what type checkers and editors see.
from .api import build as build
from .api import load as load
from .api import open_run as open_run
from .builders.scene import Scene as Scene
from .builders.simulation import Simulation as Simulation
from .common.compiled.own import body_force as body_force
from .common.compiled.own import contact_law as contact_law
from .common.compiled.own import inflow as inflow

__version__: str
__all__ = ["Scene", "Simulation", "__version__", "body_force", "build", "contact_law", "inflow", "load", "open_run"]
