"""Sections of the bodies of a scene."""
