"""The initial state of a simulation, built from the sections of a scene."""
