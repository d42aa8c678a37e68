"""Sweeps and studies of speed against accuracy: points, runner, fronts, quality levels."""
