"""Validations of the fluid."""
