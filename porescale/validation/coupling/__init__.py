"""Validations of grains in fluid."""
