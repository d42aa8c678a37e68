"""Compiled kernels: how functions are compiled, cached, dispatched on a law, vectorised."""
