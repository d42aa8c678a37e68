"""Validations of the grains."""
