"""Densities and stresses of soil particles from their velocity gradients.

Gradients come from the positions at the end of a step and the velocities of its middle, G' = ∂v½/∂x(t + Δt).  Those of
the middle are G = G' (1 - Δt/2 G')⁻¹, and skew for every rigid turning, where G' is off by the strain Δt ω²/2: a block
turned by 90° would strain itself.  Density: ρ' = ρ det(1 - Δt G'), exact for uniform G', and less by the volume that
diffused to a particle, see `momentum`.

Density follows velocities, so it does not see particles that shear has brought nearer to each other than a lattice has
them: rows that slide over each other stand as equilateral triangles do, 2/√3 times as dense, and what slides far sinks.
So where `CROWD` is more than a lattice's (`parameters.even_crowd`), stress takes soil to have lost the excess per shear
strain, tr G less γ' (CROWD/even - 1)⁺, and pushes until it has its room.  Soil that is not sheared has none of it.

What pushes is T = σ K + t J, t = rest σ : J (1 - M)/tr M, so that Σ V σ : G is the work of T in the plain sums for
any velocities: see `gradient` for J and rest.  Rigid turning takes no work, and forces no angular momentum.
"""

from typing import Any, NamedTuple

import numpy as np

from continuum_sph.soil.material import AREA, SHEAR, stiffness_share
from continuum_sph.soil.plasticity import new_stress
from continuum_sph.soil.state import GXX, GXY, GYX, GYY, SHEAR_RATE, SOUND_OVER_DENSITY, TXX, TXY, TYX, TYY, VOLUME
from porescale.common.compiled.jit import parallel_kernel, prange

XX, YY, XY, ZZ, GROWN, EXCESS, CROWD = range(7)
"""Columns of a stress, Pa, compression positive; of what diffuses, that of the volume, m²/s; the mean p of the
surroundings less p, Pa; and how crowded a place is: Σ -(1/r) W' spacing² of its partners over the integral."""

DAMPED_MOST = 0.9
"""Largest α c Δt/h of damping times `CROWD` with which no wave of a lattice swings ever wider, 2/2.19 (see
`parameters.DAMPED`): what damping takes of a zig-zag goes with the same sum, so beyond it is weaker by as much."""
CROWDED = 1.6
"""A place's `CROWD` up to which diffusion is bounded by the step alone, see `parameters.SoilLaw.most`."""


class Straining(NamedTuple):
    """step, s;  spreading: for how long diffusion lasts, s;  spin: 1, or -1 for the sign of eq. 38 in Maeda & Sakai
    2004;  most: shear strain of a step that `accelerate` follows;  damping: α/h, 1/m;  even: `CROWD` beyond which
    sheared soil swells;  plastic: stress diffuses by plastic shear strain, not by all of it;
    bearing: mean stress from which on soil counts as bearing, Pa."""

    step: Any
    spreading: Any
    spin: Any
    most: Any
    damping: Any
    even: Any
    plastic: Any
    bearing: Any


