"""porescale: round grains in a viscous fluid at the scale of single pores, in two dimensions.

from porescale import build, load, open_run
simulation = build(load("cases/column_collapse", quality="draft"))
simulation.advance(100)
"""

import lazy_loader

from porescale.common.core.version import VERSION

__version__ = VERSION
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
__all__ = [*__all__, "__version__"]
