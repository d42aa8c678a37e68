"""The fluid on a graphics device: the CPU's functions of a cell and of a link, one thread each."""
