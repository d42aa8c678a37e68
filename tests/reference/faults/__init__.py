"""Faults on purpose: kills, failing disks, spoiled files, wrong numbers in a state, scenes that are nearly right."""
