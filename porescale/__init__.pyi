# The public names of porescale, in one list: imported when first used, and what type checkers and editors see.
from . import piv as piv
from .api import build as build
from .api import cases as cases
from .api import check as check
from .api import diff as diff
from .api import load as load
from .api import open_run as open_run
from .api import run as run
from .api import set_threads as set_threads
from .api import sweep as sweep
from .builders.scene import Scene as Scene
from .builders.simulation import Simulation as Simulation
from .common.api.open_run import Run as Run
from .common.compiled.own import body_force as body_force
from .common.compiled.own import contact_law as contact_law
from .common.compiled.own import inflow as inflow
from .common.core.constants import GRAVITY as GRAVITY
from .common.core.errors import InputError as InputError
from .common.core.errors import PorescaleError as PorescaleError
from .common.core.errors import PorescaleWarning as PorescaleWarning
from .common.core.errors import Unstable as Unstable
from .common.core.types import Floats as Floats
from .common.record.stop import Interrupted as Interrupted

__version__: str
