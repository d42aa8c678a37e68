"""Measured fields: files, comparison, vortices, surfaces, pictures."""
