"""Forces on discs: pairs, walls, plates, rectangles, segments, bonds."""
