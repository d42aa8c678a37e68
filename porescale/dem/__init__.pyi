# The public names of porescale.dem: discs, walls, contact laws, prescribed motion and bodies.
from .bodies.frames import chain as chain
from .bodies.frames import framed as framed
from .bodies.frames import polygon as polygon
from .contact.hertz import Hertz as Hertz
from .contact.linear import Linear as Linear
from .discs import Discs as Discs
from .discs import make_discs as make_discs
from .forces.rectangle import Rectangle as Rectangle
from .forces.walls import HIGH as HIGH
from .forces.walls import PX as PX
from .forces.walls import PY as PY
from .forces.walls import Box as Box
from .forces.walls import Plate as Plate
from .grains import Grains as Grains
from .motion.control import Control as Control
from .motion.control import Moved as Moved
from .motion.drivers import Clump as Clump
from .motion.time_function import Table as Table

__all__ = [
    "HIGH",
    "PX",
    "PY",
    "Box",
    "Clump",
    "Control",
    "Discs",
    "Grains",
    "Hertz",
    "Linear",
    "Moved",
    "Plate",
    "Rectangle",
    "Table",
    "chain",
    "framed",
    "make_discs",
    "polygon",
]
