"""Discrete elements: discs in contact with each other, with walls and with plates.

SI units, per metre of depth.  Floor 2: knows nothing of fluids, scenes or files.
"""
