"""Constants of nature used by default, SI."""

GRAVITY = 9.81
"""Standard acceleration of free fall, m/s² (rounded; scenes may set their own)."""
