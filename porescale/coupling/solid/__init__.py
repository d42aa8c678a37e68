"""Solid operators of partially saturated cells, one a file."""
