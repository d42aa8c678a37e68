# The public names of porescale.piv: measuring a flow from pictures; more in its folders estimate, fields and images.
from . import estimate as estimate
from . import fields as fields
from . import images as images
from .api import measure as measure
from .api import render as render
from .estimate.measure import Settings as Settings
from .fields.compare import compare as compare
from .fields.field import Field as Field
from .images.synth import Camera as Camera
from .images.synth import pair as pair
