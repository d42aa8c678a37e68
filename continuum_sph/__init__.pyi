# The public names of continuum_sph, in one list: imported when first used, and what type checkers and editors see.
from .api import InputError as InputError
from .api import PorescaleError as PorescaleError
from .api import PorescaleWarning as PorescaleWarning
from .api import Unstable as Unstable
from .api import build as build
from .api import load as load
from .api import open_run as open_run
from .builders.simulation import Simulation as Simulation
from .scene.sections import Scene as Scene

__version__: str
__all__ = [
    "InputError",
    "PorescaleError",
    "PorescaleWarning",
    "Scene",
    "Simulation",
    "Unstable",
    "__version__",
    "build",
    "load",
    "open_run",
]
