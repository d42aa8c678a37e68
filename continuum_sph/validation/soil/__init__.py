"""Validations of soil alone: one element, free bodies, slopes, energy."""
