"""Bodies in a fluid on a graphics device: the CPU's functions of a cell and of a row of a body, one thread each."""
