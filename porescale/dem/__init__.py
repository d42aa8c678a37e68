"""Discrete elements: discs in contact with each other, with walls and with plates.

SI units, per metre of depth.  Independent of fluids, scenes and files.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
