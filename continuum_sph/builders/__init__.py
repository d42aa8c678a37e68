"""From a scene to particles in motion: the only folder that imports both sections and physics."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
