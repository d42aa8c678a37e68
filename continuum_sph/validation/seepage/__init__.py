"""Validations of soil and water together: consolidation, permeability, levels, levees, sheet piles."""
