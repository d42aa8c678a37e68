"""Soil, water and air as layers of smoothed particles: what pore-scale pictures look like from further away.

Source of the method: Maeda & Sakai 2004; where its printed equations cannot be followed, the docstrings say so.
"""
