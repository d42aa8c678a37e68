"""The parts of a simulation: each advances, checks or records one component of a scene."""
