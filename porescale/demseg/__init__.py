"""Decks of DEMseg, Matsushima's program of discrete elements in two dimensions: read, run unit-free, written back.

Source: Matsushima, DEMseg tutorial (the layouts of in_gm.dat, in_bc.dat and in_cf0.dat in I-2, I-3, I-7 and II-3).
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
