# The public names of porescale, in one list: imported when first used, and what type checkers and editors see.
from .api import build as build
from .api import load as load
from .api import open_run as open_run
from .builders.scene import Scene as Scene
from .builders.simulation import Simulation as Simulation
from .common.core.errors import InputError as InputError
from .common.core.errors import PorescaleError as PorescaleError
from .common.core.errors import PorescaleWarning as PorescaleWarning
from .common.core.errors import Unstable as Unstable

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
