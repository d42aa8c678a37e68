"""Validations of soil whose pores are partly full: Richards' equation, slopes by slices."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
