"""Equations of state: pressure above that of the air from density.  A file for each, named as scenes name it.

A file holds the formula, its parameters, its source and what follows from it, in a class that keeps the contract
`law.StateLaw`; `register` finds it.  Nothing else has to be changed for one more.
"""
