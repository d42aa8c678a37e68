"""Rates, minimal kernels, extremes, endurance, overhead of the parts of a scene."""
