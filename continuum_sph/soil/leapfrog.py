"""Kernels that move soil particles one by one."""

from continuum_sph.soil.state import MASS, VOLUME, VX, VY, X, Y
from porescale.common.compiled.jit import parallel_kernel, prange


@parallel_kernel
def kick_drift(x, v, mass, density, acceleration, drift, record, half, step, lower, upper):
    """First half kick and drift of soil; overwrites x, v (n, 2) and, of ``record`` (n, 16), place, velocity, mass
    and the volume before the step: gradients and forces then have the same, which keeps angular momentum.

    v += half a;  x += step (v + drift);  half, step: s;  lower, upper (2,) m: surfaces of the walls, on which a
    particle that reaches them is put without its speed into them.  Returns how often.
    """
    stopped = 0
    for i in prange(acceleration.shape[0]):
        for axis in range(2):
            v[i, axis] += half * acceleration[i, axis]
            at = x[i, axis] + step * (v[i, axis] + drift[i, axis])
            if at < lower[axis]:
                at = lower[axis]
                v[i, axis] = max(0.0, v[i, axis])
                stopped += 1
            if at > upper[axis]:
                at = upper[axis]
                v[i, axis] = min(0.0, v[i, axis])
                stopped += 1
            x[i, axis] = at
        record[i, X] = x[i, 0]
        record[i, Y] = x[i, 1]
        record[i, VX] = v[i, 0]
        record[i, VY] = v[i, 1]
        record[i, MASS] = mass[i]
        record[i, VOLUME] = mass[i] / density[i]
    return stopped


@parallel_kernel
def kick(v, acceleration, half, kept):
    """Second half kick of soil: v = kept (v + half a).  Returns the largest |a|² (m²/s⁴) and |v|² (m²/s²)."""
    max_acceleration2 = 0.0
    max_speed2 = 0.0
    for i in prange(acceleration.shape[0]):
        ax = acceleration[i, 0]
        ay = acceleration[i, 1]
        v[i, 0] = kept * (v[i, 0] + half * ax)
        v[i, 1] = kept * (v[i, 1] + half * ay)
        max_acceleration2 = max(max_acceleration2, ax * ax + ay * ay)
        max_speed2 = max(max_speed2, v[i, 0] * v[i, 0] + v[i, 1] * v[i, 1])
    return max_acceleration2, max_speed2
