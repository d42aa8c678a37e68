"""porescale: round grains in a viscous fluid at the scale of single pores, in two dimensions."""

__version__ = "0.1.0"
