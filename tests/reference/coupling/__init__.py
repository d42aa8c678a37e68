"""Grains in fluid: coverage by rational numbers and points, partially saturated cells, exact and direct Stokes flow."""
