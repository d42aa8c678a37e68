"""continuum_sph: soil, water and air as layers of smoothed particles, the continuum beside the grains of porescale.

from continuum_sph import build, load, open_run
simulation = build(load("cases/collapsing_water_column", quality="draft"))
simulation.advance(100)

Source of the method: Maeda & Sakai 2004; where its equations cannot be followed, the docstrings say so.
"""

import lazy_loader

from porescale.common.core.version import VERSION

__version__ = VERSION
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
__all__ = [*__all__, "__version__"]
