# The public names of porescale.dem.prepare: packings and samples of rock.
from .compaction import Compactor as Compactor
from .compaction import kept as kept
from .rock import Curve as Curve
from .rock import Kind as Kind
from .rock import Rock as Rock
from .rock import load as load
