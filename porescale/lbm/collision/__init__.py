"""Collision operators, one a file."""
