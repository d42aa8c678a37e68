"""Elastic energy of a strained cell, contact by contact."""

import numpy as np

from porescale.dem.measures.energy import elastic_pairs
from porescale.dem.motion.periodic_cell import LOAD, Straining


def stored(grains):
    """Elastic energy of a strained cell now, J/m."""
    (width, _), (tilt, height) = grains.steering.edges()
    now = Straining(width, height, tilt, 0.0, 0.0, 0.0, np.zeros(LOAD))
    d, material = grains.discs, grains.material
    grains.current_pairs()
    parts = elastic_pairs(d.position, d.radius, material, grains.pair_arrays(), grains.contact, now)
    return float(sum(parts))
