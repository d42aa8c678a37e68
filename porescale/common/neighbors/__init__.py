"""Points and the distances between them: cells, pair lists, seeded placement.  No physics.

Grains and smoothed particles use the same search; it takes positions and a reach for each, nothing else.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
