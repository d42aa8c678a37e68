"""Scenes: typed sections, what they imply, and the simulation assembled from just the parts they request."""
