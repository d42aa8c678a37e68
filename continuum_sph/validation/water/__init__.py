"""Validations of water alone: kernels, rest, channels, sound, vortices, drops, a dam that breaks."""
