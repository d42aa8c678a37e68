"""Rows of validations and benchmarks, timing, memory bandwidth, maps of stability."""
