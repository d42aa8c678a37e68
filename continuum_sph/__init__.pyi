# The public names of continuum_sph, in one list: imported when first used, and what type checkers and editors see.
from .api import build as build
from .api import cases as cases
from .api import load as load
from .api import open_run as open_run
from .builders.simulation import Simulation as Simulation
from .run import Run as Run
from .scene.sections import Scene as Scene

__version__: str
__all__ = ["Run", "Scene", "Simulation", "__version__", "build", "cases", "load", "open_run"]
