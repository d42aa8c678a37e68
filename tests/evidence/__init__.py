"""Figures of docs/evidence that are drawn of what cases and studies keep."""
