# The public names of porescale.piv.fields: measured fields, their comparison and vortices.
from .compare import Comparison as Comparison
from .compare import compare as compare
from .field import Field as Field
from .field import in_metres as in_metres
from .field import in_pixels as in_pixels
from .of_run import field_of_run as field_of_run
from .vortices import Vortex as Vortex
from .vortices import vortices as vortices
