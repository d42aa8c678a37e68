# The public names of continuum_sph.validation.unsaturated: its topics.
from . import columns as columns
from . import levee as levee
from . import richards as richards
from . import slices as slices
