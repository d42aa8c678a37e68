# The public names of porescale.validation.piv: its topics.
from . import pairs as pairs
from . import surfaces as surfaces
