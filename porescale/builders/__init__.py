"""From a scene to a simulation: the only folder that imports both sections and physics."""