@parallel_kernel
def deform(
    density, stress, material, table, matrix, spread, separation_strain, plastic_shear, sheared, swells, record,
    straining,
):  # fmt: skip
    """Overwrites, of soil, ``density`` (soil,) kg/m³, ``stress`` (n, 4) Pa, ``separation_strain``, ``plastic_shear``
    (soil,), ``swells`` (soil, 2), T of `seepage.swelling` in 1/s and 1 where soil yields and bears stress, or empty,
    and in ``record`` (n, 16) c/ρ, less where damping would take more than a step follows, rate of shear strain
    (of plastic strain, if ``straining.plastic``) and σ·K.  Where soil softens ``sheared`` (soil,) is overwritten by the
    plastic shear strain of the step, and ``plastic_shear`` is left; else it is empty.

    material, table, matrix: see `state.Soil`;  spread (soil, 7) Pa/s, m²/s, Pa and 1: diffusion of stress and
    volume, mean p of the surroundings less p, and crowd, of `accelerate`;  straining: see `Straining`.  Returns the
    largest c², m²/s²; a maximum is exact in any order.
    """
    step, spreading, spin, most = straining.step, straining.spreading, straining.spin, straining.most
    max_sound2 = 0.0
    for i in prange(density.shape[0]):
        row = table[material[i]]
        axx = record[i, GXX]
        axy = record[i, GXY]
        ayx = record[i, GYX]
        ayy = record[i, GYY]
        half = 0.5 * step
        whole = 1.0 / ((1.0 - half * axx) * (1.0 - half * ayy) - half * half * axy * ayx)
        gxx = whole * (axx * (1.0 - half * ayy) + half * axy * ayx)
        gyy = whole * (ayy * (1.0 - half * axx) + half * axy * ayx)
        gxy = whole * axy
        gyx = whole * ayx
        shearing = np.sqrt((gxx - gyy) * (gxx - gyy) + (gxy + gyx) * (gxy + gyx))
        swelling = 0.5 * shearing * max(0.0, spread[i, CROWD] / straining.even - 1.0)  # along each axis
        strain_xy = 0.5 * (gxy + gyx)
        turn_xy = 0.5 * spin * (gxy - gyx)
        xx, yy, xy, zz, opened, flow = new_stress(
            (
                stress[i, XX] + spreading * spread[i, XX], stress[i, YY] + spreading * spread[i, YY],
                stress[i, XY] + spreading * spread[i, XY], stress[i, ZZ] + spreading * spread[i, ZZ],
            ),
            spread[i, EXCESS], (gxx - swelling, strain_xy + turn_xy, strain_xy - turn_xy, gyy - swelling), step,
            separation_strain[i], plastic_shear[i], row,
        )  # fmt: skip
        shrunk = (1.0 - step * axx) * (1.0 - step * ayy) - step * step * axy * ayx
        density[i] *= shrunk * record[i, VOLUME] / (record[i, VOLUME] + spreading * spread[i, GROWN])
        stress[i, XX] = xx
        stress[i, YY] = yy
        stress[i, XY] = xy
        stress[i, ZZ] = zz
        separation_strain[i] = opened
        if sheared.shape[0] > 0:
            sheared[i] = flow
        else:
            plastic_shear[i] += flow
        share = stiffness_share(0.5 * (xx + yy), row)
        if swells.shape[0] > 0:
            diffused = 0.5 * (spread[i, XX] + spread[i, YY]) * (spreading / step if step > 0.0 else 0.0)
            swells[i, 0] = axx + ayy - diffused / (row[AREA] * share)
            swells[i, 1] = 1.0 if flow > 0.0 and opened == 0.0 and xx + yy > 2.0 * straining.bearing else 0.0
        speed2 = (row[AREA] + row[SHEAR]) * share / density[i]
        max_sound2 = max(max_sound2, speed2)
        kxx = matrix[i, 0]
        kxy = matrix[i, 1]
        kyy = matrix[i, 2]
        taken = straining.damping * np.sqrt(speed2) * step * max(1.0, spread[i, CROWD])
        record[i, SOUND_OVER_DENSITY] = np.sqrt(speed2) / density[i] * (DAMPED_MOST / max(DAMPED_MOST, taken))
        bound = most / max(1.0, spread[i, CROWD] / CROWDED)
        if straining.plastic:
            shearing = flow / step if step > 0.0 else 0.0
        record[i, SHEAR_RATE] = shearing if shearing * step <= bound else bound / step
        turn = (xx - yy) * matrix[i, 3] - xy * matrix[i, 4]
        record[i, TXX] = xx * kxx + xy * kxy
        record[i, TXY] = xx * kxy + xy * kyy - turn
        record[i, TYX] = xy * kxx + yy * kxy + turn
        record[i, TYY] = xy * kxy + yy * kyy
    return max_sound2
