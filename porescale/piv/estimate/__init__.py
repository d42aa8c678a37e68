"""Displacements from pictures: window correlation, spline fit, outliers."""
