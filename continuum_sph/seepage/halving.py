"""Water that comes into ground from the open, in two halves.

A particle of open water has the mass of a square spacing of it, water in pores at the start n times that.  What comes
in stands 1/√n as far apart, is as much coarser, and so are all sums over it: in ground of 16 rows under half the head
that lifts it, with n = 0.4, a sheet pile let 0.97 of the discharge pass at first, and 0.92 after 17 to 25 s, when all
water about its tip had come from the open; the exit gradient beside it had fallen from 0.95 to 0.85.

So a particle that soil encloses is parted where it has more than HEAVY times the water that pores hold per square
spacing.  Halves have the velocity and density of the whole and lie a quarter of its width before and behind it, along
its way through the soil: along it water has parted by 1/n as it came in.  Mass, momentum, their centre and the density
stay as they are.  With n between a third and two thirds it is parted once.  Halves that come into the open stay halves.
"""

import numpy as np

from continuum_sph.seepage.mixture import INSIDE, ROOM, SOIL
from continuum_sph.seepage.pores import PoreFlow

HEAVY = 1.5
"""Mass over that of full pores from which on a particle is parted: its halves are not below 0.75, and particles in full
pores are within a factor of two of each other.  With n = 0.4 any number from 1.25 to 2.5 does the same."""
COPIED = ("v", "density", "predicted", "rate", "rate_before", "smoothed", "drift")
"""What halves have of the whole."""


def halve(flow: PoreFlow, whole: float, reserve: int) -> None:
    """Part particles of water of a ``flow`` that are too heavy for the pores they are in, as far as there are particles
    without mass beyond a ``reserve``;  whole : mass of one in the open, kg/m.

    Overwrites x, mass and what is in COPIED of both halves, and excess and `renewed` of the new one.
    """
    layer, n = flow.layer, flow.layer.fluid
    mass, porosity = layer.mass[:n], flow.porosity
    enclosed = flow.pores[SOIL, :n] > INSIDE * flow.pores[ROOM, :n]
    heavy = np.flatnonzero(enclosed & (mass > HEAVY * whole * porosity) & (layer.material[:n] == 0))
    if not len(heavy):
        return
    free = np.flatnonzero(mass == 0.0)
    count = min(len(heavy), len(free) - reserve)
    if count <= 0:
        return
    one, other = heavy[:count], free[:count]
    way = flow.slip[one].copy()
    speed = np.hypot(way[:, 0], way[:, 1])
    way[speed == 0.0], speed[speed == 0.0] = (0.0, 1.0), 1.0
    width = np.sqrt(mass[one] / (porosity[one] * layer.density[one]))
    step = (0.25 * width / speed)[:, None] * way
    layer.x[other] = layer.x[one] + step
    layer.x[one] -= step
    layer.mass[one] *= 0.5
    layer.mass[other] = layer.mass[one]
    for name in COPIED:
        values = getattr(layer, name)
        values[other] = values[one]
    flow.excess[other] = flow.excess[one]
    layer.renewed[other] = True
