"""Measuring a flow from pictures of it: synthetic pictures with exact displacements, window correlation, comparison.

Pixel centres lie at integers and y points down.  A displacement is X(+1/2) - X(-1/2), in pixels, of the material that
is at the pixel halfway in time between two pictures.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
