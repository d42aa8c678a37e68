"""Discrete elements: discs in contact with each other, with walls and with plates.

SI units, per metre of depth.  Independent of fluids, scenes and files.
"""
