"""Quantities that laboratories measure on granular matter, one per file.  Rectangular regions; SI per metre of depth.

Compression is positive, as in soil mechanics.  Nothing here changes the state.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
