"""Quantities that laboratories measure on granular matter, one per file.  Rectangular regions; SI per metre of depth.

Compression is positive, as in soil mechanics.  Nothing here changes the state.
"""
