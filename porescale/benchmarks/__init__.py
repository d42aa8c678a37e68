"""Rates, minimal kernels, maps of stability, overhead of the parts of a scene."""
