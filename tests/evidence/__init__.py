"""Figures of docs/evidence that are drawn of what cases keep."""
