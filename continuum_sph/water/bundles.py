"""What kernels of smoothed particles read, in flat NamedTuples of arrays and numbers.

A kernel is compiled for the types of what it is given.  Where a scene has no use for an array it is None, and so is the
entry of its bundle: the kernel is then compiled without it.  numba decides that where a function has the array for an
argument of its own, and not for an entry of a tuple; so what depends on one is a small function that is given it,
and is merged into the kernel.  Loops over threads take no tuples within tuples: bundles are flat.  What such a
loop itself writes to is an argument of the kernel's own: numba takes an entry of a tuple for a value of the iteration,
and may drop what is stored in it.  (It does not where a function that is called stores it.)
"""

from typing import Any, NamedTuple

import numpy as np

from porescale.common.compiled.jit import inline
from porescale.common.compiled.simd import rint
from porescale.common.neighbors.cells import minimum_image


class Neighbours(NamedTuple):
    """The neighbour list, and the kernel of the sums over it.

    start (n + 1,), split (n,), partner (m,): a full list; partners of particle i are
    ``partner[start[i]:start[i + 1]]``, those that are walls from ``split[i]`` on;  period_x, period_y: m, 0 where the
    domain ends; both None where it ends on all sides;  kind: of `smoothing`, None for Wendland's where that is to be
    compiled in;  h: smoothing length, m.
    """

    start: Any
    split: Any
    partner: Any
    period_x: Any
    period_y: Any
    kind: Any
    h: Any


class Fluids(NamedTuple):
    """The fluids of a layer.

    table (m, 9): a row for each, see `fluids`;  properties (fluid, 2): number and viscosity (Pa s) of each particle's,
    None for one fluid;  lengths (n, 2): smoothing length of each particle, m, in the first column, None where all have
    the same;  mass (n,) kg/m, None where it is not needed.
    """

    table: Any
    properties: Any
    lengths: Any
    mass: Any


class Choices(NamedTuple):
    """The numbers of a flow's law that the pass over pairs takes.

    gravity_x, None where it is 0, and gravity_y, m/s²;  alpha, beta, None for 0, and softening: of artificial
    viscosity;  diffusion: 2 δ h of the density diffusion, m;  noise_speed, m/s: of `density.noise_scale`;  noise:
    what diffusion takes for noise, of `density`;  cohesive: None without cohesion;  xsph: ε of eq. 53, for
    Σ (m_j/ρ̄)(v_j - v_i) W, the sign that smooths; None without XSPH;  lattice: what plain sums are multiplied by,
    `kernel_correction.lattice_gradient`; None with corrected ones.
    """

    gravity_x: Any
    gravity_y: Any
    alpha: Any
    beta: Any
    softening: Any
    diffusion: Any
    noise_speed: Any
    noise: Any
    cohesive: Any
    xsph: Any
    lattice: Any


class Walls(NamedTuple):
    """Walls beside a fluid; see `state.Layer`.

    material (n,): 0 for wall particles that hold the fluid, None where none does;  ghost (n, 2) m/s: velocity that
    makes fluid stick, None without walls that hold it or with image walls;  facing (n, 4): of image walls, else None.
    """

    material: Any
    ghost: Any
    facing: Any


class Gradients(NamedTuple):
    """What `neighbourhood_moments` makes.

    matrix (fluid, 4): gradient correction, None for plain gradients;  density (fluid, 2) kg/m⁴: gradient of density
    within the fluid, None where neither diffusion nor shifting needs it;  drift (fluid, 2) m/s: shifting velocity,
    None without shifting.
    """

    matrix: Any
    density: Any
    drift: Any


@inline
def row(number):
    """The ``number`` of a loop over threads, of one type wherever it is read.

    numba takes the loop's own number for signed first and for unsigned in the loop it makes of it, and compiles all
    that is given it twice.
    """
    return int(np.uint64(number))


@inline
def inverse_period(period):
    """1/period, 1/m; 0 for a period of 0 or None."""
    if period is None:
        return 0.0
    return 1.0 / period if period > 0.0 else 0.0


@inline
def nearest_image(d, period, inverse):
    """Distances ``d`` (m), several at once, to the nearest images;  inverse: of `inverse_period`."""
    if period is None:
        return d
    return d - period * rint(d * inverse)


@inline
def image(d, period):
    """The component ``d`` of a distance vector, m, to the nearest periodic image."""
    if period is None:
        return d
    return minimum_image(d, period)


@inline
def plus_scaled(value, factor, share, more):
    """value + factor · share · more; ``value`` itself where ``factor`` is None.

    One function: where one gives a number or None, numba takes that for either wherever it is read.
    """
    if factor is None:
        return value
    return value + factor * share * more


@inline
def plus(value, more):
    """The sum of ``value`` and ``more``; ``value`` itself where ``more`` is None."""
    if more is None:
        return value
    return value + more
