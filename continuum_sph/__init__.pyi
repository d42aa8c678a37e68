# The public names of continuum_sph, in one list: imported when first used, and what type checkers and editors see.
from .api import InputError as InputError
from .api import Interrupted as Interrupted
from .api import PorescaleError as PorescaleError
from .api import PorescaleWarning as PorescaleWarning
from .api import Unstable as Unstable
from .api import build as build
from .api import cases as cases
from .api import check as check
from .api import diff as diff
from .api import load as load
from .api import open_run as open_run
from .api import run as run
from .api import set_threads as set_threads
from .api import sweep as sweep
from .builders.simulation import Simulation as Simulation
from .run_folder import Run as Run
from .scene.sections import Scene as Scene

__version__: str
