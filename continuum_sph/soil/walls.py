"""Walls of dummy particles that carry the stress of the soil before them and move as its image.

Stress: kernel average over soil, plus what its weight adds from there to the wall particle, ρ b·Δx along b and K0 times
that across it, b = g + f/m.  Where walls hold the soil its shear goes on into the wall; where it slips past them it is
reversed, so that none acts on the surface.  Velocity: that of soil mirrored at the wall, times the distances of both
from its surface: linear in the distance, 0 at the surface.  Where soil slips only the part across the wall is.
Source: Adami, Hu & Adams, J. Comput. Phys. 231 (2012) 7057, for pressure; stress along the lines of Bui & Fukagawa,
Int. J. Numer. Anal. Meth. Geomech. 37 (2013) 31.  A wall does not pull.
"""

import numpy as np

from continuum_sph.soil.gradient import before
from continuum_sph.soil.material import AREA, DENSITY, SHEAR
from continuum_sph.soil.state import MASS, TXX, TXY, TYX, TYY, VOLUME, VX, VY, X, Y
from continuum_sph.soil.stress import XX, XY, YY, ZZ
from continuum_sph.water.bundles import image
from continuum_sph.water.smoothing import kernel_value
from porescale.common.compiled.jit import parallel_kernel, prange

HOLDING, SLIPPING = 0, 1
"""Materials of wall particles."""
FARTHEST = 3.0  # largest ratio of the distances of a wall particle and of the soil before it that its image follows


@parallel_kernel
def update_walls(soil, near, v, mass, stress, force, material, table, facing, record, gx, gy):
    """What soil reads of walls (rows ``soil`` on); overwrites their rows of ``stress`` (n, 4) Pa and ``record``
    (n, 16).

    near: see `water.bundles`;  v (n, 2) m/s, mass (n,) kg/m, force (soil, 2) N/m, material, facing: see `state.Soil`;
    table: the materials;  gx, gy: gravity, m/s².
    """
    kind, h = near.kind, near.h
    for w in prange(soil, record.shape[0]):
        wx = record[w, X]
        wy = record[w, Y]
        nx = facing[w, 2]
        ny = facing[w, 3]
        weight = 0.0
        xx = 0.0
        yy = 0.0
        xy = 0.0
        zz = 0.0
        ux = 0.0
        uy = 0.0
        front = 0.0
        for k in range(np.uint64(near.start[w]), np.uint64(near.split[w])):
            j = np.uint64(near.partner[k])
            dx = image(wx - record[j, X], near.period_x)
            dy = image(wy - record[j, Y], near.period_y)
            if not before(facing, w, wx - dx, wy - dy):
                continue
            value = kernel_value(kind, np.sqrt(dx * dx + dy * dy) / h, h)
            row = table[material[j]]
            rest = (row[AREA] - row[SHEAR]) / (row[AREA] + row[SHEAR])
            bx = gx + force[j, 0] / mass[j]
            by = gy + force[j, 1] / mass[j]
            b2 = bx * bx + by * by
            more = mass[j] / record[j, VOLUME] * (bx * dx + by * dy)
            along = (1.0 - rest) / b2 if b2 > 0.0 else 0.0
            xx += value * (stress[j, XX] + more * (rest + along * bx * bx))
            yy += value * (stress[j, YY] + more * (rest + along * by * by))
            xy += value * (stress[j, XY] + more * along * bx * by)
            zz += value * (stress[j, ZZ] + more * rest)
            ux += value * (record[j, VX] - v[w, 0])
            uy += value * (record[j, VY] - v[w, 1])
            front += value * ((wx - dx - facing[w, 0]) * nx + (wy - dy - facing[w, 1]) * ny)
            weight += value
        if weight > 0.0:
            part = 1.0 / weight
            xx *= part
            yy *= part
            xy *= part
            zz *= part
            behind = (facing[w, 0] - wx) * nx + (facing[w, 1] - wy) * ny
            ratio = FARTHEST
            if front * FARTHEST > behind * weight:
                ratio = behind * weight / front
            if material[w] == SLIPPING:
                across = (ratio + 1.0) * (ux * nx + uy * ny)
                ux = part * (ux - across * nx)
                uy = part * (uy - across * ny)
                shear = (yy - xx) * nx * ny + xy * (nx * nx - ny * ny)
                xx += 4.0 * shear * nx * ny
                yy -= 4.0 * shear * nx * ny
                xy -= 2.0 * shear * (nx * nx - ny * ny)
            else:
                ux *= -ratio * part
                uy *= -ratio * part
            push = xx * nx * nx + 2.0 * xy * nx * ny + yy * ny * ny
            if push < 0.0:
                xx -= push * nx * nx
                xy -= push * nx * ny
                yy -= push * ny * ny
        stress[w, XX] = xx
        stress[w, YY] = yy
        stress[w, XY] = xy
        stress[w, ZZ] = zz
        record[w, VX] = v[w, 0] + ux
        record[w, VY] = v[w, 1] + uy
        record[w, TXX] = xx
        record[w, TXY] = xy
        record[w, TYX] = xy
        record[w, TYY] = yy


@parallel_kernel
def place_walls(soil, x, v, mass, table, facing, record, step):
    """Move walls (rows ``soil`` on) by ``step`` (s) at their own velocity; overwrites their rows of ``x`` (n, 2) m,
    ``facing`` (n, 4) and, of ``record`` (n, 16), place, mass and volume, which is that of the first material."""
    for w in prange(soil, x.shape[0]):
        for axis in range(2):
            x[w, axis] += step * v[w, axis]
            facing[w, axis] += step * v[w, axis]
        record[w, X] = x[w, 0]
        record[w, Y] = x[w, 1]
        record[w, MASS] = mass[w]
        record[w, VOLUME] = mass[w] / table[0, DENSITY]
