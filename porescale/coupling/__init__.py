"""Coupling of fluid and grains: partially saturated cells and hydrodynamic loads.  Contains no other physics."""
