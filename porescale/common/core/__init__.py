"""Errors, units, constants, machine.  No physics."""
