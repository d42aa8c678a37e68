"""Excess of the volume of water among grains, and how water that flows through them loses it.

The density of water follows its velocities, so its volume V = m/(n ρ) is what these have made of it.  Where water flows
into ground its particles part to 1/n of the room that they had, first along the flow, then in all directions, and sums
over neighbours miss some per cent of that.  Particles then stand nearer than their volumes allow.  Sums over water at
its own particles do not show it, as they depend on the arrangement of these as much as on their number.  Sums at the
particles of the soil do:

    c_s = Σ V_j W_sj/Ω_s - 1,   e_i = max(0, Σ V_s W_is c_s - 0.005)

is by how much water and its grains more than fill the room about a soil particle, of which Ω_s lies before walls, and
the mean of it about water.  Where water passes a side at a given pressure the edge of that room goes along with it: at
the side it left too little, and drove water out, 11 % of the flow after 0.17 spacings.  The density of water that moves
through soil at w takes the excess up,

    dρ_i/dt = ρ_i e_i 2 |w_i|/h                                                                              (added)

on half a smoothing length, and pressure drives the particles apart.  Where pores are not full, at surfaces and fronts,
c is negative and nothing is done;  nor is to air, to water at rest, and to water less than nine tenths of whose kernel
is in soil, as a river over it.
"""

import functools
import math
from typing import NamedTuple

import numpy as np

from continuum_sph.seepage.mixture import LEAST_ROOM, POROSITY, SLIP_X, SLIP_Y
from continuum_sph.water.smoothing import SUPPORT
from continuum_sph.water.state import DIFFUSIVE, VOLUME, P
from porescale.common.compiled.jit import parallel_kernel, prange
from porescale.common.core.types import Floats

PACE = 2.0
"""Smoothing length over the way on which an excess is taken up.  Of what passes under a sheet pile 5.2 % stays in the
ground with 0, 0.7 % with 2 (12 rows, 12 to 60 s).  Not derived: of the order of one, so that particles that are driven
apart stay among the neighbours that drive them.  With 0, 1, 2 and 4, in a column that water sinks 0.22 m into (15 rows,
0.6 s), the largest c left is 0.122, 0.100, 0.084 and 0.064, and the front is 3.5, 0.3, 0 and 0 mm short of that with
2."""
LET = 0.005
"""Excess that is no sign of an error: c and its mean are two sums, over square lattices each up to 1.0016, so that
0.0032 comes of the arrangement alone.  With half and twice of it that front is 0.3 mm deeper and 0.5 mm less deep, the
largest c left 0.082 and 0.091."""
BULK = 7  # column of the soil's volume with its pores
STEPS = 200  # of the integrals of a kernel, which are right to 1e-5 with them


@parallel_kernel
def fill_about_soil(fluid, near, other, weight, record, material, room, full):
    """Overwrites ``full`` (s,): c of soil particles, by how much water and its grains more than fill the room there.

    near, other, weight: the overlap, water rows first;  record (fluid…, 8): of the water, with whole volumes;  material
    (fluid…,): 0 is water;  room (s,): share of each kernel before walls.
    """
    for s in prange(full.shape[0]):
        total = 0.0
        for k in range(near[fluid + s], near[fluid + s + 1]):
            j = other[k]
            if material[j] == 0:
                total += weight[k] * record[j, VOLUME]
        full[s] = total / room[s] - 1.0


@parallel_kernel
def excess_about_water(fluid, near, soil, weight, burden, material, enclosed, full, excess):
    """Overwrites ``excess`` (fluid,): e of particles, of air and where soil does not enclose them 0;  full (s,): of
    `fill_about_soil`.

    near, soil, weight: rows of the overlap, soil numbered from ``fluid`` on;  burden (s, 8): see `skeleton.show_soil`;
    material (fluid…,): 0 is water;  enclosed (fluid,): of `mixture.find_enclosed`.
    """
    for i in prange(fluid):
        total = -LET
        if enclosed[i] and material[i] == 0:
            for k in range(near[i], near[i + 1]):
                s = soil[k] - fluid
                total += burden[s, BULK] * weight[k] * full[s]
        excess[i] = max(0.0, total)


@parallel_kernel
def take_up(fluid, mass, record, pores, excess, pace, rate, power):
    """Adds to ``rate`` (fluid,) kg/(m³ s) of densities what takes up the ``excess`` (fluid,) in 1/``pace`` (m) of the
    way of water through soil, and takes from ``power`` (fluid, 6) W/m what that gives; None without a budget.

    mass (fluid…,) kg/m;  record: see `water.state`;  pores: see `mixture`.
    """
    for i in prange(fluid):
        if excess[i] > 0.0 and mass[i] > 0.0:  # one that was taken out since is not there
            slip = np.sqrt(pores[SLIP_X, i] * pores[SLIP_X, i] + pores[SLIP_Y, i] * pores[SLIP_Y, i])
            share = excess[i] * pace * slip
            rho = mass[i] / (record[i, VOLUME] * pores[POROSITY, i])
            rate[i] += rho * share
            if power is not None:
                power[i, DIFFUSIVE] -= mass[i] * record[i, P] / rho * share


def _kernel(q: Floats) -> Floats:
    """The overlap's kernel at q = r/h, times 14 π h²/5: `smoothing.kernel_value` in NumPy."""
    outer, inner = np.maximum(SUPPORT - q, 0.0), np.maximum(1.0 - q, 0.0)
    values: Floats = outer**3 - 4.0 * inner**3
    return values


@functools.cache
def _rows(pitch: float) -> tuple[Floats, Floats]:
    """Distances over h, and the share of the overlap's kernel that rows a ``pitch`` (of h) apart have before an edge so
    far off that lies midway between two of them."""
    reach = SUPPORT + 0.5 * pitch
    at = np.linspace(-reach, reach, STEPS + 1)
    row = (np.arange(math.ceil(2.0 * reach / pitch)) + 0.5) * pitch
    along = np.linspace(-SUPPORT, SUPPORT, STEPS + 1)
    place = at[:, None] - row[None, :]
    across = _kernel(np.hypot(place[:, :, None], along)).sum(axis=(1, 2))
    return at, across / across[-1]


class Edges(NamedTuple):
    """lower, upper (2,) or, beside each place, (2, s) m: of the tank, infinite where it has no wall;  pile: where one
    stands, its bottom and half its thickness, m, or None."""

    lower: Floats
    upper: Floats
    pile: tuple[float, float, float] | None = None


def room_before(edges: Edges, x: Floats, spacing: float, h: float) -> Floats:
    """Share (s,) of the overlap's kernel of smoothing length ``h`` at ``x`` (s, 2) that lies before ``edges`` and is
    seen past a pile, in rows of a ``spacing``, all m: as if the kernel were a product of one along and one across; it
    is to 1 %."""

    def share(distance: Floats | float) -> Floats:
        """Share of the kernel on this side of an edge at a ``distance``, m."""
        values: Floats = np.interp(np.asarray(distance) / h, *_rows(spacing / h), left=0.0, right=1.0)
        return values

    room = np.ones(len(x))
    for axis in (0, 1):
        room *= share(edges.upper[axis] - x[:, axis]) - share(edges.lower[axis] - x[:, axis])
    if edges.pile is not None:
        at, bottom, half = edges.pile
        left, right = share(at - half - x[:, 0]), share(at + half - x[:, 0])
        hidden = np.where(x[:, 1] < bottom, right - left, np.where(x[:, 0] < at, 1.0 - left, right))
        room -= room * hidden * (1.0 - share(bottom - x[:, 1]))
    return np.maximum(LEAST_ROOM, room)  # of soil that has left the tank
