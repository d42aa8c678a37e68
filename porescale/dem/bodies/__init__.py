"""Rigid bodies made of discs or of line segments."""
