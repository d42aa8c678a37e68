"""Constants that more than one file needs: of nature, SI, by default, and of round-off."""

GRAVITY = 9.81
"""Standard acceleration of free fall, m/s² (rounded; scenes may set their own)."""
EDGE = 1e-9
"""Relative slack of edges that touch: 8 mm + 4 mm is 12 mm whatever its last bit."""
