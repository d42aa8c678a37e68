"""A page on which a measured pair is looked at, vector by vector."""
