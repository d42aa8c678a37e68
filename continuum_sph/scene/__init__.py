"""Scenes of the continuum: typed sections, particles made from them, what is known of them, trials and validations."""
