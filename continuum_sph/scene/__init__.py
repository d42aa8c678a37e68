"""Scenes of the continuum: typed sections, particles and quantities derived from them, trials and validations."""
