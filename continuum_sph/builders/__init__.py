"""From a scene to particles in motion: the only folder that imports both sections and physics."""
