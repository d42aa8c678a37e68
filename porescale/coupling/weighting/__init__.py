"""Weights of partially saturated cells, one a file."""
