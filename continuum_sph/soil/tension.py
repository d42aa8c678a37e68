"""What keeps soil that bears tension in one piece: particles under tension repel each other at short range.

Under tension smoothed particles pair up, and the pairs part from each other: zig-zags, which gradients do not see, grow
as √(T/ρ)/h, and damping, which goes with sound, stops only those of small tension T.  The cure is a repulsion of short
range,

    m_i dv_i/dt += -Σ V_i V_j A (f⁴ - 1) (T_i + T_j) ∇_i W   where f = W(r)/W(spacing) > 1

T being the tension of a particle, its smallest principal stress with the sign turned.  Source: Monaghan, J. Comput.
Phys. 159 (2000) 290; Gray, Monaghan & Swift, Comput. Methods Appl. Mech. Eng. 190 (2001) 6641, with f⁴ at any distance
and along the axes of stress.  That pushes even where nothing is wrong, and takes 45 % more stress for the same load;
here particles a spacing apart do not push, and what pushes does so along the pair, which keeps angular momentum.
A bar that spins bears tension of 2 % of its stiffness so, and flies to pieces at 4 %; without repulsion at 0.5 %.  Soil
without cohesion has no tension to act on, and soil that cannot yield is left alone.
"""

import numpy as np

from continuum_sph.soil.state import MASS, VOLUME, X, Y
from continuum_sph.soil.stress import XX, XY, YY
from continuum_sph.water.bundles import image
from continuum_sph.water.smoothing import kernel_value, slope_scale, slope_shape
from porescale.common.compiled.jit import inline, parallel_kernel, prange


@inline
def tension_of(stress, i):
    """Tension (Pa) of particle i: what its smallest principal stress, compression positive, lies below zero."""
    half = 0.5 * (stress[i, XX] - stress[i, YY])
    r = np.sqrt(half * half + stress[i, XY] * stress[i, XY])
    return max(0.0, r - 0.5 * (stress[i, XX] + stress[i, YY]))


@parallel_kernel
def repel_under_tension(soil, record, stress, acceleration, near, spacing, strength):
    """Adds to ``acceleration`` (soil, 2) m/s² what pushes particles under tension apart.

    record, stress: see `state.Soil`;  near: see `water.bundles`;  spacing, m;  strength: A.
    """
    kind, h = near.kind, near.h
    scale = slope_scale(kind, h)
    inverse_h = 1.0 / h
    nearest = spacing * inverse_h
    whole = 1.0 / kernel_value(kind, nearest, h)
    for i in prange(soil):
        own = tension_of(stress, i)
        ax = 0.0
        ay = 0.0
        for k in range(np.uint64(near.start[i]), np.uint64(near.split[i])):
            j = np.uint64(near.partner[k])
            pull = own + tension_of(stress, j)
            if pull == 0.0:
                continue
            dx = image(record[i, X] - record[j, X], near.period_x)
            dy = image(record[i, Y] - record[j, Y], near.period_y)
            q = np.sqrt(dx * dx + dy * dy) * inverse_h
            if q >= nearest:
                continue
            closer = kernel_value(kind, q, h) * whole
            closer *= closer
            push = pull * (closer * closer - 1.0) * record[j, VOLUME] * scale * slope_shape(kind, q)
            ax -= push * dx
            ay -= push * dy
        part = strength * record[i, VOLUME] / record[i, MASS]
        acceleration[i, 0] += part * ax
        acceleration[i, 1] += part * ay
