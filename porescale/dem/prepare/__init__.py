"""Packings: settled, compressed, merged; rock made of a packing."""
