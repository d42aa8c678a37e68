"""Validations: experiment, exact answer and rows of `verify`, one topic a file."""
