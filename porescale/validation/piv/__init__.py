"""Validations of displacements measured from pictures."""
