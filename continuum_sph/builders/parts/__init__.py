"""The parts of a simulation, and what builds them: each advances, checks or records one component of a scene."""
