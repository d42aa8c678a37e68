"""Solid fraction of every cell: discs, polygons, rectangles, rings, exact to round-off."""
