# The public names of continuum_sph.validation.unsaturated: its topics.
from . import columns as columns
from . import richards as richards

__all__ = ["columns", "richards"]
