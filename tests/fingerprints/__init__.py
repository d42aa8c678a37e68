"""Fingerprints: hashes of whole states after some hundred steps, to be equal before and after a change of the code."""
