"""A run or a sweep watched in a browser while it is written: read as it grows, served to this machine alone."""
